"""Notes of routes where the resistance of waves is used outside its range, or not counted."""

import numpy as np
import pytest

from thalweg import Sea, Ship, evaluate
from thalweg.planning.report.note_order import count_of_dangers, danger_first
from thalweg.route.referee.method_ranges import WAVES_OUT_OF_RANGE, WAVES_UNCOUNTED

TANKER = {
    "name": "tanker",
    "hull": {
        "length_between_perpendiculars_m": 234.0,
        "breadth_m": 42.0,
        "draught_m": 14.8,
        "block_coefficient": 0.83,
    },
    "models": {"calm_water": "holtrop_mennen_1982"},
    "propulsion": {"propellers": 1, "propeller_diameter_m": 7.2, "propulsive_efficiency": 0.7},
    "engine": {"power_kw": 12000},
    "powers_kw": [8000.0],
}
MERIDIAN = [(0.0, 0.0), (1.0, 0.0)]  # course north


def sailed(method, *, wave_from, height=3.0, line=MERIDIAN):
    ship = Ship.from_dict({**TANKER, "models": {**TANKER["models"], "waves": method}})
    values = {
        "sea_surface_wave_significant_height": height,
        "sea_surface_wave_from_direction": wave_from,
        "sea_surface_wave_period_at_variance_spectral_density_maximum": 9.0,
    }
    sea = Sea.from_functions(
        {
            name: lambda time, lat, lon, value=value: value + 0.0 * lat
            for name, value in values.items()
        }
    )
    return evaluate(line, ship=ship, sea=sea, depart=0.0)


def notes(route, begin):
    return [text for text in route.assumptions if text.startswith(begin)]


@pytest.mark.parametrize("method", ["stawave_1", "stawave_2"])
@pytest.mark.parametrize(
    ("wave_from", "height", "noted"),
    [
        (46.0, 3.0, True),
        (314.0, 3.0, True),
        (80.0, 3.0, True),
        (44.0, 3.0, False),
        (0.0, 3.0, False),
        (100.0, 3.0, False),
        (180.0, 3.0, False),
        (46.0, 0.9, False),
    ],
)
def test_waves_just_outside_the_sector_are_stated(method, wave_from, height, noted):
    found = notes(sailed(method, wave_from=wave_from, height=height), WAVES_UNCOUNTED)
    assert bool(found) == noted
    if noted:
        off = min(wave_from, 360.0 - wave_from)
        assert f"waves of up to 3.0 m come from {off:.0f} to {off:.0f} degrees" in found[0]
        assert "(100 % of the time under way)" in found[0]
        assert f"{method} is made for waves within 45 degrees" in found[0]
        assert count_of_dangers(found) == 1


def test_a_short_part_outside_the_sector_is_not_stated():
    """A tenth of the time is the least that is stated."""
    east = np.degrees(np.radians(1.0))
    for share, noted in ((0.05, False), (0.2, True)):
        line = [(0.0, 0.0), (1.0 - share, 0.0), (1.0 - share, share * east)]
        route = sailed("stawave_1", wave_from=20.0, line=line)  # 20, then 70 degrees off the bow
        assert bool(notes(route, WAVES_UNCOUNTED)) == noted


def test_the_method_named_for_routing_counts_waves_beside_the_sector():
    route = sailed("snnm", wave_from=46.0)
    assert not notes(route, WAVES_UNCOUNTED)
    ahead, beside, calm = (
        sailed("snnm", wave_from=angle, height=height).time_h
        for angle, height in ((0.0, 3.0), (46.0, 3.0), (0.0, 0.0))
    )
    assert beside > calm * 1.05
    assert beside == pytest.approx(ahead, rel=0.1)


@pytest.mark.parametrize(("height", "noted"), [(3.4, False), (5.5, True)])
def test_wave_heights_above_the_range_are_stated(height, noted):
    """2.25 m times the root of 2.34 is 3.442 m."""
    found = notes(sailed("stawave_1", wave_from=0.0, height=height), WAVES_OUT_OF_RANGE)
    assert bool(found) == noted
    if noted:
        assert "stawave1: wave height is 5.5, outside 0 to 3.442 m" in found[0]
        assert danger_first(["Passes A.", *found])[0] == found[0]
