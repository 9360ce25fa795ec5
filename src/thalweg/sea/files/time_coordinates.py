"""Recognise and read time axes of files."""

from __future__ import annotations

import re
import warnings
from typing import Any, Final

import numpy as np

from thalweg.core.errors import DatasetError
from thalweg.core.types import FloatArray

_REAL_CALENDARS: Final = ("standard", "gregorian", "proleptic_gregorian")
_ZONE_PATTERN: Final = re.compile(r"([A-Za-z]+(?:/[A-Za-z_]+)?)\W*$")  #: letters at the end


def is_time(array: Any) -> bool:
    """Return whether a one-dimensional variable holds times, decoded or not."""
    if array.ndim != 1:
        return False
    if array.dtype.kind == "M":
        return True
    return " since " in str(array.attrs.get("units", ""))


def read_times(array: Any, source: str) -> FloatArray:
    """Return the times of a time axis.

    Parameters
    ----------
    array : The time axis, decoded or not.
    source : File name for messages.

    Returns
    -------
    float64 array (T,) : Seconds since 1970-01-01T00:00Z, strictly increasing.

    Raises
    ------
    DatasetError : If the calendar has no real dates, a time is missing, or times do not increase.
    """
    import xarray as xr

    name = str(array.name)
    if array.dtype.kind != "M":
        _check_zone(str(array.attrs.get("units", "")), source, name)
        bare = xr.Dataset({name: ((name,), np.asarray(array.values), dict(array.attrs))})
        try:
            with warnings.catch_warnings():
                warnings.filterwarnings("ignore", "Unable to decode time axis")
                array = _with_far_years(xr.decode_cf(bare, decode_times=True)[name])
        except (ValueError, OverflowError, TypeError) as error:
            raise _time_fault(source, name, f"cannot be decoded ({error})") from error
    if array.dtype.kind != "M":
        calendar = array.attrs.get("calendar", array.encoding.get("calendar", "unknown"))
        raise _calendar_fault(source, name, str(calendar))
    stamps = np.asarray(array.values).astype("datetime64[us]")  # nanoseconds end in 2262
    if np.isnat(stamps).any():
        raise _time_fault(source, name, "has missing values")
    times: FloatArray = np.round(stamps.astype(np.int64) / 1e6, 3).astype(np.float64)
    step = np.diff(times)
    if (step <= 0.0).any():
        where = int(np.flatnonzero(step <= 0.0)[0])
        fault = "is repeated" if step[where] == 0.0 else "is followed by an earlier one"
        raise _time_fault(
            source, name, f"does not increase: step {where} ({stamps[where]}) {fault}"
        )
    return times


def _with_far_years(array: Any) -> Any:
    """Return decoded times; those that xarray gives as objects, after 2262, as microseconds."""
    calendar = array.encoding.get("calendar", "standard")
    if array.dtype.kind == "M" or calendar not in _REAL_CALENDARS:
        return array
    stamps = [np.datetime64(moment.isoformat(), "us") for moment in array.values]
    return array.copy(data=np.array(stamps, "datetime64[us]"))


def _check_zone(units: str, source: str, name: str) -> None:
    """Raise `DatasetError` for a named time zone other than UTC, which would be ignored."""
    _, _, reference = units.partition(" since ")
    zone = _ZONE_PATTERN.search(reference.strip())
    if zone and zone[1].upper() not in ("Z", "UTC", "GMT", "UT", "T"):
        raise _time_fault(
            source, name, f"has the units {units!r}: the time zone {zone[1]!r} is not converted"
        )


def _calendar_fault(source: str, name: str, calendar: str) -> DatasetError:
    return DatasetError(
        f"{source}: the time axis {name!r} uses the calendar {calendar!r}, which has days that do "
        "not exist, or leaves out days that do.",
        f"The calendars with the days of a voyage are {', '.join(_REAL_CALENDARS)}.",
        "Convert the file first, for example with xarray (and cftime): "
        f"ds.convert_calendar('standard', dim={name!r}{_alignment(calendar)}).",
        file=source,
    )


def _alignment(calendar: str) -> str:
    """Return the argument that xarray requires for years of 360 days."""
    return ", align_on='date'" if calendar == "360_day" else ""


def _time_fault(source: str, name: str, fault: str) -> DatasetError:
    return DatasetError(
        f"{source}: the time axis {name!r} {fault}.",
        "Times must be UTC dates that strictly increase.",
        "Sort the file and remove duplicates (for example with xarray: ds.sortby('time')."
        "drop_duplicates('time')), or download it again.",
        file=source,
    )


def time_coordinate(dataset: Any, array: Any) -> Any:
    """Return the time coordinate of a variable: along one of its dimensions, or scalar, or None.

    Parameters
    ----------
    dataset, array : The file and one of its variables.

    Returns
    -------
    xarray.DataArray or None : One-dimensional; a scalar time has the dimension ``one_time``.
    """
    along = [
        dataset[n]
        for n in dataset.variables
        if dataset[n].ndim == 1 and dataset[n].dims[0] in array.dims and is_time(dataset[n])
    ]
    if along:
        return min(along, key=lambda t: _time_rank(t))
    for name in ("valid_time", "time"):
        if name in dataset.variables and dataset[name].ndim == 0:
            scalar = dataset[name].expand_dims("one_time")
            if is_time(scalar):
                return scalar
    return None


def _time_rank(array: Any) -> tuple[bool, bool, bool]:
    name = str(array.name)
    return (
        name != "valid_time",
        array.attrs.get("standard_name") not in ("time", None),
        name != str(array.dims[0]),
    )
