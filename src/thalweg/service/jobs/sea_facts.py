"""What a sea holds, for the page and its lists."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Final

from thalweg.core.errors import InputError
from thalweg.core.time import format_time, parse_time
from thalweg.sea import standard_names as nm

if TYPE_CHECKING:
    from thalweg.sea import Sea

#: Variables of frames: names of the sea, and the value of one unit of a frame.
FRAME_VARIABLES: Final[Mapping[str, tuple[tuple[str, ...], float]]] = {
    "waves": ((nm.WAVE_HEIGHT, *nm.WAVES.pair), 0.01),
    "wind": (nm.WIND.pair, 0.01),
    "current": (nm.CURRENT.pair, 0.001),
    "ice": ((nm.ICE,), 0.001),
    "depth": ((nm.BED_DEPTH,), 0.5),
}


def sea_facts(sea: Sea, *, in_detail: bool = False) -> dict[str, Any]:
    """Return what a sea holds: variables, box, period, times, ignored variables.

    Parameters
    ----------
    in_detail : bool
        Also the ignored variables and the share of unknown values.

    Returns
    -------
    dict

    Raises
    ------
    InputError
        In detail, if it holds no variable that is used.
    """
    one = sea.member(0) if sea.members else sea
    rows = one.coverage()
    starts = [row.start for row in rows if row.start is not None]
    ends = [row.end for row in rows if row.end is not None]
    steps = [row.step_s for row in rows if row.step_s]
    frames = [name for name, row in FRAME_VARIABLES.items() if one.variables & set(row[0])]
    facts = {
        "variables": sorted(one.variables),
        "frames": frames,
        "members": sea.members,
        "box": _box(rows),
        "start": format_time(max(starts)) if starts else None,
        "end": format_time(min(ends)) if ends else None,
        "step_s": min(steps) if steps else None,
        "assumptions": list(sea.assumptions),
    }
    if in_detail:
        found = sea.describe()
        facts["ignored"] = found.as_dict()["ignored"]
        facts["missing_fraction"] = dict(found.missing)
        if not sea.variables:
            raise InputError(
                "The file holds no variable that is used.",
                "Used are wind, waves, currents, water level, depth and ice.",
                "Choose another file.",
                field="file",
            )
    return facts


def forecast_run(path: str) -> str | None:
    """Return the start of the forecast run that a NetCDF file names, as ``thalweg fetch`` does."""
    import netCDF4

    try:
        with netCDF4.Dataset(path) as file:
            run = parse_time(str(file.getncattr("forecast_reference_time")))
    except (OSError, AttributeError, InputError):  # not NetCDF, or it names none
        return None
    return format_time(run)


def _box(rows: Any) -> list[float] | None:
    """Return (south, north, west, east) around all data; None for formulas of the whole world."""
    gridded = [row for row in rows if row.spacing_deg is not None]
    if not gridded:
        return None
    return [
        min(row.south for row in gridded),
        max(row.north for row in gridded),
        min(row.west for row in gridded),
        max(row.east for row in gridded),
    ]
