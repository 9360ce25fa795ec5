"""Alternatives that avoid the canals of the fastest route, their names, and why one is missing."""

from types import SimpleNamespace

import numpy as np
import pytest
from rich.console import Console

from thalweg import Chart, Sea, Ship, Voyage
from thalweg.chart.canals import KIEL, SUEZ
from thalweg.cli.indicators.alternatives_command import _print_alternatives
from thalweg.cli.tables import print_passage_alternatives
from thalweg.core.time import parse_time
from thalweg.planning import alternative_plans
from thalweg.planning.indicators import alternative_plans as module_of_plans
from thalweg.planning.indicators import ways_not_offered
from thalweg.planning.indicators.route_choices import _label, ways_apart
from thalweg.planning.indicators.route_figures import COMPARED_FIGURES, difference_in_words
from thalweg.planning.indicators.ways_not_offered import (
    canal_notes,
    fastest_without_canals,
    unchosen_notes,
)

DEPART = parse_time("2026-01-01T00:00Z")


@pytest.fixture(scope="module")
def by_kiel():
    """From the German Bight to the Baltic: round the Skaw it is nearly three times as long."""
    voyage = Voyage(start=(54.0, 8.0), goal=(54.8, 13.6), depart=DEPART)
    return alternative_plans(
        voyage, ship=Ship.load("handysize-bulker"), sea=Sea.calm(), chart=Chart.gshhg("l"),
        resolution=30_000.0,
    )  # fmt: skip


@pytest.mark.slow
def test_the_way_round_a_canal_is_offered_however_long(by_kiel):
    first = by_kiel.choices[0]
    assert first.canals == ("Kiel Canal",) and first.name.startswith("by the Kiel Canal")
    assert first.canal_dues_usd == pytest.approx(8_127.0, abs=1.0)
    (round_it,) = [one for one in by_kiel.choices if not one.canals]
    assert "Skaw" in round_it.name and "Kiel" not in round_it.name
    assert round_it.canal_dues_usd == 0.0
    assert round_it.route.time_h > 1.5 * first.route.time_h
    rows = by_kiel.rows()
    assert [row["canals"] for row in rows] == [", ".join(one.canals) for one in by_kiel.choices]
    assert by_kiel.to_dict()["alternatives"][0]["canal_dues_usd"] == first.canal_dues_usd
    assert "passes Kiel Canal" in str(by_kiel)


def test_ways_are_named_by_the_canals_and_passages_that_set_them_apart():
    suez, cape = ("Dover", "Gibraltar", "Malacca"), ("Dover", "Cape of Good Hope", "Malacca")
    assert ways_apart([("Suez Canal",), ()], [suez, cape]) == [
        ("Suez Canal",),
        ("Cape of Good Hope",),
    ]
    mona, windward = ("Mona",), ("Windward",)
    assert ways_apart([("Panama Canal",)] * 2, [mona, windward]) == [
        ("Panama Canal", "Mona"),
        ("Panama Canal", "Windward"),
    ]
    assert ways_apart([(), ()], [("Dover", "Solent"), ("Dover",)]) == [("Solent",), ()]


def _route(days, canals=(), passes=(), violations=(), lat=0.0):
    distance = np.array([0.0, 3e6])
    samples = {
        "distance": distance,
        "lat": np.array([0.0, lat]),
        "lon": np.array([0.0, 27.0]),
    }
    return SimpleNamespace(
        depart=DEPART, arrive=DEPART + days * 86400.0, canals=list(canals), passes=passes,
        violations=violations, samples=samples, time_h=24.0 * days,
    )  # fmt: skip


@pytest.fixture
def made(monkeypatch):
    """Routes that state their canals and passages themselves."""
    monkeypatch.setattr(ways_not_offered, "canals_passed", lambda route, chart: route.canals)
    monkeypatch.setattr(ways_not_offered, "passages_of", lambda route, chart: route.passes)


@pytest.mark.usefixtures("made")
def test_the_fastest_without_each_canal_is_always_chosen(monkeypatch):
    monkeypatch.setattr(
        module_of_plans, "compared_values",
        lambda route: dict.fromkeys(COMPARED_FIGURES, 1.0) | {"time": route.time_h},
    )  # fmt: skip
    suez, slow_cape = _route(20.0, [SUEZ]), _route(40.0, lat=-20.0)
    cape = _route(30.0, lat=-20.0)
    routes = [suez, slow_cape, cape]
    assert fastest_without_canals(routes, None) == [(SUEZ, cape)]
    assert module_of_plans._chosen(routes, 2, None) == [suez, cape]


def test_names_of_ways_have_the_article_where_one_speaks_so():
    """Routes were called "by the Dover"."""
    route = SimpleNamespace(legs={})  # how near to land it runs is not known
    assert _label(route, ["Dover", "North Minch"], True) == "by Dover and the North Minch"
    assert _label(route, ["Cape of Good Hope"], True) == "by the Cape of Good Hope"


@pytest.mark.usefixtures("made")
def test_notes_say_why_a_canal_is_not_avoided():
    suez, cape = _route(20.0, [SUEZ]), _route(30.0)
    latest = DEPART + 25.0 * 86400.0
    assert canal_notes(None, [suez, cape], [suez, cape], np.inf, []) == []
    (late,) = canal_notes(None, [suez, cape], [suez], latest, [])
    assert late == (
        "Not offered: a way without the Suez Canal: it arrives at 2026-01-31 00:00 UTC, "
        "after the latest arrival."
    )
    broken = _route(30.0, violations=["waves of 9 m"])
    (limit,) = canal_notes(None, [suez, broken], [suez], latest, [])
    assert limit.endswith("it breaks a limit: waves of 9 m.")
    (unsailed,) = canal_notes(None, [suez], [suez], latest, [({"kiel"}, "the data end.")])
    assert unsailed.endswith("without the Suez Canal: the data end.")
    (none,) = canal_notes(None, [_route(1.0, [KIEL])], [_route(1.0, [KIEL])], latest, [])
    assert "the ends are not joined by sea without it" in none


@pytest.mark.usefixtures("made")
def test_notes_say_why_a_way_that_was_found_is_not_offered():
    suez, cape = _route(20.0, [SUEZ], ("Dover",)), _route(30.0, (), ("Dover",), lat=-20.0)
    north = _route(21.0, [SUEZ], ())

    def notes(routes, chosen, broken=lambda route: ""):
        return unchosen_notes(None, routes, chosen, broken)

    assert notes([suez, cape, north], [suez, cape, north]) == []
    assert "Suez Canal: more routes were found" in notes([suez, cape], [suez])[0]
    limited = notes([suez, cape], [suez], lambda route: "" if route is suez else "cost 9 USD")
    assert limited[0].endswith("a way without the Suez Canal: it breaks cost 9 USD.")
    (known,) = notes([suez, cape, north], [suez, cape])
    assert (
        known == "Not offered: ways without Dover: those found are best in no figure of the table."
    )
    (without,) = notes([suez, cape], [suez, cape])
    assert without.startswith("Not offered: ways without Dover: the network along the fastest")
    alone = _route(1.0)
    assert "none was found" in notes([alone], [alone])[0]
    assert "are best in no figure" in notes([alone, _route(1.1, lat=20.0)], [alone])[0]


def test_tonnes_of_long_voyages_are_in_words_without_powers_of_ten():
    fast, slow = (dict.fromkeys(COMPARED_FIGURES, np.nan) | {"fuel": t} for t in (892.5, 1258.6))
    assert difference_in_words(slow, fast) == "+366.1 t fuel (+41 %)"


@pytest.mark.slow
def test_the_table_of_alternatives_has_the_dues_of_canals(by_kiel, capsys):
    _print_alternatives(by_kiel)
    rows = {
        line.split("  ")[1].strip(): line
        for line in capsys.readouterr().out.splitlines()
        if line.startswith("  ")
    }
    dues = [f"{one.canal_dues_usd:,.0f}" for one in by_kiel.choices]
    assert rows["canal dues USD"].split()[3:] == dues and "0" in dues
    assert "off land at sea nm" in rows and "cost USD" in rows


def test_the_table_of_other_ways_names_canals_in_full(capsys):
    ways = [
        {
            "without": [],
            "passes": ["panama"],
            "distance_nm": 4909.0,
            "time_h": 330.4,
            "canal_dues_usd": 113_765.0,
        },
        {
            "without": ["panama"],
            "passes": ["Magellan"],
            "distance_nm": 12_736.0,
            "time_h": 838.8,
            "canal_dues_usd": 0.0,
        },
    ]
    print_passage_alternatives(Console(width=40), SimpleNamespace(passage_alternatives=ways))
    text = capsys.readouterr().out
    assert text.count("Panama Canal") == 2 and "panama" not in text
    assert "838.8 h, canal dues 0 USD: without Panama Canal, by Magellan." in text
    assert "thalweg alternatives" in text
