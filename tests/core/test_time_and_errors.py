"""Time at the boundary, and errors that say what to do."""

from datetime import UTC, datetime, timedelta, timezone

import numpy as np
import pytest

from thalweg.core.errors import InputError, NoRouteError, near_matches, unknown_name
from thalweg.core.time import format_time, parse_time, to_datetime64


@pytest.mark.parametrize(
    "value",
    [
        "2026-01-01T06:00Z",
        "2026-01-01T06:00:00",
        "2026-01-01T07:00+01:00",
        datetime(2026, 1, 1, 6),
        datetime(2026, 1, 1, 6, tzinfo=UTC),
        datetime(2026, 1, 1, 8, tzinfo=timezone(timedelta(hours=2))),
        np.datetime64("2026-01-01T06:00"),
        1767247200,
    ],
)
def test_one_moment_many_spellings(value):
    assert parse_time(value) == 1767247200.0


@pytest.mark.parametrize("value", ["tomorrow", "2026-13-01", float("nan"), np.datetime64("NaT")])
def test_what_is_not_a_time(value):
    with pytest.raises(InputError):
        parse_time(value)


def test_times_go_out_as_they_came_in():
    assert format_time(parse_time("2026-02-28T23:59:59Z")) == "2026-02-28T23:59:59Z"
    assert to_datetime64(parse_time("2026-01-01T00:00Z")) == np.datetime64("2026-01-01T00:00")


def test_near_matches_ignore_case():
    assert near_matches("roterdam", ["Rotterdam", "Antwerpen"]) == ["Rotterdam"]
    assert "Did you mean 'Rotterdam'" in str(unknown_name("port", "roterdam", ["Rotterdam"]))


def test_an_error_keeps_its_three_parts_and_details():
    error = NoRouteError("No way.", "Nothing.", "Wait.", reasons={"land": 3}, nearest=(1.0, 2.0))
    assert str(error) == "No way. Nothing. Wait."
    assert error.as_dict()["details"] == {"reasons": {"land": 3}, "nearest": [1.0, 2.0]}
