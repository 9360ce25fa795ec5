"""A plan in words: what a master reads, and which proofs are stated."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from thalweg import Chart, Sea, Ship, Voyage, plan
from thalweg.chart.canals import KIEL, Canal, canals_with_dues
from thalweg.cli.tables import _print_details
from thalweg.core.geodesy import format_position_minutes, parse_position
from thalweg.core.time import duration_text, utc_text
from thalweg.planning.plan_front import ParetoFront
from thalweg.planning.report.approach_report import APPROACH_TOO_SMALL
from thalweg.planning.report.filled_weather import wave_shares
from thalweg.planning.report.lane_report import AGAINST_TRAFFIC
from thalweg.planning.report.note_order import notes_of_routes
from thalweg.planning.report.plan_summary import (
    MAX_LINES,
    limits_text,
    notes_lines,
    quality_text,
    summary_with_notes,
)
from thalweg.planning.report.route_summary import (
    cost_text,
    kept_text,
    least_clearance_text,
    prices_text,
    route_items,
    weather_text,
)
from thalweg.planning.report.squat_report import SQUAT_UNCOUNTED
from thalweg.planning.request.shoal_choice import SHOALS_OPENED
from thalweg.route import Violation
from thalweg.route.route_tables import LEG_KINDS

WAVES = "sea_surface_wave_significant_height"


@pytest.fixture(scope="module")
def answer():
    sea = Sea.from_functions(
        {
            "eastward_wind": lambda time, lat, lon: 10.0 + 0.0 * lat,
            "northward_wind": lambda time, lat, lon: 0.0 * lat,
            WAVES: lambda time, lat, lon: 2.0 + lon,
            "sea_surface_wave_from_direction": lambda time, lat, lon: 270.0 + 0.0 * lat,
            "sea_surface_wave_period_at_variance_spectral_density_maximum": lambda time, lat, lon: (
                8.0 + 0.0 * lat
            ),
        }
    )
    chart = Chart.open_water(50.0, 52.5, 1.0, 4.0).with_depth(lambda lat, lon: 30.0 - 4.0 * lon)
    voyage = Voyage(start=(51.0, 2.0), goal=(51.5, 3.0), depart="2026-01-01T00:00Z")
    return plan(voyage, ship=Ship.simple(speed_kn=8.0, draught_m=5.0), sea=sea, chart=chart)


@pytest.mark.slow
def test_at_most_twelve_lines_with_what_a_master_needs(answer):
    text = str(answer)
    lines = text.splitlines()
    assert len(lines) <= MAX_LINES and max(map(len, lines)) <= 120
    assert [line.split()[0] for line in lines[1:10]] == [
        "Depart", "Arrive", "Distance", "Fuel", "Cost", "Weather", "Depth", "Limits", "Quality",
    ]  # fmt: skip
    assert "2026-01-01 00:00 UTC" in lines[1]
    assert utc_text(answer.best.arrive) in lines[2]
    assert "highest waves 5.0 m with wind of 19 kn, at 51 30.0N 003 00.0E" in text
    assert "least under-keel clearance 13.0 m at 51 " in lines[7]
    assert "not known: the ship file has no fuel" in text
    for jargon in ("network", "kappa", "bound", "fingerprint"):
        assert jargon not in text.casefold()


def test_one_line_and_a_table_for_notebooks(answer):
    assert repr(answer).count("\n") == 0 and "nm" in repr(answer)
    table = answer._repr_html_()
    assert table.startswith("<table") and "Weather" in table
    odd = replace(answer, notes=("a <b> & c",))
    assert "a &lt;b&gt; &amp; c" in odd._repr_html_()


def test_notes_that_do_not_fit_are_counted(answer):
    many = replace(answer, notes=("No depth in the data: x.", *(f"note {n}" for n in range(9))))
    lines = summary_with_notes(many)
    assert len(lines) == MAX_LINES
    assert lines[-1] == "Note      note 1 (7 more notes: --verbose, plan.notes)"
    assert "No depth" not in "".join(lines)
    assert notes_lines(["a", "b"], 1) == ["Note      a (1 more note: --verbose)"]


def test_notes_on_danger_come_first_and_are_never_hidden(answer):
    dangers = ["Check the depth: x.", "Crosses a bank.", "Runs against the traffic of A.",
               "Passage closed: D.", "Keeping out of B makes the way longer."]  # fmt: skip
    many = replace(answer, notes=(*(f"note {n}" for n in range(9)), *dangers[::-1]))
    shown = [line.partition("      ")[2] for line in summary_with_notes(many)[10:]]
    assert shown[:4] == dangers[:4]
    assert shown[4] == f"{dangers[4]} (9 more notes: --verbose, plan.notes)"
    assert many.to_dict()["notes"][:5] == dangers


def test_notes_of_several_routes():
    found = notes_of_routes(["a."], [["b.", "c.", "Crosses D."], ["b.", "Passes E (one)."]])
    assert found == ["Route 1: Crosses D.", "a.", "b.", "Route 2: Passes E (one)."]
    found = notes_of_routes(["a.", f"{SHOALS_OPENED}: x."], [["Crosses D."], ["Crosses D."]])
    assert found == [f"{SHOALS_OPENED}: x.", "Crosses D.", "a."]


def with_bound(answer, certain, kind="certificate"):
    value = answer.objective_value
    return replace(answer, proof=replace(answer.proof, certain=certain * value, kind=kind))


@pytest.mark.parametrize(
    ("certain", "kind", "text"),
    [
        (0.963, "certificate", "at most 3.7 % less time is possible"),
        (1.0, "certificate", "at most 0.1 % less time is possible"),
        (0.6, "certificate", "at most 40.0 % less time is possible"),
        (
            0.231,
            "certificate",
            "little is proved: the least possible time is between 23 and 100 % of this",
        ),
        (
            0.963,
            "certificate, with land, closed shoals",
            "at most 3.7 % less time is possible outside the shoal water that is closed here",
        ),
        (
            0.963,
            "certificate, in water north of 60 S, without penalties",
            "at most 3.7 % less time is possible north of 60 S",
        ),
        (np.nan, "no bound: the route ends at a pole", "no bound: the route ends at a pole"),
        (0.0, "certificate", "no bound was found"),
    ],
)
def test_the_summary_states_the_certain_bound_or_why_there_is_none(answer, certain, kind, text):
    assert quality_text(with_bound(answer, certain, kind)) == text


def test_details_round_the_gap_as_the_summary_does(answer, capsys):
    bounded = with_bound(answer, 0.8707)
    assert quality_text(bounded) == "at most 13.0 % less time is possible"
    _print_details(bounded)
    assert "at most 13.0 % less than this one (the gap)" in capsys.readouterr().out


def test_a_bound_above_the_route_is_an_error_and_not_hidden(answer):
    with pytest.raises(AssertionError, match="above the value"):
        assert with_bound(answer, 1.158).gap < 0.0


def test_an_interrupted_plan_and_one_that_breaks_a_limit(answer):
    assert quality_text(replace(answer, cancelled=True)).startswith("stopped early; ")
    violation = Violation("wave height above the limit", answer.best.depart, 51.2, 2.5, 4.0, 3.0)
    broken = replace(answer, routes=(replace(answer.best, violations=(violation, violation)),))
    assert quality_text(broken) == "not stated: the route breaks a limit"
    assert limits_text(broken).startswith("NOT KEPT: wave height above the limit at 51 12.0N")
    assert limits_text(broken).endswith("(4.00 m, limit 3.00 m), and 1 more")


def test_only_with_known_depth_all_limits_are_called_kept(answer):
    assert limits_text(replace(answer, rejections={})) == "all kept"
    legs = dict(answer.best.legs)
    legs["under_keel_clearance"] = np.full(len(legs["length"]), np.nan)
    unknown = replace(answer, routes=(replace(answer.best, legs=legs),), rejections={})
    assert limits_text(unknown) == "kept: land, zones; depth under the keel NOT checked"
    warned = replace(unknown, notes=("Check the depth: 9.5 m are required",))
    assert limits_text(warned).endswith(
        "keel TO BE CHECKED: the depth layer has too little, see the note"
    )


def test_limits_that_closed_other_water(answer):
    met = {"land": 900, "under-keel clearance": 5, "wave height above the limit": 20}
    closed = "; other ways were refused for: wave height above the limit, under-keel clearance"
    assert limits_text(replace(answer, rejections=met)).endswith(closed)
    assert "land" in limits_text(replace(answer, rejections={"land": 3}))


def test_weather_is_that_of_the_sea_even_if_the_ship_ignores_it(answer):
    best, sea = answer.best, answer.plot_context.sea
    assert WAVES not in best.samples
    assert weather_text(best, sea).startswith("highest waves 5.0 m")
    assert weather_text(best, None).startswith("calm or not known")
    wind = {"eastward_wind": np.full(len(best.samples["lat"]), -8.0)}
    wind["northward_wind"] = 0.0 * wind["eastward_wind"]
    windy = replace(best, samples=dict(best.samples) | wind)
    assert weather_text(windy, None).startswith("strongest wind 16 kn, at ")


def test_the_weather_of_a_calm_sea_is_calm(answer):
    """A plan on a calm sea said 'calm or not known' where the ship reads no weather."""
    assert weather_text(answer.best, Sea.calm()) == "calm: no wind, waves or currents"


def test_the_share_of_the_way_without_known_waves_is_stated(answer):
    best = answer.best
    along = best.samples["distance"]
    waves = np.where(along > 0.75 * along[-1], np.nan, 2.0)
    text = weather_text(replace(best, samples=dict(best.samples) | {WAVES: waves}), None)
    assert "; waves not known on 2" in text and text.endswith(" % of the way")


def test_filled_waves_and_approaches_without_weather_are_stated(answer):
    """A sea with waves on the first half of the way, and a last leg that is an approach."""
    best = answer.best
    along, count = np.asarray(best.samples["distance"]), len(best.legs["length"])
    waves = {WAVES: np.full(len(along), 2.0)}
    middle = float(np.interp(0.5 * along[-1], along, best.samples["time"]))
    data = Sea.from_functions(
        {WAVES: lambda t, lat, lon: 2.0 + 0.0 * lat}, period=(best.depart - 3600.0, middle)
    )
    sailed = replace(best, samples=dict(best.samples) | waves)
    assert weather_text(sailed, data).count("filled") == 0
    shares = wave_shares(sailed, data.filled(waves=1.0), waves[WAVES])
    assert shares.unknown == 0.0 and shares.approaches == 0.0
    assert shares.filled == pytest.approx(50.0, abs=5.0)
    text = weather_text(sailed, data.filled(waves=1.0))
    assert f"; waves filled, not of the data, on {shares.filled:.0f} % of the way" in text
    kind = np.zeros(count, int)
    kind[-1] = LEG_KINDS.index("approach")
    ended = replace(sailed, legs=dict(best.legs) | {"leg_kind": kind})
    share = 100.0 * best.legs["length"][-1] / best.legs["length"].sum()
    assert weather_text(ended, None).endswith(
        f"; no weather counted on the approaches, {share:.0f} % of the way"
    )


def test_the_uniform_sea_around_a_storm_is_named(answer):
    storm = Sea.storm(start="2026-01-01T00:00Z")
    text = weather_text(answer.best, storm)
    assert "the uniform sea assumed around the storm (waves 1.5 m, wind 10 kn)" in text
    assert text.startswith("highest waves 1.5 m with wind of 10 kn")


def test_the_prices_and_their_sources_stand_beside_the_cost(answer):
    ship = Ship.load("handysize-bulker")
    assert prices_text(ship.fuel_terms.prices()) == (
        "fuel 300 USD/t and 468 in control areas (ship file), no price of time"
    )
    dearer = ship.with_prices(600.0, 1.0, time_usd_per_day=12000.0).fuel_terms.prices()
    assert prices_text(dearer) == "fuel 600 USD/t (given), time 12,000 USD/day (given)"
    by_factor = ship.with_prices(600.0).fuel_terms.prices()
    assert prices_text(by_factor) == (
        "fuel 600 USD/t (given) and 936 in control areas (by the factor of the ship file), "
        "no price of time"
    )
    doubled = ship.with_prices(eca_price_factor=2.0)
    assert prices_text(doubled.fuel_terms.prices()) == (
        "fuel 300 USD/t (ship file) and 600 in control areas (by the given factor), "
        "no price of time"
    )
    both = doubled.with_prices(500.0).fuel_terms.prices()
    assert prices_text(both).startswith("fuel 500 USD/t and 1,000 in control areas (given)")
    legs = dict(answer.best.legs) | {"cost": np.full(len(answer.best.legs["length"]), 50.0)}
    priced = replace(answer.best, legs=legs, prices=dearer)
    assert cost_text(priced, []).endswith(
        " USD; fuel 600 USD/t (given), time 12,000 USD/day (given)"
    )
    assert cost_text(answer.best, []) == "not known: no price of fuel or time"


def test_an_evaluated_route_names_every_limit_that_it_breaks(answer):
    known = answer.plot_context
    violation = Violation("wave height above the limit", answer.best.depart, 51.2, 2.5, 4.0, 3.0)
    later = replace(violation, time=answer.best.arrive)
    broken = replace(answer.best, violations=(violation, violation, later))  # the first of two legs
    rows = route_items(broken, sea=known.sea, chart=known.chart, ship=known.ship)
    words = [word for word, _ in rows]
    assert words == [
        "Depart",
        "Arrive",
        "Distance",
        "Fuel",
        "Cost",
        "Weather",
        "Depth",
        *2 * ["Limits"],
    ]
    assert rows[-1][1].startswith("NOT KEPT: wave height above the limit at 51 12.0N")
    sound = route_items(answer.best, sea=known.sea, chart=known.chart, ship=known.ship)
    assert sound[-1] == ("Limits", "all kept")


def test_times_and_positions_as_they_are_spoken():
    assert duration_text(7 * 86400 + 21 * 3600 + 25 * 60 + 29) == "7 d 21 h 25 min"
    assert duration_text(1800) == "30 min"
    assert utc_text(1767225569.0) == "2025-12-31 23:59 UTC"
    assert utc_text(float("nan")) == "not known"
    text = format_position_minutes(-33.99999, 151.20833)
    assert text == "34 00.0S 151 12.5E"
    assert parse_position(text) == pytest.approx((-34.0, 151.2083), abs=1e-3)


def test_the_parts_of_a_cost_are_stated_where_there_are_several(answer):
    legs = dict(answer.best.legs)
    legs |= {"cost_of_fuel": np.array([1200.0]), "cost_of_time": np.array([3400.4])}
    legs |= {"cost": np.array([4600.4]), "cost_of_eu_allowances": np.array([np.nan])}
    legs |= {"fuel": np.array([4000.0]), "waiting_fuel": np.array([0.0])}
    route = replace(answer.best, legs=legs, prices={"currency": "USD"})
    assert cost_text(route, []).startswith("4,600 USD (fuel 1,200, time 3,400)")
    unburnt = replace(route, legs=legs | {"fuel": np.array([np.nan])})
    assert cost_text(unburnt, []).startswith("4,600 USD (propulsion 1,200, time 3,400)")
    legs["cost_of_time"] = np.array([0.0])
    assert "(" not in cost_text(replace(route, legs=legs), [])


def test_canals_and_their_dues_are_in_the_lines_of_distance_and_cost(answer):
    """The route of the fixture with a canal in its chart from its first to its last waypoint."""
    track = answer.best.track
    ends = ((track.lat[0], track.lon[0]), (track.lat[1], track.lon[1]))
    canal = Canal("ditch", "Great Ditch", ends, transit_time=3600.0, fee=12_345.0)
    chart = replace(answer.plot_context.chart, canals=(canal,))
    passed = replace(answer, plot_context=replace(answer.plot_context, chart=chart))
    lines = str(passed).splitlines()
    assert lines[3].endswith(", by Great Ditch")
    assert "canal dues 12,345 USD" in lines[5]
    assert len(lines) <= MAX_LINES


@pytest.mark.parametrize(("year", "words"), [("1850", ["1850"]), ("1998", []), ("2200", ["2200"])])
def test_a_year_without_weather_is_noted(year, words):
    from types import SimpleNamespace

    from thalweg.core.time import parse_time
    from thalweg.planning.report.provenance import year_warnings

    notes = year_warnings(SimpleNamespace(depart=parse_time(f"{year}-06-01")))
    assert [word for word in words if word in notes[0]] == words and len(notes) == len(words)


def test_the_summary_of_a_front_states_how_far_its_other_routes_may_be(answer):
    certain = np.array([[0.0, 1e4], [0.9, 0.9]])
    front = ParetoFront("fuel", "t", np.array([1.0]), ("fastest",), ("open sea",), certain=certain)
    of_front = replace(
        with_bound(answer, 0.976), voyage=replace(answer.voyage, objective="front"), front=front
    )
    text = (
        "at most 2.4 % less time is possible; "
        "over the front no route is 2.4 % better in both time and fuel; at the same time "
        "at most 10.0 % less fuel is possible"
    )
    assert quality_text(of_front) == text
    weak = quality_text(replace(of_front, front=replace(front, values=np.array([2.0]))))
    assert weak.endswith("how much less fuel is possible at the same time is hardly known")
    unknown = replace(front, certain=np.empty((2, 0)))
    assert quality_text(replace(of_front, front=unknown)) == (
        "at most 2.4 % less time is possible; how much less fuel is possible over the front is not "
        "known"
    )
    every = [quality_text(replace(of_front, front=one)) for one in (front, unknown)]
    assert not any("weak" in text or "bound" in text for text in [*every, weak])


def test_least_fuel_states_how_far_it_may_be_from_routes_that_take_no_longer(answer):
    time, value = answer.best.time_h, 2.0
    certain = np.array([[0.5 * time, time, 1.01 * time, 9 * time], [2.5, 1.99, 1.2, 1.1]])
    front = ParetoFront("fuel", "t", np.array([value]), ("exact",), ("open sea",), certain=certain)
    of_fuel = replace(with_bound(answer, 0.6), front=front)
    text = "at most 40.0 % less time is possible, and at most 0.5 % less without taking longer"
    assert quality_text(of_fuel) == text
    near = replace(front, values=np.array([2.0]), certain=certain - [[0.0], [0.8]])
    assert quality_text(replace(of_fuel, front=near)).endswith("% less time is possible")


def test_an_evaluated_route_states_the_dues_of_the_ship_not_the_mean_of_all(answer):
    """The Kiel Canal, whose ends are here those of the route."""
    track, known = answer.best.track, answer.plot_context
    ends = ((track.lat[0], track.lon[0]), (track.lat[1], track.lon[1]))
    chart = replace(known.chart, canals=(replace(KIEL, path=ends),))
    ship = Ship.load("handysize-bulker")
    (own,) = canals_with_dues([KIEL], ship.file.hull)
    cost = dict(route_items(answer.best, sea=known.sea, chart=chart, ship=ship))["Cost"]
    assert own.fee != KIEL.fee and f"canal dues {own.fee:,.0f} USD (by {own.fee_basis})" in cost


@pytest.mark.parametrize(
    ("least", "text"), [(0.97, "0.9 m"), (1.0, "1.0 m"), (0.99995, "1.0 m"), (-3.16, "-3.16 m")]
)
def test_the_least_clearance_is_never_rounded_up(least, text):
    samples = {"under_keel_clearance": np.full(3, np.nan)}
    route = SimpleNamespace(min_ukc_m=least, samples=samples, violations=())
    assert least_clearance_text(route) == f"least under-keel clearance {text}"


@pytest.mark.parametrize(("least", "text"), [(-1.106, "-1.11"), (1.16, "1.16"), (1.1999, "1.1999")])
def test_the_least_clearance_is_written_as_in_the_limit_that_is_not_kept(least, text):
    """One line said -1.2 m, the other -1.11 m, of the same place and time."""
    shoal = Violation("under-keel clearance", 0.0, 53.0, -3.0, least, 1.2)
    samples = {"under_keel_clearance": np.full(3, np.nan)}
    route = SimpleNamespace(min_ukc_m=least, samples=samples, violations=(shoal,))
    assert least_clearance_text(route) == f"least under-keel clearance {text} m"
    assert f"({text} m, limit 1.20" in str(shoal)


def test_kept_limits_are_those_at_rest_where_squat_takes_the_clearance():
    deep = SimpleNamespace(min_ukc_m=0.2)
    assert kept_text(deep, None, ()) == "all kept"
    squat = f"{SQUAT_UNCOUNTED}: the ship is 0.8 m too deep"
    told = kept_text(deep, None, (squat,))
    assert told == "all kept at rest, NOT with squat: see the note on the clearance"
    both = kept_text(deep, None, (squat, "Waits at sea 2 h"))
    assert both.startswith("all kept under way, see the note on the wait; at rest, NOT with squat")


def test_what_the_referee_does_not_check_is_named_beside_kept_limits():
    """An office that reads this line alone passed a route over the Goodwin Sands, and one that ran
    38 nm against the lane of the Dover Strait."""
    unknown = SimpleNamespace(min_ukc_m=None)
    sands = kept_text(unknown, None, ("Crosses Goodwin Sands (charted as shoal area; known).",))
    assert sands == (
        "SEE THE NOTES on a charted shoal; otherwise kept: land, zones; depth under the keel NOT "
        "checked"
    )
    against = f"{AGAINST_TRAFFIC} of Dover Strait for about 38 nm"
    assert kept_text(unknown, None, (against,)).startswith("SEE THE NOTES on traffic lanes; other")
    small = f"{APPROACH_TOO_SMALL}: that of Baltimore, US"
    both = kept_text(SimpleNamespace(min_ukc_m=2.0), None, (against, small))
    assert both == (
        "SEE THE NOTES on traffic lanes, the size of the ship in a port or passage; otherwise all "
        "kept"
    )


def test_kept_limits_name_safety_and_comfort_in_waves():
    hull = {"length_between_perpendiculars_m": 55.0, "breadth_m": 12.5, "draught_m": 4.2}
    hull |= {"block_coefficient": 0.55, "roll_period_s": 8.5, "metacentric_height_m": 1.1}
    ship = {"name": "research", "hull": hull, "speeds_kn": [8.0], "places": {"mess": 0.0}}
    limits = {"max_motion_sickness_percent": 8, "max_significant_wave_height_m": 4.5}
    comfort = Ship.from_dict({**ship, "limits": limits})
    text = kept_text(SimpleNamespace(min_ukc_m=None), comfort, ())
    assert text.startswith("kept: land, zones, waves, safety and comfort in waves;")
