"""Notes where a speed is ordered below all speeds of the ship file."""

import pytest

from thalweg import Chart, Sea, Ship, Voyage, evaluate, plan
from thalweg.core.units import KNOT
from thalweg.planning.report.note_order import count_of_dangers
from thalweg.ship.ship_assumptions import low_speed_notes

TUG = {
    "name": "tug",
    "hull": {"length_between_perpendiculars_m": 28.0, "breadth_m": 9.8, "draught_m": 4.4,
             "block_coefficient": 0.55},
    "speeds_kn": [6, 8, 10, 12],
    "engine": {"reference_speed_kn": 12, "reference_power_kw": 2400, "sfoc_g_per_kwh": 205},
    "models": {"calm_water": "cubic"},
}  # fmt: skip
CUBIC = (
    "Below the lowest speed of the ship file, 6 kn: 4.60 kn is ordered. Power there is "
    "extrapolated by the cubic law; the higher consumption of engines at low load is not counted."
)


@pytest.mark.parametrize(("speed", "expected"), [(4.6, [CUBIC]), (6.0, []), (7.0, [])])
def test_the_cubic_law_below_the_settings_is_named(speed, expected):
    """The fuel there is that of the law: 205 g/kWh of the power at (4.6 / 12)^3."""
    ship = Ship.from_dict(TUG)
    route = evaluate(
        [(0.0, 0.0), (0.0, 0.2)], ship=ship, sea=Sea.calm(), chart=Chart.open_water(), depart=0.0,
        speed_kn=speed,
    )  # fmt: skip
    assert [note for note in route.assumptions if note.startswith("Below")] == expected
    power = 2400.0 * (speed / 12.0) ** 3
    assert route.fuel_t == pytest.approx(power * 205e-6 * route.time_h, rel=1e-3)


def test_plans_state_it_where_no_summary_leaves_it_out():
    voyage = Voyage(start=(0.0, 0.0), goal=(0.0, 0.2), depart=0.0, speed_kn=4.6)
    found = plan(voyage, ship=Ship.from_dict(TUG), sea=Sea.calm(), chart=Chart.open_water())
    assert found.notes.count(CUBIC) == 1
    assert count_of_dangers([CUBIC]) == 1


def test_engines_whose_consumption_follows_the_load_and_ships_without_power():
    by_load = TUG | {"engine": {"reference_speed_kn": 12, "reference_power_kw": 2400,
                                "power_kw": 2400, "type": "medium_speed_diesel"}}  # fmt: skip
    (note,) = low_speed_notes(Ship.from_dict(by_load), 4.6 * KNOT)
    assert note.endswith("by the cubic law; the consumption follows the engine load.")
    (note,) = low_speed_notes(Ship.simple(speed_kn=12.0), 4.6 * KNOT)
    assert note == "Below the lowest speed of the ship file, 12 kn: 4.60 kn is ordered."


def test_ships_with_a_resistance():
    hull = TUG["hull"] | {"length_between_perpendiculars_m": 100.0, "breadth_m": 16.0,
                          "draught_m": 6.0, "block_coefficient": 0.75}  # fmt: skip
    ship = Ship.from_dict(
        {"name": "coaster", "hull": hull, "speeds_kn": [8, 12],
         "engine": {"power_kw": 6000, "sfoc_g_per_kwh": 190},
         "models": {"calm_water": "holtrop_1984"}}
    )  # fmt: skip
    (note,) = low_speed_notes(ship, 5.0 * KNOT)
    assert note.endswith(
        "Power there follows from the resistance; the consumption follows the engine load."
    )
