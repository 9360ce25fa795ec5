"""Open a mixture of met-ocean files and tides as layers."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from itertools import groupby
from pathlib import Path
from typing import Any, Final

from thalweg.core.errors import DatasetError, InputError
from thalweg.sea.files.file_opener import open_layers
from thalweg.sea.layer import Layer
from thalweg.sea.tides.constituent_files import is_constituent_file, read_constituents
from thalweg.sea.tides.station_area import split_area, station_layers
from thalweg.sea.tides.tidal_layer import tidal_layers
from thalweg.sea.tides.tide_records import is_text_record, read_record

LARGEST_TEXT: Final = 50_000_000  #: [bytes] larger files of text are not read as a record


def layers_of_sources(
    sources: Sequence[Any], mapping: Mapping[str, str] | None, draught: float | None
) -> tuple[tuple[Layer, ...], tuple[str, ...]]:
    """Return the layers of files, in order of priority, and what was assumed (`Sea.open`).

    Parameters
    ----------
    sources : Met-ocean files, files of tidal constituents at three nodes or more, and the tides of
        one station in an area.
    mapping : Canonical name to name in the file.
    draught : Draught [m] over which currents in layers are averaged.

    Raises
    ------
    InputError : If a file holds the series or the constituents of a single station.
    DatasetError : If a file cannot be used.
    """
    groups = [(is_tide, list(group)) for is_tide, group in groupby(sources, _is_tidal)]
    if mapping and sum(not is_tide for is_tide, _ in groups) > 1:
        raise InputError(
            "Variables are mapped, and a file of tidal constituents is between other files.",
            "A mapping applies to all files that hold variables, opened together.",
            "Give the tidal constituents first or last.",
        )
    layers: list[Layer] = []
    assumed: list[str] = []
    for is_tide, group in groups:
        if not is_tide:
            layers += open_layers(group, mapping, draught)
        for path in group if is_tide else ():
            found, texts = _tidal_layers(path)
            layers += found
            assumed += texts
    opened = tuple(layers) if groups else tuple(open_layers((), mapping, draught))
    return opened, tuple(dict.fromkeys(assumed))


def _is_tidal(source: Any) -> bool:
    """Return whether a source is a tide; refuse series of one station without an area."""
    source, area = split_area(source)
    if area is not None:
        return True
    if not isinstance(source, (str, os.PathLike)):
        return False
    try:
        path = Path(source).expanduser()
        text = path.is_file() and path.stat().st_size <= LARGEST_TEXT and is_text_record(path)
    except (OSError, ValueError, DatasetError):  # the opener states what is wrong
        return False
    if not text:
        return False
    if is_constituent_file(path):
        return True
    try:
        record = read_record(path)
    except (DatasetError, InputError):
        return False
    raise InputError(
        f"{path.name} is the series of one station ({record.description}).",
        "A sea needs fields on a grid or mesh, or a tide in an area.",
        f"Add the area where it holds [deg]: {path.name}@SOUTH,NORTH,WEST,EAST. For other dates "
        f"find its tide first: thalweg tides analyse {path.name} --out tide.json.",
        file=str(path),
    )


def _tidal_layers(source: str | os.PathLike[str]) -> tuple[tuple[Layer, ...], tuple[str, ...]]:
    path, area = split_area(source)
    where = Path(path).expanduser()
    if area is not None:
        return station_layers(where, area)
    constants = read_constituents(where)
    if constants.lat.size == 1:
        raise InputError(
            f"{where.name} holds the tidal constituents of one station.",
            "The tide of one station applies to an area.",
            f"Add the area [deg]: {where.name}@SOUTH,NORTH,WEST,EAST; or give constituents at "
            "three nodes or more.",
            file=str(where),
        )
    return tidal_layers(constants), ()
