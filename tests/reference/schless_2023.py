"""The dredger and the waters of Schless (2023), sections 4.1 and 4.3, as Thalweg's own objects."""

from __future__ import annotations

from functools import cache

import numpy as np

from thalweg.core.geodesy import direct
from thalweg.operations.waiting import Departures, TripTable, trip_table
from thalweg.sea import Sea
from thalweg.sea.models.stratified_coast import TidalEllipse, stratified_coast_current
from thalweg.ship import Ship

COAST = (52.1, 4.26)
TIDE = 44700.0  #: [s]
GENERATOR = 327.1e3  #: [W], 5 % of the installed power
BLOCK, BREADTH = 0.85, 19.93
MIDSHIP = 1.006 - 0.0056 * BLOCK**-3.56


def dredger(draught: float, *, rudder: bool = True, power_kw: float = 3000.0) -> Ship:
    """Return the Vox Olympia with the rules of thumb of the thesis at a draught [m]."""
    data = dict(Ship.load("vox-olympia").data)
    section = 0.2 * BREADTH * draught
    hull = {
        **data["hull"],
        "draught_m": draught,
        "midship_coefficient": MIDSHIP,
        "lcb_percent": -13.5 + 19.4 * BLOCK / MIDSHIP,
        "bulb_area_m2": section * MIDSHIP,
        "bulb_centre_height_m": 0.6 * draught,
        "transom_area_m2": section,
    }
    models = {**data["models"], "rudder": "schless_2023" if rudder else "none"}
    changes = {"hull": hull, "models": models, "powers_kw": [power_kw], "limits": {}}
    return Ship.from_dict({**data, **changes})


def offshore(distance: float) -> tuple[float, float]:
    """Return the position at a distance [m] from the coast, at right angles to it."""
    lat, lon = direct(*COAST, np.radians(270.0), distance)
    return float(lat), float(lon)


def waters(scenario: TidalEllipse, *, decay: float, depth, density_gradient: float = 0.0) -> Sea:
    """Return the prescribed ellipse, equal over the draught; strongest northward at time 0."""
    current = stratified_coast_current(
        scenario,
        coast=COAST,
        onshore_deg=90.0,
        flood=0.0,
        density_gradient=density_gradient,
        decay=decay,
    )
    return Sea.from_functions({**current, "sea_floor_depth_below_geoid": depth})


@cache
def nourishment(scenario: TidalEllipse, *, rudder: bool = True) -> tuple[TripTable, TripTable]:
    """Return the trips of Table 4.10: full from 20 km offshore to the coast, and empty back."""
    far = offshore(20e3)

    def depth(time, lat, lon):
        return 8.0 + 12.0 * (COAST[1] - lon) / (COAST[1] - far[1])

    sea = waters(scenario, decay=50e3, depth=depth)
    asked = {"sea": sea, "departures": Departures(0.0, period=TIDE, step=300.0)}
    full, empty = dredger(5.0, rudder=rudder), dredger(2.0, rudder=rudder)
    there = trip_table([far, COAST], ship=full, name="there", **asked).refined(10)
    back = trip_table([COAST, far], ship=empty, name="back", **asked).refined(10)
    return there, back
