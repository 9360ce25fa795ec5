"""Distances by sea that are kept on disk."""

from __future__ import annotations

import sqlite3

import pytest

from thalweg.chart import Chart
from thalweg.planning.network_selection import distance_cache, distance_search
from thalweg.planning.network_selection.distance_cache import DistanceQuestion
from thalweg.planning.sea_distance import SeaDistance, sea_distance, small_ship_distance

ANSWER = DistanceQuestion.answer  # the fixture of all tests hides it
WAY = SeaDistance(
    "Vlissingen, NL", "Dover, GB", 1.0 / 3.0 * 1e6, ("Suez Canal",), ("Dover",),
    (("Vlissingen, NL", 0.1),), ((51.4, 3.6), (51.1, 1.0 / 3.0)), ("a note",),
)  # fmt: skip


@pytest.fixture(autouse=True)
def asked(monkeypatch, tmp_path):
    """Return the requests that were searched, in an empty cache."""
    requests = []

    def search(request, ship, chart):
        requests.append(request)
        return WAY

    monkeypatch.setenv("THALWEG_CACHE", str(tmp_path))
    monkeypatch.setattr(DistanceQuestion, "answer", ANSWER)
    monkeypatch.setattr(distance_search, "shortest_distance", search)
    monkeypatch.setattr(
        distance_search, "distance_by_small_passages", lambda way, request, chart: None
    )
    return requests


def test_a_question_is_answered_once_and_then_from_the_disk(asked):
    first = sea_distance("Vlissingen", (51.1, 1.3), via=["Dover"], draught_m=7.5)
    again = sea_distance("Vlissingen", (51.1, 1.3), via=("Dover",), draught_m=7.5)
    assert first == again == WAY
    assert isinstance(again.line[0], tuple)
    assert len(asked) == 1


@pytest.mark.parametrize(
    "other",
    [
        {"draught_m": 7.6}, {"draught_m": None}, {"avoid": ()}, {"open": ("Canso",)},
        {"offing_nm": 1.0}, {"via": ("Calais",)},
    ],
)  # fmt: skip
def test_other_options_are_another_question(asked, other):
    sea_distance("Vlissingen", "Dover", draught_m=7.5)
    sea_distance("Vlissingen", "Dover", **({"draught_m": 7.5} | other))
    assert len(asked) == 2


def test_that_there_is_no_way_for_small_ships_is_kept_too(asked, monkeypatch):
    assert small_ship_distance(WAY, "Vlissingen", "Dover") is None
    monkeypatch.delattr(distance_search, "distance_by_small_passages")
    assert small_ship_distance(WAY, "Vlissingen", "Dover") is None


def test_answers_of_other_files_are_not_used(asked, monkeypatch):
    sea_distance("Vlissingen", "Dover")
    monkeypatch.setattr(distance_cache, "software_and_data", lambda: "another version")
    sea_distance("Vlissingen", "Dover")
    assert len(asked) == 2


def test_a_damaged_file_is_replaced(asked, tmp_path):
    (tmp_path / "distances.sqlite3").write_bytes(b"no database" * 100)
    assert sea_distance("Vlissingen", "Dover") == WAY  # removes the file
    sea_distance("Vlissingen", "Dover")
    sea_distance("Vlissingen", "Dover")
    assert len(asked) == 2


def test_a_damaged_answer_is_found_again(asked, tmp_path):
    sea_distance("Vlissingen", "Dover")
    with sqlite3.connect(tmp_path / "distances.sqlite3") as database:
        database.execute("UPDATE answers SET answer = '{\"start\": 1}'")
    assert sea_distance("Vlissingen", "Dover") == WAY
    assert len(asked) == 2


def test_questions_with_an_own_chart_or_with_values_that_are_no_json_are_not_kept(asked):
    for _ in range(2):
        sea_distance("Vlissingen", "Dover", chart=Chart.open_water(50.0, 53.0, 0.0, 5.0))
        sea_distance("Vlissingen", "Dover", draught_m=float("nan"))
        sea_distance("Vlissingen", {"Dover"})
    assert len(asked) == 6


def test_the_oldest_answers_are_removed(asked, monkeypatch, tmp_path):
    monkeypatch.setattr(distance_cache, "_MOST_KEPT", 3)
    for draught in (1.0, 2.0, 3.0, 4.0, 5.0):
        sea_distance("Vlissingen", "Dover", draught_m=draught)
    sea_distance("Vlissingen", "Dover", draught_m=3.0)
    assert len(asked) == 5
    sea_distance("Vlissingen", "Dover", draught_m=2.0)
    assert len(asked) == 6
