"""The year of the European rules: that of the departure, wherever a voyage is asked for."""

from __future__ import annotations

import pytest

from thalweg.planning.request.voyage_surroundings import with_year_of_rules, year_of_rules
from thalweg.service.jobs.plan_request import RequestedCharges
from thalweg.studies import row_runner


@pytest.mark.parametrize(
    ("voyage", "year"),
    [
        ({"depart": "2024-12-31T23:59Z"}, 2024),
        ({"depart_window": ["2025-06-01", "2027-06-01"]}, 2025),
        ({"arrive": "2031-01-01T00:00Z"}, 2031),
        ({"depart": "1998-08-31"}, 2026),
        ({"depart": "2099-01-01"}, 2060),
        ({}, 2026),
    ],
)
def test_the_first_time_of_a_voyage_counts(voyage, year):
    assert year_of_rules(voyage) == year


def test_a_year_that_is_given_comes_first():
    given = {"ets_price": 80.0, "year": 2030}
    assert with_year_of_rules(given, {"depart": "2024-01-01"}) == given


def test_requests_of_the_service_have_no_year_of_their_own():
    charges = RequestedCharges(ets_price=80.0).model_dump()
    assert with_year_of_rules(charges, {"depart": "2024-01-01"})["year"] == 2024


def test_rows_of_studies_follow_their_departures():
    """All rows had the rules of 2026: in 2024 only 40 % of the allowances were due."""
    rows = [
        {
            "ship": "handysize-bulker",
            "charges": {"ets_price": 80.0, "share_percent": 100},
            "voyage": {"start": "Rotterdam", "goal": "Lisbon", "depart": f"{year}-03-01"},
        }
        for year in (2024, 2025, 2026)
    ]
    found = [row_runner.ship_of_request(row, ".").fuel_terms.charges.year for row in rows]
    assert found == [2024, 2025, 2026]
