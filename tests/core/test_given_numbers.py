"""Impossible numbers, times, texts and types are errors with a message, never other exceptions."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest

from thalweg.chart import Chart
from thalweg.chart.geojson_polygons import parse_polygons, read_features
from thalweg.core.errors import InputError, ThalwegError
from thalweg.core.given_numbers import (
    float_array,
    is_number,
    rounded_or_none,
    shortened_repr,
    to_number,
)
from thalweg.core.strict_yaml import MAX_DEPTH, parse_yaml
from thalweg.core.time import format_time, parse_time
from thalweg.operations.dredging.project import Project
from thalweg.planning import Voyage
from thalweg.route import Track, evaluate
from thalweg.route.formats import read_track
from thalweg.sea import Sea
from thalweg.ship import Ship

HUGE = 10**400  # beyond the range of floats
LONG = 10**5000  # beyond the digits that Python writes
BY_TYPE = {"ids": lambda value: type(value).__name__}  # pytest cannot write LONG
DAY = "2026-01-01T00:00Z"
START = {"start": (50.0, 1.0), "goal": (51.0, 2.0), "depart": DAY}
SHIP = Ship.simple(10.0)


@pytest.mark.parametrize(
    "value", [True, np.True_, HUGE, LONG, -HUGE, None, [1], "x", {}], **BY_TYPE
)
def test_what_is_not_a_number(value):
    assert math.isnan(to_number(value)) and not is_number(value)
    assert len(shortened_repr(value)) <= 60


@pytest.mark.parametrize("values", [True, [True, False], [HUGE], ["x"], {}, [[1], [1, 2]]])
def test_what_is_not_an_array_of_numbers(values):
    with pytest.raises(InputError, match="not numbers"):
        float_array(values, "values")


def test_numbers_are_numbers():
    assert to_number("5.5") == 5.5 and to_number(np.float32(2.0)) == 2.0
    assert is_number(3) and is_number(np.int64(3)) and not is_number("3")
    assert not is_number(math.inf)
    assert float_array([1, 2.5], "values").tolist() == [1.0, 2.5]


@pytest.mark.parametrize(
    ("value", "date"),
    [
        (np.datetime64("2300-01-01"), "2300-01-01T00:00:00Z"),
        (np.datetime64("1600-05-01T12", "h"), "1600-05-01T12:00:00Z"),
        (np.datetime64("0001-01-01"), "0001-01-01T00:00:00Z"),
        (np.datetime64("2026-01-01T00:00:00", "ns"), "2026-01-01T00:00:00Z"),
    ],
)
def test_times_of_numpy_in_any_unit_are_read_right(value, date):
    assert format_time(parse_time(value)) == date


@pytest.mark.parametrize(
    "value",
    [
        HUGE,
        LONG,
        -HUGE,
        "9" * 5000,
        "9999-12-31T23:59:59-12:00",
        "0001-01-01T00:00:00+12:00",
        np.datetime64("10000-01-01"),
        np.datetime64(2**62, "s"),
        np.datetime64("-0001-01-01"),
    ],
    **BY_TYPE,
)
def test_times_outside_the_calendar_are_refused(value):
    with pytest.raises(InputError):
        parse_time(value)


def test_an_arrival_after_the_last_year_is_unknown():
    track = Track([1, 2], [1, 2], parse_time("9999-12-31T23:59:59Z"))
    assert evaluate(track, ship=SHIP, sea=Sea.calm()).as_dict()["arrive"] == "unknown"


def _line(*places):
    return json.dumps({"type": "LineString", "coordinates": places})


@pytest.mark.parametrize(
    "text",
    [
        _line([HUGE, 1], [2, 2]),
        _line([True, 1], [2, 2]),
        '{"type":"LineString","coordinates":[[' + "1" * 5000 + ",1],[2,2]]}",
        "[" * 100_000 + "]" * 100_000,
        '{"type":"GeometryCollection","geometries":[' * 900 + "]}" * 900,
    ],
)
def test_route_files_with_impossible_values_are_refused(tmp_path, text):
    path = tmp_path / "route.geojson"
    path.write_text(text)
    with pytest.raises(InputError):
        read_track(path, depart=DAY)
    with pytest.raises(InputError):
        Chart.open_water().with_zones(path)


def _ring(first):
    return {"type": "Polygon", "coordinates": [[[first, 0], [1, 0], [1, 1], [0, 0]]]}


@pytest.mark.parametrize("value", [HUGE, LONG, True, None], **BY_TYPE)
def test_polygons_with_impossible_values_are_refused(value):
    with pytest.raises(InputError):
        parse_polygons(_ring(value), "zones")
    zone = {"type": "Feature", "geometry": _ring(0), "properties": {"kind": "penalty"}}
    zone["properties"]["factor"] = value
    with pytest.raises(InputError, match="factor"):
        Chart.open_water().with_zones(zone)


def test_plain_data_may_not_be_nested_without_end():
    data = []
    for _ in range(100_000):
        data = [data]
    with pytest.raises(InputError, match="nested too deeply"):
        read_features(data, "zones")


@pytest.mark.parametrize(
    "change",
    [
        {"start": (HUGE, 1)},
        {"start": (True, 1)},
        {"goal": (LONG, 1)},
        {"depart": HUGE},
        {"speed_kn": HUGE},
        {"min_ukc_m": LONG},
        {"fuel_price_usd": HUGE},
        {"via": [(HUGE, 1)]},
    ],
    **BY_TYPE,
)
def test_voyages_with_impossible_values_are_refused(change):
    with pytest.raises(InputError):
        Voyage(**{**START, **change})


@pytest.mark.parametrize("name", [None, 5, "x" * 400, "nul\0", "."])
def test_names_that_no_file_has_are_refused(name):
    for load in (Voyage.load, Project.load):
        with pytest.raises(InputError):
            load(name)
    with pytest.raises(ThalwegError):
        Sea.open(name)
    with pytest.raises(InputError):
        Ship.load(name)


@pytest.mark.parametrize(
    ("value", "why"),
    [
        ("2026-99-99", "month must be in"),
        ("9" * 5000, "limit"),
        ("9" * 400, "too many digits"),
        ("0x" + "f" * 9000, "too many digits"),
        ("[" * 3000 + "]" * 3000, f"more than {MAX_DEPTH} levels"),
        ("{a: " * 3000 + "}" * 3000, f"more than {MAX_DEPTH} levels"),
        ("&a [x]\nb: *a", "references"),
    ],
)
def test_impossible_values_of_yaml_are_named_with_their_line(value, why):
    with pytest.raises(InputError, match=rf"line [12]\).*{why}") as caught:
        parse_yaml(f"a: {value}\n", "voyage", "v.yaml")
    assert len(caught.value.asked) < 250


@pytest.mark.parametrize("value", ["x", HUGE, None, [1]])
def test_types_of_arguments_are_checked(value):
    with pytest.raises(InputError):
        Chart.open_water(south=value)
    for name in ("ship", "sea"):
        with pytest.raises(InputError, match=f"The {name} is"):
            evaluate([(1, 1), (2, 2)], **{"ship": SHIP, "sea": Sea.calm(), name: value}, depart=DAY)
    with pytest.raises(InputError, match="not a mapping"):
        Sea.from_functions(value)
    with pytest.raises(InputError, match=r"not numbers|speed"):
        SHIP.with_speeds([[1.0], [value, value]])


@pytest.mark.parametrize("value", ["x", HUGE, [1], {}])
@pytest.mark.parametrize("name", ["chart", "min_ukc", "step", "load_factor", "speed_kn"])
def test_options_of_an_evaluation_are_checked(name, value):
    with pytest.raises(InputError):
        evaluate([(1, 1), (2, 2)], ship=SHIP, sea=Sea.calm(), depart=DAY, **{name: value})


@pytest.mark.parametrize("value", ["x", HUGE, [1], {}, 5.0])
def test_options_of_formulas_are_checked(value):
    functions = {"air_temperature": lambda time, lat, lon: 5.0}
    with pytest.raises(InputError):
        Sea.from_functions(functions, period=value)
    if value != 5.0:
        with pytest.raises(InputError):
            Sea.from_functions(functions, time_step=value)


@pytest.mark.parametrize("route", [5, [1, 2], [None, None], [(1,), (2,)], [(1, True), (2, 2)]])
def test_routes_of_other_types_are_refused(route):
    with pytest.raises(InputError):
        evaluate(route, ship=SHIP, sea=Sea.calm(), depart=DAY)


def test_rounded_or_none():
    assert rounded_or_none(1.23456, 2) == 1.23
    assert [rounded_or_none(x, 2) for x in (None, math.nan, math.inf)] == [None] * 3
