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
    """A file that was opened; its values are read later.

    Attributes
    ----------
    dataset : Not loaded.
    source : Its name, for messages.
    facts : Name, size and modification time.
    draught : Draught [m] over which currents in layers are averaged; None for the surface layer.
    """

    dataset: Any
    source: str
    facts: Mapping[str, Any]
    draught: float | None = None


@dataclass(frozen=True, eq=False)
class PlacedVariable:
    """A recognised variable with its grid, times and vertical layers.

    Attributes
    ----------
    chosen : The variable and its role.
    variable : Reads its values.
    times : Its times [s since epoch], (T,); empty without any.
    rotated : Whether GRIB states that components are along the grid.
    layers : Layers over which it is averaged.
    """

    chosen: AssignedVariable
    variable: SourceVariable
    place: GridPlacement
    times: FloatArray
    rotated: bool
    layers: VerticalLayers | None = None


@dataclass(eq=False)
class LayerCandidate:
    """Quantities on one grid and one time axis of one file, before files are concatenated.

    Attributes
    ----------
    times : Times [s since epoch], (T,); empty for fields that hold at all times.
    quantities : Quantities found so far.
    recognised : How they were recognised.
    """

    place: GridPlacement
    times: FloatArray
    file: OpenedFile
    quantities: list[Quantity] = field(default_factory=list)
    recognised: list[RecognisedVariable] = field(default_factory=list)


@dataclass(eq=False)
class PlacementCache:
    """Grids found earlier, for files on the same positions (members of an ensemble).

    Attributes
    ----------
    places : The grid of each variable.
    """

    meshes: list[MeshLayout] | None = None
    places: dict[str, GridPlacement] = field(default_factory=dict)


FileContents: TypeAlias = tuple[list[LayerCandidate], list[IgnoredVariable]]
