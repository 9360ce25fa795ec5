"""Latitudes beyond which ice is likely, and which ways go there."""

from __future__ import annotations

from typing import Final

from thalweg.core.geodesy import Position

#: Water beyond these latitudes [deg], where ice is likely, is used only by ways that begin or end
#: there: 72 N closes the Northwest and Northeast Passages and leaves the North Cape open; south of
#: 60 S is the Antarctic area of the Polar Code (SOLAS chapter XIV).
ICE_LATITUDES: Final = (-60.0, 72.0)
#: Latitude [deg] that ways between the southern capes do not pass by default.
ICEBERG_LATITUDE: Final = -50.0
#: ... nor ways round Cape Horn, which pass south of the islands of Diego Ramirez in 56.5 S.
HORN_LATITUDE: Final = -57.5
_ICE_MARGIN: Final = 1.0  # ends this near to a limit count as beyond it [deg]
_ICE_COAST: Final = 66.5  # latitude from which on ports are reached through ice [deg] ...
_ICE_FREE: Final = (-60.0, 55.0)  # ... outside these longitudes [deg]
#: Latitude [deg] that only ways to places near it or beyond it pass.
PACK_ICE: Final = 81.0
_PACK_MARGIN: Final = 2.5  # [deg]


def outside_ice(*places: Position) -> bool:
    """Return whether all positions are between the latitudes where ice is likely."""
    lowest, highest = ICE_LATITUDES[0] + _ICE_MARGIN, ICE_LATITUDES[1] - _ICE_MARGIN
    return all(lowest <= lat <= highest and not on_ice_coast(lat, lon) for lat, lon in places)


def northern_limit(*places: Position) -> float:
    """Return the latitude [deg] beyond which a way between positions does not go.

    Ways along arctic coasts keep south of the pack ice: they pass Vilkitsky, not Severnaya Zemlya.
    """
    if outside_ice(*places):
        return ICE_LATITUDES[1]
    return 90.0 if max(lat for lat, _ in places) > PACK_ICE - _PACK_MARGIN else PACK_ICE


def on_ice_coast(lat: float, lon: float) -> bool:
    """Return whether a position [deg] is on an arctic coast that ships reach through ice only.

    That is beyond 66.5 N east of Novaya Zemlya or west of Baffin Bay: a way along the coast of
    Siberia, Alaska or Canada leads beyond the latitudes where ice is likely.
    """
    return lat >= _ICE_COAST and not _ICE_FREE[0] <= lon <= _ICE_FREE[1]
