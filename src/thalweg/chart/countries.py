"""Countries of ports: ISO 3166 codes and the names in use."""

from __future__ import annotations

import csv
from functools import cache
from importlib import resources

from thalweg.chart.port_names import normalised_port_name


def country_code_of(text: str) -> str:
    """Return the ISO code of a country given by code or name ('NL', 'Netherlands'), '' if unknown.

    Case and accents do not matter.
    """
    return _codes_by_name().get(normalised_port_name(text), "")


@cache
def _codes_by_name() -> dict[str, str]:
    table = resources.files("thalweg.chart").joinpath("data/countries.csv")
    codes: dict[str, str] = {}
    for row in csv.DictReader(table.read_text(encoding="utf-8").splitlines()):
        names = (row["country_code"], row["name"], *row["other_names"].split(";"))
        codes.update({normalised_port_name(name): row["country_code"] for name in names})
    codes.pop("", None)
    return codes
