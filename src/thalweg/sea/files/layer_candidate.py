"""The data types between an opened file and the layers made from it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, TypeAlias

from thalweg.core.types import FloatArray
from thalweg.sea.files.draught_averaging import VerticalLayers
from thalweg.sea.files.grid_detection import GridPlacement
from thalweg.sea.files.ugrid import MeshLayout
from thalweg.sea.files.variable_recognition import AssignedVariable, IgnoredVariable
from thalweg.sea.grids.source_variables import Quantity, SourceVariable
from thalweg.sea.recognition_record import RecognisedVariable


@dataclass(frozen=True, eq=False)
class OpenedFile:
    """A file that was opened but not read.

    Attributes
    ----------
    dataset : xarray.Dataset
        Lazy.
    source : str
        Its name, for messages.
    facts : mapping
        Name, size and time of change.
    draught : float or None
        Draught [m] over which currents in layers are averaged; None: the surface layer is taken.
    """

    dataset: Any
    source: str
    facts: Mapping[str, Any]
    draught: float | None = None


@dataclass(frozen=True, eq=False)
class PlacedVariable:
    """A recognised variable, placed in space and time."""

    chosen: AssignedVariable
    variable: SourceVariable
    place: GridPlacement
    times: FloatArray
    rotated: bool
    layers: VerticalLayers | None = None


@dataclass(eq=False)
class LayerCandidate:
    """Quantities on one grid and one time axis of one file, before files are joined."""

    place: GridPlacement
    times: FloatArray
    file: OpenedFile
    quantities: list[Quantity] = field(default_factory=list)
    recognised: list[RecognisedVariable] = field(default_factory=list)


@dataclass(eq=False)
class PlacementCache:
    """Positions worked out before, for files that lie on the same ones (members of an ensemble).

    Attributes
    ----------
    meshes : list of MeshLayout or None
        Meshes of the file.
    places : dict
        Where each variable lies.
    """

    meshes: list[MeshLayout] | None = None
    places: dict[str, GridPlacement] = field(default_factory=dict)


FileContents: TypeAlias = tuple[list[LayerCandidate], list[IgnoredVariable]]
