"""Tables 4.4 to 4.6 of Schless (2023), "Going with the flow": a dredger across the North Sea.

What the thesis does not print was found from its results: a path of 999 steps of 50 m, energy
that counts 5 % of the installed power on top of the brake power, a bulb of C_BB = 0.2 whose
centre is at the highest place the method allows (0.6 of the draught, a third of the whole
resistance), water of 1025 kg/m3 and 1e-6 m2/s, a transom of 0.2 B T, appendages of 5 % of the
wetted surface with 1 + k2 = 2.5, and one calibrated constant, the hull efficiency 1.029. Test
case 2 (the depth falls from 20 to 8 m) is missed by 1.6 %: the final program of the thesis has
some detail of the depth that is not described. Table 4.6 was made with the ellipse of Table 4.9
(0.7 m/s along the coast, 0.35 m/s across, uniform), not with the profile of Table 2.1;
it is met within 0.9 %.
"""

import numpy as np
import pytest

from tests.reference.schless_2023 import COAST, GENERATOR, TIDE, dredger, offshore, waters
from thalweg.operations.waiting import Departures, trip_table
from thalweg.sea.models.stratified_coast import TIDAL_ELLIPSES
from thalweg.ship.methods.propulsion.propulsion_factors import (
    Efficiencies,
)
from thalweg.ship.methods.resistance.holtrop_form import hull_form, wetted_surface
from thalweg.ship.methods.resistance.holtrop_mennen import BulbTransomAppendages, holtrop
from thalweg.ship.methods.shallow_water.shallow_water_resistance import (
    karpov_speed,
    zeng_2019_friction,
)

LENGTH, BREADTH, BLOCK, INSTALLED = 95.57, 19.93, 0.85, 6542e3
MIDSHIP = 1.006 - 0.0056 * BLOCK**-3.56
EFFICIENCY = Efficiencies(hull=1.029).total
STEPS, STEP = 999, 50.0


def resistance(speed, depth, draught, drift_deg):
    hull = hull_form(
        length_waterline=LENGTH,
        breadth=BREADTH,
        draught=draught,
        displacement=BLOCK * LENGTH * BREADTH * draught,
        midship_coefficient=MIDSHIP,
        waterplane_coefficient=(1.0 + 2.0 * BLOCK) / 3.0,
        lcb_percent=-13.5 + 19.4 * BLOCK / MIDSHIP,
    )
    section = 0.2 * BREADTH * draught
    surface = wetted_surface(hull, bulb_area=section * MIDSHIP)
    calm = holtrop(
        speed,
        hull,
        year=1984,
        bulb_transom_appendages=BulbTransomAppendages(
            bulb_area=section * MIDSHIP,
            bulb_centre_height=0.6 * draught,
            transom_area=section,
            appendage_area=0.05 * surface,
            appendage_factor=2.5,
        ),
        wetted_surface_area=surface,
        correlation_area="hull",
        friction_coefficient=zeng_2019_friction(
            speed * LENGTH / 1e-6,
            depth=depth,
            draught=draught,
            length=LENGTH,
            wetted_surface=surface,
            flat_bottom_area=LENGTH * BREADTH,
        ),
        wave_speed=karpov_speed(speed, depth=depth, draught=draught, raw_bands=True, gravity=9.81),
        density=1025.0,
        gravity=9.81,
    ).total
    turned = 3.0777e-4 * drift_deg**2 + 5.5666e-3 * drift_deg + 6.54e-4
    rudder = 0.5 * 1025.0 * 10.0 * speed**2 * np.where(drift_deg > 1e-9, turned, 0.0)
    return calm + rudder


def sail(power, depth=20.0, draught=5.0, along=0.0, across=0.0):
    """Speeds at constant brake power by bisection; hours and kWh over the path."""
    depth, draught = np.broadcast_arrays(
        *(np.linspace(*ends, STEPS + 1)[:-1] for ends in map(_ends, (depth, draught)))
    )
    low, high = np.full(depth.shape, 2.0), np.full(depth.shape, 12.0)
    for _ in range(45):
        speed = 0.5 * (low + high)
        drift = np.degrees(np.arctan2(abs(across), speed + along))
        enough = resistance(speed, depth, draught, drift) * speed / EFFICIENCY < power
        low, high = np.where(enough, speed, low), np.where(enough, high, speed)
    ground = (low + along) * np.cos(np.arctan2(across, low + along))
    hours = float(np.sum(STEP / ground)) / 3600.0
    return hours, (power + 0.05 * INSTALLED) / 1000.0 * hours


def _ends(value):
    return value if isinstance(value, tuple) else (value, value)


@pytest.mark.parametrize(
    ("case", "kilowatt_hours", "hours"),
    [
        ({"power": 3000e3}, 7987.14, 2.40),
        ({"power": 3000e3, "draught": (5.0, 1.0)}, 7476.88, 2.25),
        ({"power": 3000e3, "draught": (5.0, 9.0)}, 8495.79, 2.56),
        ({"power": 2500e3}, 7215.02, 2.56),
        ({"power": 3500e3}, 8731.06, 2.28),
    ],
    ids=["1", "3.1", "3.2", "4.1", "4.2"],
)
def test_table_4_4(case, kilowatt_hours, hours):
    got_hours, energy = sail(**case)
    assert energy == pytest.approx(kilowatt_hours, rel=3e-3)
    assert got_hours == pytest.approx(hours, abs=0.0101)  # two of the printed hours are 0.01 high


def test_table_4_4_case_2_is_missed_by_a_known_amount():
    _, energy = sail(3000e3, depth=(20.0, 8.0))
    assert energy / 8255.54 - 1.0 == pytest.approx(-0.0163, abs=0.001)


@pytest.mark.parametrize(
    ("angle_deg", "kilowatt_hours", "hours"),
    [
        (0.0, 9658.19, 2.91),
        (30.0, 9540.34, 2.87),
        (60.0, 9019.84, 2.71),
        (90.0, 8248.36, 2.48),
        (120.0, 7509.25, 2.26),
        (150.0, 7002.81, 2.11),
        (180.0, 6809.04, 2.05),
    ],
)
def test_table_4_5(angle_deg, kilowatt_hours, hours):
    """A current of 1 m/s, angle from the offshore direction, with the rudder drag of the thesis."""
    angle = np.radians(angle_deg)
    got_hours, energy = sail(3000e3, along=-np.cos(angle), across=np.sin(angle))
    assert energy == pytest.approx(kilowatt_hours, rel=1e-3)
    assert got_hours == pytest.approx(hours, abs=0.01)


def test_table_4_6():
    """Test case 6, through the ships and seas of the package and at four starting times."""
    sea = waters(
        TIDAL_ELLIPSES["neap"], decay=np.inf, depth=lambda time, lat, lon: 20.0 + 0.0 * lat
    )
    table = trip_table(
        [offshore(STEPS * STEP), COAST],
        ship=dredger(5.0),
        sea=sea,
        departures=Departures(0.0, period=TIDE, step=0.25 * TIDE),
    )
    energy = (table.energy + GENERATOR * table.duration) / 3.6e6
    assert energy == pytest.approx([7896.24, 7736.08, 8348.65, 8431.31], rel=9e-3)
    assert table.duration / 3600.0 == pytest.approx([2.38, 2.33, 2.51, 2.53], abs=0.025)
    assert energy.argsort().tolist() == [1, 0, 2, 3]


def test_the_bulb_is_a_third_of_the_resistance():
    speed = np.array([5.779])
    total = resistance(speed, np.array([20.0]), np.array([5.0]), np.array([0.0]))
    assert total[0] / 1000.0 == pytest.approx(295.5, abs=1.0)
