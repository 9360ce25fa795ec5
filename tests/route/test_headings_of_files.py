"""Headings in route files, whose legs are not those of the route."""

import numpy as np
import pytest

from thalweg import Sea, Ship, evaluate
from thalweg.core.units import KNOT
from thalweg.route.formats.file_route import file_route


@pytest.mark.parametrize("north_kn", [0.0, 2.0])
def test_headings_belong_to_the_course_of_their_leg(north_kn):
    """They were those of the legs before waypoints were left out, up to 12 degrees off."""
    sea = Sea.from_functions(
        {
            "eastward_sea_water_velocity": lambda t, y, x: 0.0 * t,
            "northward_sea_water_velocity": lambda t, y, x: north_kn * KNOT + 0.0 * t,
        }
    )
    lon = np.linspace(0.0, 2.0, 81)
    lat = 50.0 + 0.02 * np.sin(np.pi * lon) + 0.0004 * (-1.0) ** np.arange(81)  # a few turns
    route = evaluate(
        list(zip(lat, lon)), ship=Ship.simple(speed_kn=10.0), sea=sea, depart="2026-01-01"
    )
    rows = file_route(route).rows[:-1]
    assert len(rows) < 40
    drift = np.array([row["heading_deg"] - row["course_deg"] for row in rows])
    expected = np.degrees(np.arcsin(north_kn / 10.0 * np.sin(np.radians(90.0))))
    assert drift == pytest.approx(np.full(len(rows), expected), abs=0.02 if not north_kn else 1.0)
