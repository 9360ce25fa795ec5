"""Plans for least energy, and for the cost of time and cubed speed, where the best is known."""

import csv
import json
import math

import numpy as np
import pytest

from thalweg import Chart, InputError, Sea, Ship, Voyage, plan
from thalweg.cli.main import main
from thalweg.core.geodesy import distance
from thalweg.ship import Conditions

START, GOAL = (0.0, 0.0), (0.0, 2.0)
CHART = Chart.open_water(-0.3, 0.3, -0.2, 2.2)
KNOT, HOUR, WEEK = 1852.0 / 3600.0, 3600.0, 604800.0
LENGTH = float(distance(*START, *GOAL))
DEPART = 1767225600.0  # 2026-01-01
HOTEL = 0.7  # MW
CAREFULLY = {"arrive_by": DEPART + 26.0 * HOUR, "spacing_nm": 2.0}
PER_WEEK, PER_CUBE = 700_000.0, 0.008  # lambda_t and lambda_f of van Halem (2019), listing 5.2


def powered(hotel_kw=1000.0 * HOTEL, speeds=(4.0, 6.0, 8.0, 10.0, 12.0)):
    """A ship of 3 MW at 12 kn by the cubic law, whose fuel is not known."""
    data = {
        "name": "powered",
        "hull": {"draught_m": 5.0},
        "speeds_kn": list(speeds),
        "engine": {
            "reference_speed_kn": 12.0,
            "reference_power_kw": 3000.0,
            "hotel_load_kw": hotel_kw,
        },
        "models": {"calm_water": "cubic"},
    }
    return Ship.from_dict(data)


def power(speed_kn):
    """Brake power of that ship [MW]."""
    return 3.0 * (speed_kn / 12.0) ** 3


def dredger(speeds=(6.0, 8.0, 10.0, 12.0), **sections):
    costs = {"per_week": PER_WEEK, "per_second_per_cubed_speed": PER_CUBE}
    data = {"name": "dredger", "hull": {"draught_m": 5.0}, "speeds_kn": list(speeds)}
    return Ship.from_dict({**data, "costs": costs, **sections})


def per_second(speed_kn):
    """What a second of sailing costs that ship."""
    return PER_WEEK / WEEK + PER_CUBE * (speed_kn * KNOT) ** 3


def hours(speed_kn):
    return LENGTH / (speed_kn * KNOT) / HOUR


def planned(objective, ship, *, sea=None, spacing_nm=6.0, **more):
    request = {"method": "exact", **more}
    voyage = Voyage(start=START, goal=GOAL, depart=DEPART, objective=objective, **request)
    return plan(
        voyage, ship=ship, sea=sea or Sea.calm(), chart=CHART, resolution=spacing_nm * 1852.0
    )


def head_current(speed_kn, until_h):
    """A current against the way up to a moment, that ceases evenly within the next three hours."""
    stop = DEPART + (until_h + 3.0) * HOUR

    def east(time, lat, lon):
        return -speed_kn * KNOT * np.clip((stop - time) / (3.0 * HOUR), 0.0, 1.0) + 0.0 * lat

    return Sea.from_functions(
        {
            "eastward_sea_water_velocity": east,
            "northward_sea_water_velocity": lambda t, a, o: 0.0 * a,
        },
        time_step=600.0,
        period=(DEPART, DEPART + 72.0 * HOUR),
    )


def best_wait(always, sailing):
    """Return how long to wait at 8 kn against 6 kn that cease from 3 h to 6 h, and the total.

    An hour counts ``always``, and ``sailing`` more under way. Leaving a moment earlier, against c,
    gains 1 - c / 8 of it in time and costs c / 8 of it in sailing: the ship leaves when the current
    is down to 8 always / (always + sailing).
    """
    current = 8.0 * always / (always + sailing)
    wait = 0.0 if current >= 6.0 else 6.0 - 3.0 * current / 6.0
    lost = 3.0 * 6.0 + 9.0 if wait == 0.0 else 0.5 * current * (6.0 - wait)  # nm to the current
    time = wait + hours(8.0) + lost / 8.0
    return wait, always * time + sailing * (time - wait)


# energy


@pytest.mark.slow
def test_least_energy_weighs_the_hotel_load_against_the_speed():
    # (P(v) + hotel) / v is least where 2 P = hotel: at 5.9 kn, of the speeds there are at 6 kn
    answer = planned("energy", powered(), method="default")
    wanted = {v: (power(v) + HOTEL) * hours(v) for v in (4.0, 6.0, 8.0, 10.0, 12.0)}
    assert min(wanted, key=wanted.get) == 6.0
    assert answer.best.energy_mwh == pytest.approx(wanted[6.0], rel=1e-6)
    assert answer.objective_value == answer.best.energy_mwh and answer.unit == "MWh"
    assert answer.solver_total == pytest.approx(wanted[6.0], rel=1e-3)
    assert answer.proof.certain == pytest.approx(wanted[6.0], rel=1e-5)
    assert answer.lower_bound <= answer.objective_value * (1.0 + 1e-9)
    assert answer.best.fuel_t is None  # its fuel is not known, and not needed


@pytest.mark.slow
def test_without_a_hotel_load_the_slowest_speed_takes_least():
    answer = planned("energy", powered(hotel_kw=0.0))
    assert answer.best.energy_mwh == pytest.approx(power(4.0) * hours(4.0), rel=1e-6)


@pytest.mark.slow
def test_a_deadline_mixes_two_speeds_at_least_energy():
    # 9 kn on the mean: half the time at 8, half at 10 kn
    time = hours(9.0)
    answer = planned("energy", powered(), arrive_by=DEPART + time * HOUR)
    wanted = time * (0.5 * power(8.0) + 0.5 * power(10.0) + HOTEL)
    assert answer.best.arrive <= DEPART + time * HOUR + 1.0
    assert answer.best.energy_mwh == pytest.approx(wanted, rel=0.01)
    assert answer.best.energy_mwh >= wanted * (1.0 - 1e-4)


@pytest.mark.slow
@pytest.mark.parametrize("hotel_kw", [200.0, 2900.0])
def test_waiting_consumes_the_hotel_load_and_saves_energy_only_if_it_is_small(hotel_kw):
    ship = powered(hotel_kw=hotel_kw, speeds=(8.0,))
    best = planned("energy", ship, sea=head_current(6.0, 3.0), **CAREFULLY).best
    hotel, sailing = hotel_kw / 1e3, best.time_h - best.waiting_h
    assert best.energy_mwh == pytest.approx(power(8.0) * sailing + hotel * best.time_h, rel=1e-9)
    wait, wanted = best_wait(hotel, power(8.0))
    assert (wait > 0.0) is (hotel_kw == 200.0)
    assert best.waiting_h == pytest.approx(wait, abs=0.75)  # about the best it hardly matters
    assert best.energy_mwh == pytest.approx(wanted, rel=5e-3)


@pytest.mark.slow
def test_energy_of_a_resistance_ship_is_its_power_and_hotel_load_over_time():
    hull = {"length_between_perpendiculars_m": 169.0, "length_waterline_m": 172.4}
    hull |= {"breadth_m": 32.0, "draught_m": 10.0, "block_coefficient": 0.785}
    ship = Ship.from_dict(
        {
            "name": "resisting",
            "hull": hull,
            "speeds_kn": [4.0, 6.0, 8.0, 10.0, 12.0],
            "engine": {"power_kw": 9000, "hotel_load_kw": 600},
            "models": {"calm_water": "holtrop_1984"},
        }
    )
    answer = planned("energy", ship)
    settings = np.arange(len(ship.speeds))
    needed = ship.power(Conditions(), settings)
    wanted = ((needed + 600e3) * LENGTH / ship.speeds).min() / 3.6e9
    assert answer.best.energy_mwh == pytest.approx(wanted, rel=1e-5)


def test_energy_of_a_ship_whose_power_is_unknown_is_refused():
    for ship in (Ship.simple(speeds_kn=[8.0, 10.0], fuel_t_per_day=10.0), dredger()):
        with pytest.raises(InputError, match="brake power is unknown") as told:
            planned("energy", ship)
        assert "power_kw" in told.value.possible and told.value.remedy
    field = Ship.from_speed_function(lambda c: 4.0 + 0.0 * c.lat, top_speed=4.0)
    with pytest.raises(InputError, match="speed is a field"):
        planned("energy", field)


@pytest.mark.slow
def test_json_and_files_contain_the_energy(tmp_path):
    answer = planned("energy", powered())
    told = json.loads(answer.to_json())
    assert told["objective_unit"] == "MWh"
    assert told["routes"][0]["energy_mwh"] == answer.best.energy_mwh
    assert told["front"]["criterion"] == "energy"
    assert told["front"]["points"][0]["energy_mwh"] == answer.best.energy_mwh
    answer.write(tmp_path)
    with (tmp_path / "front.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert float(rows[0]["energy_mwh"]) == answer.best.energy_mwh
    with (tmp_path / "route.csv").open() as file:
        last = list(csv.DictReader(file))[-1]
    assert float(last["energy_mwh"]) == pytest.approx(answer.best.energy_mwh, abs=1e-3)


@pytest.mark.slow
def test_the_command_line_plans_for_energy(tmp_path, capsys):
    path = tmp_path / "ship.yaml"
    path.write_text(
        "name: powered\nhull: {draught_m: 5.0}\nspeeds_kn: [4, 6, 8]\nmodels: {calm_water: cubic}\n"
        "engine: {reference_speed_kn: 12, reference_power_kw: 3000, hotel_load_kw: 700}\n"
    )
    words = ["0,0", "0,2", "--calm", "--coast", "none", "--depart", "2026-01-01T00:00Z"]
    words += ["--resolution", "6", "--method", "exact", "--objective", "energy"]
    assert main(["plan", *words, "--ship", str(path)]) == 0
    assert "21.54 MWh" in capsys.readouterr().out
    assert main(["plan", *words, "--ship", "hopper-dredger"]) == 2
    assert "brake power" in capsys.readouterr().err


@pytest.mark.slow
@pytest.mark.parametrize("objective", ["energy", "cost"])
def test_search_and_referee_agree_in_a_steady_current(objective):
    # against 3 kn a mile over ground takes 1 / (v - 3) hours: a higher speed saves fuel
    ship = powered() if objective == "energy" else dredger()
    rate = (lambda v: power(v) + HOTEL) if objective == "energy" else per_second
    speeds = np.round(ship.speeds / KNOT, 6)
    per_mile = {v: rate(v) / (v - 3.0) for v in speeds}
    best = min(per_mile, key=per_mile.get)
    assert best == 8.0 if objective == "energy" else best == 10.0
    answer = planned(objective, ship, sea=head_current(3.0, 1000.0))
    unit = 1.0 if objective == "energy" else HOUR
    wanted = per_mile[best] * LENGTH / KNOT / HOUR * unit
    assert answer.objective_value == pytest.approx(wanted, rel=1e-3)
    assert answer.solver_total == pytest.approx(answer.objective_value, rel=2e-3)


# time and cubed speed


@pytest.mark.slow
def test_least_cost_by_lambda_is_at_the_speed_of_the_closed_form():
    # (lambda_t + lambda_f v^3) / v is least at v = (lambda_t / (2 lambda_f))^(1/3), 8.1 kn here
    best = (PER_WEEK / WEEK / (2.0 * PER_CUBE)) ** (1.0 / 3.0) / KNOT
    ship = dredger(speeds=(6.0, best, 10.0, 12.0))
    answer = planned("cost", ship)
    assert answer.best.track.setting.tolist() == [1] * len(answer.best.track.setting)
    assert answer.best.cost == pytest.approx(per_second(best) * hours(best) * HOUR, rel=1e-6)
    assert answer.best.cost == pytest.approx(1.5 * PER_WEEK / WEEK * hours(best) * HOUR, rel=1e-6)
    assert answer.solver_total == pytest.approx(answer.best.cost, rel=1e-3)
    assert answer.proof.certain == pytest.approx(answer.best.cost, rel=1e-5)
    assert answer.unit == "USD"


def test_the_library_dredger_has_the_cost_of_its_study():
    ship = Ship.load("hopper-dredger")
    (speed,) = ship.speeds / KNOT
    answer = planned("cost", ship)
    assert answer.best.cost == pytest.approx(per_second(speed) * hours(speed) * HOUR, rel=1e-6)


@pytest.mark.slow
def test_a_deadline_mixes_two_speeds_at_least_cost():
    time = hours(9.0)
    answer = planned("cost", dredger(), arrive_by=DEPART + time * HOUR)
    wanted = time * HOUR * (0.5 * per_second(8.0) + 0.5 * per_second(10.0))
    slowest = min(wanted, per_second(8.0) * hours(8.0) * HOUR)
    assert answer.best.arrive <= DEPART + time * HOUR + 1.0
    assert slowest < wanted  # the deadline is what makes it sail faster
    assert answer.best.cost == pytest.approx(wanted, rel=0.01)
    assert answer.best.cost >= wanted * (1.0 - 1e-4)


@pytest.mark.slow
@pytest.mark.parametrize("per_cube", [0.008, 0.002])
def test_waiting_costs_time_and_no_speed(per_cube):
    costs = {"per_week": 350_000.0, "per_second_per_cubed_speed": per_cube}
    ship = dredger(speeds=(8.0,), costs=costs)
    best = planned("cost", ship, sea=head_current(6.0, 3.0), **CAREFULLY).best
    time, cube = HOUR * 350_000.0 / WEEK, HOUR * per_cube * (8.0 * KNOT) ** 3
    sailing = best.time_h - best.waiting_h
    assert best.cost == pytest.approx(time * best.time_h + cube * sailing, rel=1e-9)
    wait, wanted = best_wait(time, cube)
    assert (wait > 0.0) is (per_cube == 0.008)
    assert best.waiting_h == pytest.approx(wait, abs=0.75)
    assert best.cost == pytest.approx(wanted, rel=5e-3)


@pytest.mark.slow
def test_a_price_of_fuel_overrides_the_price_of_speed():
    data = {"fuel": {"reference_t_per_day": 24.0}, "engine": {"reference_speed_kn": 12.0}}
    ship = dredger(models={"calm_water": "cubic"}, **data)
    by_speed = planned("cost", ship, speed_kn=10.0).best
    by_fuel = planned("cost", ship, speed_kn=10.0, fuel_price_usd=500.0).best
    assert by_speed.cost == pytest.approx(per_second(10.0) * hours(10.0) * HOUR, rel=1e-6)
    wanted = 500.0 * by_fuel.fuel_t + PER_WEEK / WEEK * hours(10.0) * HOUR
    assert by_fuel.cost == pytest.approx(wanted, rel=1e-6)
    dearer = planned("cost", ship, speed_kn=10.0, time_price_usd_per_h=9000.0).best
    more = (9000.0 / HOUR - PER_WEEK / WEEK) * hours(10.0) * HOUR
    assert dearer.cost == pytest.approx(by_speed.cost + more, rel=1e-6)


def test_the_command_line_prints_the_cost_of_the_lambdas(capsys):
    words = ["0,0", "0,2", "--calm", "--coast", "none", "--depart", "2026-01-01T00:00Z"]
    words += [
        "--resolution",
        "6",
        "--method",
        "exact",
        "--objective",
        "cost",
        "--ship",
        "hopper-dredger",
        "--json",
    ]
    assert main(["plan", *words]) == 0
    told = json.loads(capsys.readouterr().out)
    wanted = per_second(10.0) * hours(10.0) * HOUR
    assert told["routes"][0]["cost_eur"] == pytest.approx(wanted, rel=1e-5)
    assert told["objective_unit"] == "EUR" and math.isfinite(told["lower_bound"])


def test_the_library_dredger_emits_by_the_cubed_speed_as_in_its_study():
    """van Halem (2019), eq. 3.5: W = t V^3 [g], by listing 5.2."""
    answer = planned("co2", Ship.load("hopper-dredger"))
    grams = hours(10.0) * HOUR * (10.0 * KNOT) ** 3
    assert answer.best.co2_t == pytest.approx(grams / 1e6, rel=1e-6)
    assert answer.objective_value == answer.best.co2_t and answer.unit == "t"
    assert answer.best.fuel_t is None  # not known, and not needed


def test_the_front_of_a_ship_with_prices_is_that_of_cost():
    answer = planned("front", Ship.load("hopper-dredger"))
    assert answer.front.criterion == "cost" and answer.front.unit == "EUR"


def test_the_absolute_bound_knows_the_cheapest_price_zone():
    """No edge lies in a band 200 m wide, but a route may: at half the price."""
    ring = [[-1, 0.0501], [3, 0.0501], [3, 0.052], [-1, 0.052], [-1, 0.0501]]
    zone = {
        "type": "Feature",
        "properties": {"kind": "price", "factor": 0.5},
        "geometry": {"type": "Polygon", "coordinates": [ring]},
    }
    fuel = {"type": "hfo", "price_per_t": 500.0, "reference_t_per_day": 24.0}
    ship = dredger(speeds=(10.0,), costs={}, fuel=fuel, models={"calm_water": "cubic"})
    voyage = Voyage(start=START, goal=GOAL, depart=DEPART, objective="cost", method="exact")
    water = CHART.with_zones(zone).without_eca()
    answer = plan(voyage, ship=ship, sea=Sea.calm(), chart=water, resolution=6 * 1852.0)
    full = 500.0 * 1.0 * hours(10.0)  # a tonne an hour
    assert answer.best.cost == pytest.approx(full, rel=0.01)
    assert answer.proof.certain <= 0.5 * full * (1.0 + 1e-9)
