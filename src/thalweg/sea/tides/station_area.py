"""The tide of one station in a box of latitude and longitude: constituents, series and tide tables.

Such a source is written ``FILE@SOUTH,NORTH,WEST,EAST`` [deg]. Every place in the box has the water
level and the current of the station.
"""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import Any, Final

import numpy as np

from thalweg.core.bounding_box import BoundingBox
from thalweg.core.errors import InputError
from thalweg.core.given_numbers import shortened_repr
from thalweg.core.time import format_time
from thalweg.core.types import FloatArray
from thalweg.core.units import HOUR, MINUTE
from thalweg.sea import standard_names as nm
from thalweg.sea.argument_checks import parse_area
from thalweg.sea.files.file_opener import open_layers
from thalweg.sea.layer import Layer
from thalweg.sea.tides.constituent_files import is_constituent_file, read_constituents
from thalweg.sea.tides.tidal_layer import tidal_layers
from thalweg.sea.tides.tide_records import TideRecord, is_text_record, read_record

#: What states that the heights between high and low waters of a table are assumed.
BETWEEN_TURNS: Final = "Between high and low water the level is assumed to follow half a cosine."
_NUMBER: Final = r"[-+]?\d+(?:\.\d*)?"
_WITH_AREA: Final = re.compile(rf"(.+)@({_NUMBER}(?:,{_NUMBER}){{3}})\Z", re.S)
_LONGEST_STEP: Final = 2.5 * HOUR  # of a record; a table of high and low waters has longer ones
_LONGEST_BETWEEN_TURNS: Final = 15.0 * HOUR  # of a diurnal tide, and some more
_LONGER_AT_ENDS: Final = 1.8  # times the usual time between two turns: one is missing
_WIDEST: Final = 180.0  # box [deg]
_STEP: Final = 10.0 * MINUTE  # of the curve between high and low water


def split_area(source: Any) -> tuple[Any, BoundingBox | None]:
    """Return a source without its area, and the area; None for a source without one.

    Raises
    ------
    InputError : If the four numbers are no box.
    """
    if not isinstance(source, (str, os.PathLike)) or os.path.exists(source):
        return source, None
    text = os.fspath(source)
    found = _WITH_AREA.match(text)
    if found is None:
        file, at, area = text.rpartition("@")
        if at and os.path.isfile(os.path.expanduser(file)):
            raise _area_error(area)
        return source, None
    south, north, west, east = (float(number) for number in found[2].split(","))
    if not west < east < west + _WIDEST:
        raise _area_error(found[2])
    return found[1], parse_area((south, north, west, east))


def _area_error(area: str) -> InputError:
    return InputError(
        f"The area of a station is {shortened_repr(area)}.",
        "It is four numbers of degrees without spaces, SOUTH,NORTH,WEST,EAST: west below east, "
        f"{_WIDEST:g} degrees apart at most; over the date line such as 179,181.",
        "Correct it.",
    )


def station_layers(path: Path, area: BoundingBox) -> tuple[tuple[Layer, ...], tuple[str, ...]]:
    """Return the layers of the tide of one station in an area, and what was assumed.

    Parameters
    ----------
    path : Constituents of one station, or a record (`thalweg.sea.tides.tide_records`). A record
        whose steps are above 2.5 hours, most of them, is a table of high and low waters.

    Raises
    ------
    InputError : If the file has several stations, a record fewer than two times, or a table of high
        and low waters lacks one.
    DatasetError : If the file cannot be read.
    """
    if is_constituent_file(path):
        return tidal_layers(read_constituents(path), area=area), ()
    if path.is_file() and not is_text_record(path):
        raise InputError(
            f"{path.name} is no text: an area cannot be given to it.",
            "An area is for the tide of one station: constituents, a record or a tide table.",
            "Name the file without its area, if it is a grid.",
            file=str(path),
        )
    record = read_record(path)
    _check_times(record, path)
    turns = float(np.median(np.diff(record.times))) > _LONGEST_STEP
    if turns:
        _check_turns(record, path.name)
    times, series = _between_turns(record) if turns else (record.times, record.series)
    return tuple(open_layers((_dataset(times, series, area),), None, None)), (
        (BETWEEN_TURNS,) if turns else ()
    )


def _check_times(record: TideRecord, path: Path) -> None:
    """Raise `InputError` for a record of fewer than two times, or times that do not increase."""
    back = np.flatnonzero(np.diff(record.times) <= 0.0)
    if len(record.times) >= 2 and not len(back):
        return
    if len(back):
        later, before = (format_time(float(record.times[back[0] + step])) for step in (1, 0))
        fault = f"{later} after {before}"
    else:
        fault = f"{len(record.times)} times"
    raise InputError(
        f"{path.name} has {fault}.",
        "A series of one station has two times or more, each later than the one before.",
        "Correct the file.",
        file=str(path),
    )


def _check_turns(record: TideRecord, name: str) -> None:
    """Raise `InputError` where a record is no whole table of high and low waters."""
    possible = (
        "Rows hours apart are a table of high and low waters: the level rises and falls in turn, "
        f"and rows are {_LONGEST_BETWEEN_TURNS / HOUR:g} hours apart at most. A record has steps "
        f"of {_LONGEST_STEP / HOUR:g} hours at most."
    )
    if set(record.series) != {nm.WATER_LEVEL}:
        raise InputError(f"{name} has currents in steps of hours.", possible, "Use shorter steps.")
    level, apart = record.series[nm.WATER_LEVEL], np.diff(record.times)
    turn = np.sign(np.diff(level))
    wrong = np.isnan(turn) | (turn == 0.0) | (apart > _LONGEST_BETWEEN_TURNS)
    # two rises or falls in turn show a row that is missing, but not the second or last but one
    wrong[[0, -1]] |= apart[[0, -1]] > _LONGER_AT_ENDS * np.median(apart)
    again = np.append(False, turn[1:] == turn[:-1]) & ~wrong
    if (wrong | again).any():
        at = int(np.argmax(wrong | again))
        ends = record.times[at - again[at]], record.times[at + 1]
        between = " and ".join(format_time(float(time)) for time in ends)
        raise InputError(
            f"{name} lacks a high or low water, or a level, at or between {between}.",
            possible,
            "Add the row.",
        )


def _between_turns(record: TideRecord) -> tuple[FloatArray, dict[str, FloatArray]]:
    """Return times and levels along half a cosine from each high or low water to the next."""
    turn, level = record.times, record.series[nm.WATER_LEVEL]
    inside = np.arange(turn[0], turn[-1], _STEP)
    times = np.unique(np.concatenate([inside, turn]))
    before = np.clip(np.searchsorted(turn, times, side="right") - 1, 0, len(turn) - 2)
    share = (times - turn[before]) / (turn[before + 1] - turn[before])
    weight = 0.5 - 0.5 * np.cos(np.pi * share)
    return times, {nm.WATER_LEVEL: level[before] + weight * (level[before + 1] - level[before])}


def _dataset(times: FloatArray, series: dict[str, FloatArray], area: BoundingBox) -> Any:
    """Return a grid of two by two nodes with the same values at all."""
    import xarray as xr

    axes = ("time", "latitude", "longitude")
    units = {name: "m" if name == nm.WATER_LEVEL else "m s-1" for name in series}
    variables = {
        name: (
            axes,
            np.broadcast_to(values[:, None, None], (len(times), 2, 2)).copy(),
            {"standard_name": name, "units": units[name]},
        )
        for name, values in series.items()
    }
    where = {
        "time": np.round(times * 1e3).astype("datetime64[ms]").astype("datetime64[ns]"),
        "latitude": [area.south, area.north],
        "longitude": [area.west, area.east],
    }
    return xr.Dataset(variables, where)
