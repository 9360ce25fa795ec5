"""Files of ship traffic: zones as GeoJSON, density as a grid."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Final, TypeVar

import numpy as np

from thalweg.chart import geojson_polygons
from thalweg.chart.depth.depth_grids import horizontal_axes, open_grid_source
from thalweg.chart.zones.ship_traffic import (
    SQUARE_KILOMETRE,
    TRAFFIC_RATES,
    ShipTraffic,
    TrafficGrid,
    TrafficRate,
    TrafficZone,
    months_and_hours,
    named_text,
)
from thalweg.core.errors import DatasetError, InputError, unknown_name_error
from thalweg.core.given_numbers import shortened_repr
from thalweg.core.types import FloatArray

_ChartType = TypeVar("_ChartType", bound=Any)

_PROPERTIES: Final = (*TRAFFIC_RATES, "name", "months", "hours")
_HOURS_OF_MONTH: Final = 730.5


def read_ship_traffic(source: Any, *, variable: str | None = None) -> ShipTraffic:
    """Read traffic from GeoJSON zones, or from a raster of density.

    Parameters
    ----------
    source : path, mapping, list or xarray object
        GeoJSON (a file that ends with json, or its contents) or a grid on latitude and longitude.
    variable : str, optional
        Which variable of a grid.

    Raises
    ------
    InputError, DatasetError
        If it cannot be read, or rates or units are not clear.
    """
    if isinstance(source, (Mapping, list)) or str(source).casefold().endswith("json"):
        return _read_zones(source)
    return ShipTraffic(grids=(_read_grid(source, variable),))


def _read_zones(source: Any) -> ShipTraffic:
    zones = []
    for geometry, properties in geojson_polygons.read_features(source, "traffic zones"):
        for name in properties:
            if str(name) not in _PROPERTIES:
                raise unknown_name_error("property of traffic zones", str(name), _PROPERTIES)
        rate = TrafficRate.of_properties(properties)
        months = _whole_numbers(properties, "months", 1, 12)
        hours = _whole_numbers(properties, "hours", 0, 23)
        name = str(properties.get("name") or "traffic zone")
        shapes = geojson_polygons.parse_polygons(geometry, "traffic zones", repair=False)
        zones += [TrafficZone(name, shape, rate, months, hours) for shape in shapes]
    data = source
    if not isinstance(source, (Mapping, list)):
        data = json.loads(Path(source).read_text("utf-8-sig"))
    elsewhere = data.get("elsewhere") if isinstance(data, Mapping) else None
    if elsewhere is not None and not isinstance(elsewhere, Mapping):
        raise InputError(
            f"The traffic elsewhere is {shortened_repr(elsewhere)}.",
            'It is a mapping such as {"encounters_per_h": 0}.',
            "Correct it, or leave it out.",
            field="traffic",
        )
    outside = None if elsewhere is None else TrafficRate.of_properties(elsewhere)
    return ShipTraffic(tuple(zones), elsewhere=outside)


def _whole_numbers(given: Mapping[str, Any], name: str, low: int, high: int) -> tuple[int, ...]:
    values = given.get(name)
    if values is None:
        return tuple(range(low, high + 1))
    good = isinstance(values, Sequence) and not isinstance(values, str) and len(values) > 0
    if not good or any(v not in range(low, high + 1) for v in values):
        raise InputError(
            f"A traffic zone{named_text(given)} has the {name} {shortened_repr(values)}.",
            f"They are a list of whole numbers from {low} to {high}.",
            "Correct them, or leave them out for all.",
            field="traffic",
        )
    return tuple(int(v) for v in values)


def _read_grid(source: Any, variable: str | None) -> TrafficGrid:
    name, data = open_grid_source(source, "The density of traffic")
    fields = [str(k) for k in data.data_vars if all(horizontal_axes(data[k]))]
    known = [k for k in fields if variable in (None, k)]
    if len(known) != 1:
        raise DatasetError(
            f"{name} holds {len(known)} fields that may be the density of traffic.",
            f"On latitude and longitude it has: {', '.join(fields) or 'none'}.",
            "Name one: with_traffic(..., variable='...').",
            file=name,
        )
    array = data[known[0]]
    lat_name, lon_name = horizontal_axes(array)
    others = [str(d) for d in array.dims if d not in (lat_name, lon_name) and array.sizes[d] > 1]
    month = next((d for d in others if d in ("month", "time")), None)
    hour = next((d for d in others if d == "hour"), None)
    if set(others) != {d for d in (month, hour) if d}:
        raise _axis_error(name, others)
    array = array.squeeze(drop=True).sortby([lat_name, lon_name])
    array = array.transpose(*(d for d in (month, hour) if d), lat_name, lon_name)
    values = np.asarray(array.values, float) * _unit(array, name)
    if np.nanmin(values, initial=0.0) < 0.0:
        raise DatasetError(
            f"The density of traffic in {name} is negative somewhere.",
            "A density is zero or more; values that are missing are marked by _FillValue.",
            "Correct the file.",
            file=name,
        )
    lat, lon = np.asarray(array[lat_name], float), np.asarray(array[lon_name], float)
    sizes = 12 if month else 1, 24 if hour else 1
    if values.size != math.prod(sizes) * len(lat) * len(lon):
        raise _axis_error(name, others)
    if month == "time":
        of_month = months_and_hours(_seconds(array["time"].values))[0]
        if sorted(of_month.tolist()) != list(range(1, 13)):
            raise _axis_error(name, others)
        values = values[np.argsort(of_month)]
    return TrafficGrid(name, lat, lon, values.reshape(*sizes, len(lat), len(lon)))


def _seconds(times: Any) -> FloatArray:
    return np.asarray(times).astype("datetime64[s]").astype(np.float64)


def _axis_error(name: str, axes: list[str]) -> DatasetError:
    return DatasetError(
        f"The density of traffic in {name} has the axes {', '.join(axes) or 'none'} besides "
        "latitude and longitude.",
        "It may have the axes month or time (12 months) and hour (24 hours, UTC).",
        "Select or average the others.",
        file=name,
    )


def _unit(array: Any, name: str) -> float:
    """Return the factor to ships per square metre."""
    unit = "".join(str(array.attrs.get("units", "")).casefold().split())
    for mark in ("^", "**", "ships", "vessels", "count", "."):
        unit = unit.replace(mark, "")
    if unit in ("km-2", "/km2", "1/km2"):
        return 1.0 / SQUARE_KILOMETRE
    if unit in ("m-2", "/m2", "1/m2"):
        return 1.0
    if unit in ("hourskm-2month-1", "hkm-2month-1", "hours/km2/month", "hours/km2"):
        return 1.0 / (
            SQUARE_KILOMETRE * _HOURS_OF_MONTH
        )  # EMODnet: hours in a square kilometre in a month
    raise DatasetError(
        f"The density of traffic in {name} has the unit {array.attrs.get('units', '')!r}.",
        "Known units are 'km-2' (ships per square kilometre) and 'hours km-2 month-1' (EMODnet).",
        "Set the attribute units.",
        file=name,
    )


def chart_with_traffic(
    chart: _ChartType, source: Any, *, variable: str | None = None
) -> _ChartType:
    """Return a chart with the traffic of other ships, below what it has.

    Parameters
    ----------
    source : path, dict, list or xarray object
        GeoJSON zones with ``encounters_per_h``, ``encounters_per_nm`` or ``ships_per_km2``
        (`thalweg.chart.zones.ship_traffic`), or a grid of ships per square kilometre on latitude
        and longitude, perhaps with the axes month (or 12 times) and hour.
    variable : str, optional
        Which variable of a grid, if that is not clear.

    Returns
    -------
    Chart
        Routes on it state their expected encounters.

    Raises
    ------
    InputError, DatasetError
        If it cannot be read, or rates or units are not clear.
    """
    found = read_ship_traffic(source, variable=variable)
    own = chart.traffic
    return replace(chart, traffic=found if own is None else own.joined(found))
