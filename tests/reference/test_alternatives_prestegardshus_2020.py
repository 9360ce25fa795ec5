"""Inshore or offshore on the coast of Prestegardshus (2020), ch. 3.6 and 4: both are listed.

His node 120 is in the strait at Rorvik (the Naeroysund), between his waypoints 1 and 2. Offshore is
nearly the geodesic there; inshore is longer, and sheltered.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from thalweg.chart import Chart
from thalweg.chart.passage_crossings import names_passed
from thalweg.core.geodesy import distance
from thalweg.core.units import NAUTICAL_MILE
from thalweg.planning import Voyage, alternative_plans
from thalweg.sea import Sea
from thalweg.ship import Ship

START, GOAL, NODE_120 = (64.50, 10.25), (65.30, 11.05), (64.862, 11.253)
PERIOD = "sea_surface_wave_period_at_variance_spectral_density_maximum"


def sheltered_sea() -> Sea:
    """1 m of waves offshore and 0.1 m inside the islands."""

    def height(time, lat, lon):
        inside = np.asarray(lon) - 10.95 - 0.35 * (np.asarray(lat) - 64.6)
        return 1.0 - 0.9 / (1.0 + np.exp(-inside / 0.02)) + 0.0 * np.asarray(time)

    return Sea.from_functions(
        {
            "sea_surface_wave_significant_height": height,
            PERIOD: lambda time, lat, lon: 5.5,
            "sea_surface_wave_from_direction": lambda time, lat, lon: 300.0,
            "eastward_wind": lambda time, lat, lon: 0.0,
            "northward_wind": lambda time, lat, lon: 0.0,
        }
    )


@pytest.mark.slow
def test_offshore_and_inshore_by_naeroysund_are_both_listed():
    voyage = Voyage(start=START, goal=GOAL, depart="2026-01-02T00:00Z", speed_kn=9.4)
    chart = Chart.gshhg("i")
    found = alternative_plans(
        voyage, ship=Ship.load("gunnerus-2019"), sea=sheltered_sea(), chart=chart, resolution=12e3
    )
    offshore = next(one for one in found.choices if one.name.startswith("offshore"))
    by_strait = [one for one in found.choices if one.name.startswith("inshore by Naeroysund")]
    inshore = next(one for one in by_strait if "least motion sickness" in one.best_in)
    longer = inshore.route.distance_nm - found.choices[0].route.distance_nm
    assert 5.0 < longer < 20.0  # 7.5 nm on the whole way from Orland to Traena
    assert "% sick instead of" in inshore.difference and f"+{longer:.0f} nm" in inshore.difference
    sick = [one.route.indicators["places"]["mess"]["sick_percent"] for one in (offshore, inshore)]
    assert sick[1] < 0.6 * sick[0]
    line = inshore.route.samples
    away = np.asarray(distance(line["lat"], line["lon"], *NODE_120))
    assert away.min() < 1.0 * NAUTICAL_MILE
    for row in found.rows():  # all key figures, None where unknown
        assert {"time_h", "fuel_t", "comfort_m2_s3:mess", "inshore_percent"} <= set(row)
        assert all(v is None or isinstance(v, str) or math.isfinite(v) for v in row.values())


def test_the_naeroysund_is_named_on_the_line_through_node_120():
    chart = Chart.gshhg("i")
    lat, lon = np.array([(64.70, 10.80), NODE_120, (64.87, 11.28), (64.98, 11.32)]).T
    assert "Naeroysund" in names_passed(chart.coastline, chart.passages, lat, lon)
    outside = np.array([(64.70, 10.40), (65.2, 10.7)]).T
    assert "Naeroysund" not in names_passed(chart.coastline, chart.passages, *outside)
