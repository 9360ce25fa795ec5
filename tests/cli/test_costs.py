"""The same route costs the same by plan, by evaluate from the shell and by the library."""

import argparse
import json

import numpy as np
import pytest
import xarray as xr

from thalweg import Chart, Sea, Ship, Voyage, evaluate, plan
from thalweg.cli.main import main
from thalweg.cli.option_values import with_given_prices
from thalweg.cli.options import add_price_options
from thalweg.core.errors import InputError
from thalweg.core.units import KNOT

START, GOAL = (55.0, 4.0), (55.0, 5.0)  # in the North Sea, inside a control area
BULKER = Ship.load("handysize-bulker")
SHIP = ("--ship", "handysize-bulker", "--calm", "--coast", "none")
DEPART = ("--depart", "2026-01-01T00:00Z")


@pytest.fixture
def track(tmp_path):
    path = tmp_path / "route.csv"
    path.write_text("lat,lon\n55,4\n55,5\n")
    return str(path)


def run_json(capsys, *arguments):
    code = main([*arguments, "--json"])
    return code, json.loads(capsys.readouterr().out)


@pytest.mark.slow
def test_a_route_costs_the_same_by_plan_shell_and_library(capsys, track):
    """Table 5.2 of Seuren (2020): 300 USD/t outside, 1.5593 times that inside."""
    code, plan = run_json(capsys, "plan", "55,4", "55,5", *SHIP, *DEPART)
    planned = plan["routes"][0]
    assert code == 0
    assert planned["fuel_eca_t"] == pytest.approx(planned["fuel_t"], rel=1e-9)
    assert planned["cost_usd"] == pytest.approx(300.0 * 1.5593 * planned["fuel_t"], rel=1e-9)
    _, scored = run_json(capsys, "evaluate", track, *SHIP, *DEPART)
    assert scored["cost_usd"] == pytest.approx(planned["cost_usd"], rel=1e-6)
    for chart in (None, Chart.open_water(), Chart.open_water().with_eca()):
        given = evaluate([START, GOAL], ship=BULKER, sea=Sea.calm(), chart=chart, depart=0)
        assert given.cost == pytest.approx(scored["cost_usd"], rel=1e-9)


@pytest.mark.slow
def test_every_route_of_a_front_pays_for_its_fuel_in_control_areas():
    voyage = Voyage(start=START, goal=GOAL, depart=0, objective="front", method="exact")
    found = plan(
        voyage, ship=BULKER, sea=Sea.calm(), chart=Chart.open_water(), resolution=40e3, proof=0
    )
    assert found.front.criterion == "cost" and len(found.routes) > 2
    for route in found.routes:
        assert route.fuel_eca_t == pytest.approx(route.fuel_t, rel=1e-9)
        assert route.cost == pytest.approx(300.0 * 1.5593 * route.fuel_t, rel=1e-6)


@pytest.mark.slow
def test_without_control_areas_the_fuel_inside_is_unknown(capsys, track):
    _, plan = run_json(capsys, "plan", "55,4", "55,5", *SHIP, *DEPART, "--no-eca")
    _, scored = run_json(capsys, "evaluate", track, *SHIP, *DEPART, "--no-eca")
    for route in (plan["routes"][0], scored):
        assert route["fuel_eca_t"] is None
        assert route["cost_usd"] == pytest.approx(300.0 * route["fuel_t"], rel=1e-9)


@pytest.mark.slow
def test_prices_of_the_command_count_whatever_is_minimised(capsys, track):
    prices = ("--fuel-price", "600", "--eca-price-factor", "2", "--time-price", "100")
    _, plan = run_json(capsys, "plan", "55,4", "55,5", *SHIP, *DEPART, *prices)
    _, scored = run_json(capsys, "evaluate", track, *SHIP, *DEPART, *prices)
    for route in (plan["routes"][0], scored):
        expected = 1200.0 * route["fuel_t"] + 100.0 * route["time_h"]
        assert route["cost_usd"] == pytest.approx(expected, rel=1e-9)
        parts = route["cost_parts"]
        assert parts["fuel"] == pytest.approx(1200.0 * route["fuel_t"], rel=1e-9)
        assert parts.pop("EU ETS") is None and parts.pop("FuelEU") is None
        assert sum(parts.values()) == pytest.approx(route["cost_usd"], rel=1e-12)


def test_every_sum_names_its_currency_its_prices_and_their_source(capsys, track):
    _, scored = run_json(capsys, "evaluate", track, *SHIP, *DEPART, "--time-price", "100")
    prices = scored["prices"]
    assert scored["currency"] == prices["currency"] == "USD"
    assert prices["fuel_per_t"] == {"value": 300.0, "source": "ship file"}
    assert prices["fuel_in_eca_per_t"]["value"] == pytest.approx(467.79)
    assert prices["time_per_day"] == {"value": pytest.approx(2400.0), "source": "request"}


@pytest.fixture
def depth_file(tmp_path):
    depth = tmp_path / "depth.nc"
    lat, lon = np.linspace(54.5, 55.5, 11), np.linspace(3.5, 5.5, 21)
    grid = xr.DataArray(
        np.full((11, 21), -12.0), coords={"lat": lat, "lon": lon}, dims=("lat", "lon")
    )
    grid.attrs = {"standard_name": "height_above_mean_sea_level", "units": "m"}
    xr.Dataset({"elevation": grid}).to_netcdf(depth)
    return str(depth)


def test_a_route_that_breaks_a_limit_ends_with_code_4_and_shows_its_clearance(
    capsys, track, depth_file
):
    charted = ("evaluate", track, *SHIP, *DEPART, "--depth", depth_file)
    assert main([*charted]) == 0
    assert "least under-keel clearance 2.5 m" in capsys.readouterr().out  # draught 9.5 m
    code, scored = run_json(capsys, *charted, "--ukc", "3")
    assert code == 4 and not scored["feasible"]
    assert scored["min_ukc_m"] == pytest.approx(2.5)


@pytest.mark.slow
def test_evaluate_requires_the_clearance_of_the_ship_file(capsys, track, tmp_path, depth_file):
    ship = tmp_path / "ship.yaml"
    ship.write_text(
        "name: coaster\nspeeds_kn: [10]\nhull: {draught_m: 9.5}\nmodels: {calm_water: none}\n"
        "limits: {min_under_keel_clearance_m: 3}\n"
    )
    words = ("evaluate", track, "--ship", str(ship), "--calm", "--coast", "none", *DEPART)
    charted = (*words, "--depth", depth_file)
    code, scored = run_json(capsys, *charted)
    assert code == 4 and scored["violations"][0]["limit"] == 3.0
    assert scored["min_ukc_m"] == pytest.approx(2.5)
    assert main([*charted, "--ukc", "2"]) == 0
    assert "all kept" in capsys.readouterr().out
    assert main([*words]) == 0
    stated = "depth under the keel NOT checked (the ship file requires 3 m: give --depth FILE)"
    assert stated in capsys.readouterr().out
    main(["plan", "55,4", "55,5", *words[2:]])
    assert stated in capsys.readouterr().out
    note = "The ship file requires 3 m: give a depth file (--depth)."
    for command in (words, ("plan", "55,4", "55,5", *words[2:])):
        assert any(note in text for text in run_json(capsys, *command)[1]["notes"])


def test_charges_of_the_european_union_are_a_part_of_the_cost(capsys, track):
    words = ("--ets-price", "80", "--eu-share", "100", "--eu-year", "2024")
    _, scored = run_json(capsys, "evaluate", track, *SHIP, *DEPART, *words)
    expected = 0.4 * 80.0 * scored["co2_t"]
    assert scored["cost_parts"]["EU ETS"] == pytest.approx(expected, rel=1e-9)
    code, refusal = run_json(capsys, "evaluate", track, *SHIP, *DEPART, "--ets-price", "80")
    assert code == 2 and "share of the voyage" in json.dumps(refusal)


@pytest.mark.parametrize(
    ("ends", "share"),
    [
        (("Rotterdam", "Hamburg"), 1.0),
        (("Rotterdam", "Felixstowe"), 0.5),
        (("NLRTM", "NOBGO"), 1.0),
    ],
)
def test_the_european_share_follows_from_the_ports(ends, share):
    parser = argparse.ArgumentParser()
    add_price_options(parser)
    chosen = parser.parse_args(["--ets-price", "80"])
    chosen.start, chosen.goal = ends
    charges = with_given_prices(BULKER, chosen).fuel_terms.charges
    assert charges.voyage_share == share
    assert ends[0] != "Rotterdam" or charges.share_source.startswith("Rotterdam, NL to ")
    chosen.eu_share = 0
    assert with_given_prices(BULKER, chosen).fuel_terms.charges.voyage_share == 0.0
    chosen.eu_share, chosen.goal = None, "55N 5E"
    with pytest.raises(InputError, match="share of the voyage"):
        with_given_prices(BULKER, chosen)


def test_a_held_speed_is_named_and_needs_a_speed(capsys, track):
    _, scored = run_json(
        capsys, "evaluate", track, *SHIP, *DEPART, "--speed", "12", "--hold", "speed"
    )
    assert scored["engine_order"] == "constant speed"
    assert scored["time_h"] == pytest.approx(scored["distance_nm"] / 12.0, rel=1e-6)
    code, _ = run_json(capsys, "evaluate", track, *SHIP, *DEPART, "--hold", "speed")
    assert code == 2


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (
            ["--ets-price", "80"],
            "EU ETS on 50 % by the rules of 2026, FuelEU not counted (no --eur-rate)",
        ),
        (
            ["--eur-rate", "1.1"],
            "FuelEU on 50 % by the rules of 2026, EU ETS not counted (no --ets-price)",
        ),
        (["--ets-price", "80", "--eur-rate", "1.1"], "EU charges on 50 % by the rules of 2026\n"),
        (
            ["--ets-price", "80", "--eu-year", "2024"],
            "EU charges on 50 % by the rules of 2024\n",
        ),  # before FuelEU
    ],
)
def test_the_cost_says_which_charges_do_not_count(capsys, track, options, words):
    """Only plan.json had it."""
    assert main(["evaluate", track, *SHIP, *DEPART, "--eu-share", "50", *options]) == 0
    (line,) = (x for x in capsys.readouterr().out.splitlines() if x.startswith("Cost"))
    assert words in line + "\n"


def test_a_price_of_time_replaces_the_hire_and_both_are_named(capsys, track, tmp_path):
    hired = tmp_path / "hired.yaml"
    hired.write_text(
        "name: hired\nhull: {draught_m: 6.0}\nspeeds_kn: [10, 12]\n"
        "models: {calm_water: table}\ncosts: {hire_per_day: 12000, currency: USD}\n"
        "table: {speed_kn: [10, 12], fuel_t_per_day: [12, 20]}\nfuel: {price_per_t: 600}\n"
    )
    asked = ["evaluate", track, "--ship", str(hired), "--calm", "--coast", "none", *DEPART]
    _, own = run_json(capsys, *asked)
    assert "replaced" not in own["prices"]["time_per_day"]
    _, scored = run_json(capsys, *asked, "--time-price", "1000")
    assert scored["cost_parts"]["time"] == pytest.approx(1000.0 * scored["time_h"])
    assert own["cost_parts"]["time"] == pytest.approx(500.0 * scored["time_h"])
    main([*asked, "--time-price", "1000"])
    words = "time 24,000 USD/day (given in place of 12,000 of the ship file)"
    assert words in capsys.readouterr().out


@pytest.mark.slow
def test_charges_without_prices_are_unknown_and_not_zero(capsys, track):
    """0.0 would say that the European Union charges nothing."""
    _, plan = run_json(capsys, "plan", "55,4", "55,5", *SHIP, *DEPART)
    _, scored = run_json(capsys, "evaluate", track, *SHIP, *DEPART)
    for route in (plan["routes"][0], scored):
        parts = route["cost_parts"]
        assert parts.pop("EU ETS") is None and parts.pop("FuelEU") is None
        assert sum(parts.values()) == pytest.approx(route["cost_usd"], rel=1e-9)
        reasons = route["prices"]["european_charges"]["not_counted"]
        assert [text.partition(":")[0] for text in reasons] == [
            "emission allowances", "FuelEU penalty",
        ]  # fmt: skip
    charges = ("--eu-share", "50", "--ets-price", "80")
    _, scored = run_json(capsys, "evaluate", track, *SHIP, *DEPART, *charges)
    assert scored["cost_parts"]["EU ETS"] > 0.0 and scored["cost_parts"]["FuelEU"] is None
    assert len(scored["prices"]["european_charges"]["not_counted"]) == 1


def test_an_evaluated_route_is_printed_in_twelve_lines_at_most(capsys, track, tmp_path):
    assert main(["evaluate", track, *SHIP, *DEPART, "--out", str(tmp_path / "o")]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) <= 12 and lines[-1].startswith("Files ")
    assert any("fuel 300 USD/t and 468 in control areas (ship file)" in line for line in lines)
    assert main(["evaluate", track, *SHIP, *DEPART, "--verbose"]) == 0
    assert "55.000N   4.000E" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--eu-year", "1990"], "charges.year is 1990.\n  It is a year from 2024 to 2060."),
        (["--ets-price", "1e7"], "charges.ets_price is 10000000.0."),
        (["--eur-rate", "-1"], "charges.eur_rate is -1.0.\n  It is a number from 0 to 100,000."),
    ],
)
def test_charges_of_plans_are_of_possible_sizes(capsys, options, words):
    argv = ["plan", "Dover", "Calais", "--ship", "handysize-bulker", "--calm", *DEPART, *options]
    assert main([*argv, "--quiet"]) == 2
    assert words in capsys.readouterr().err


def test_ordered_speeds_of_routes_end_at_100_knots():
    """Of a ship by the cubic law, whose file sets no highest speed."""
    hull = {"draught_m": 6.0}
    fuel = {"reference_t_per_day": 30.0}
    data = {"name": "x", "speeds_kn": [10, 17], "hull": hull, "fuel": fuel}
    ship = Ship.from_dict(data | {"engine": {"reference_speed_kn": 17.0}})
    assert ship.with_speeds([60.0 * KNOT]).speeds[0] == pytest.approx(60.0 * KNOT)
    with pytest.raises(
        InputError, match="above 0 and at most 100 kn; the ship file gives 10 to 17 kn"
    ):
        ship.with_speeds([200.0 * KNOT])


@pytest.mark.parametrize(
    ("depart", "rules", "share"),
    [("2025-06-01", 2025, 0.7), ("2024-06-01", 2024, 0.4), ("1998-06-01", 2026, None)],
)
def test_the_european_rules_are_those_of_the_year_of_departure(capsys, track, depart, rules, share):
    asked = ["evaluate", track, *SHIP, "--depart", depart, "--eu-share", "100", "--ets-price", "80"]
    _, scored = run_json(capsys, *asked)
    assert scored["prices"]["european_charges"]["year"] == rules
    _, later = run_json(capsys, *asked, "--eu-year", "2026")
    if share is None:
        assert scored["cost_parts"] == later["cost_parts"]
    else:  # methane and nitrous oxide count from 2026 on
        part = scored["cost_parts"]["EU ETS"] / later["cost_parts"]["EU ETS"]
        assert share * 0.97 < part < share


def test_the_european_rules_of_a_route_file_are_those_of_its_times(capsys, tmp_path):
    """A voyage of 2024 was charged in full, as one of 2026."""
    path = tmp_path / "route.csv"
    path.write_text(
        "lat,lon,time\n51.0,1.5,2024-06-01T00:00Z\n51.1,1.6,2024-06-01T01:00Z\n", encoding="utf-8"
    )
    asked = ["evaluate", str(path), *SHIP, "--eu-share", "100", "--ets-price", "80"]
    _, scored = run_json(capsys, *asked)
    assert scored["prices"]["european_charges"]["year"] == 2024
