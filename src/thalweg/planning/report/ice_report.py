"""What a plan states about ice: by the data, or by the months in which it is usual."""

from __future__ import annotations

import calendar
from typing import Final

import numpy as np

from thalweg.chart.ice_areas import ICE_AREAS
from thalweg.core.geodesy import format_position_minutes
from thalweg.core.types import FloatArray
from thalweg.route import Route
from thalweg.sea import Sea
from thalweg.sea.standard_names import ICE

_LATITUDE: Final = 72.0  #: [deg] beyond which ice is likely in all months
_OPEN_WATER: Final = 0.1  #: greatest concentration of ice that counts as open water
REACHES_ICE: Final = "The route reaches"  #: a note on ice begins so
_ADVICE: Final = "give a via point or a no-go zone if that water is closed"


def ice_warnings(route: Route, sea: Sea) -> list[str]:
    """Return warnings about ice on a route, which is never modelled.

    Parameters
    ----------
    route : The evaluated route.
    sea : Its ice counts where it is known; elsewhere the months of `ICE_AREAS` count.

    Returns
    -------
    list of str : A sentence for the thickest ice of the data, and for each area.
    """
    lat, lon = (np.asarray(route.samples[name], float) for name in ("lat", "lon"))
    time = np.asarray(route.samples["time"], float)
    time = np.where(np.isfinite(time), time, route.depart)
    ice = _ice_of_data(sea, time, lat, lon)
    notes = []
    if np.any(ice > _OPEN_WATER):
        at = int(np.nanargmax(ice))
        notes.append(
            f"{REACHES_ICE} ice that covers {100.0 * ice[at]:.0f} % of the water by the data, at "
            f"{format_position_minutes(lat[at], lon[at])}; ice is not modelled: {_ADVICE}."
        )
    unknown = np.isnan(ice)
    month = time.astype("datetime64[s]").astype("datetime64[M]").astype(np.int64) % 12 + 1
    for area in ICE_AREAS:
        inside = unknown & np.isin(month, area.months)
        inside[inside] = area.contains(lat[inside], lon[inside])
        if inside.any():
            at = int(np.argmax(inside))
            notes.append(
                f"{REACHES_ICE} the {area.name} in {calendar.month_name[month[at]]}, from "
                f"{format_position_minutes(lat[at], lon[at])}. Ice is usual there {area.season} "
                f"({area.source}), and the data have none: read the ice charts. Ice is not "
                f"modelled: {_ADVICE}."
            )
            unknown &= ~inside
    far = np.where(unknown, np.abs(lat), 0.0)
    worst = int(np.argmax(far))
    if far[worst] < _LATITUDE:
        return notes
    place = format_position_minutes(lat[worst], lon[worst])
    return [*notes, f"{REACHES_ICE} {place}, and sea ice is not modelled: {_ADVICE}."]


def _ice_of_data(sea: Sea, time: FloatArray, lat: FloatArray, lon: FloatArray) -> FloatArray:
    """Return the concentration of ice along a route; NaN where no data have it."""
    if ICE not in sea.variables or sea.members:
        return np.full(lat.shape, np.nan)
    return np.asarray(sea.sample([ICE], time, lat, lon)[ICE], float)
