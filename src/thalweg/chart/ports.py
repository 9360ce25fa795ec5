"""Ports by name or UN/LOCODE: the World Port Index (NGA Pub. 150), and ports missing from it.

The others (Sydney, Oslo, Singapore and some 290 more) come from searoute 1.6.0 (Apache-2.0). Only
those with water nearby are used, and entries with wrong positions were removed. Their positions
are accurate to a few miles.
"""

from __future__ import annotations

import csv
import gzip
import io
import unicodedata
from dataclasses import dataclass
from functools import cached_property
from importlib import resources
from typing import Final

from thalweg.core.errors import InputError, close_matches

# Common English names of ports that the index lists under another name.
ENGLISH_NAMES: Final = {
    "alexandria egypt": "EGALY",
    "antwerp": "BEANR",
    "flushing": "NLVLI",
    "genoa": "ITGOA",
    "ghent": "BEGNE",
    "goteborg": "SEGOT",
    "hull": "GBHUL",
    "leghorn": "ITLIV",
    "lisbon": "PTLIS",
    "naples": "ITNAP",
    "piraeus": "GRPIR",
    "suez": "EGSUZ",
    "venice": "ITVCE",
}


@dataclass(frozen=True)
class Port:
    """A port: name, ISO country code, UN/LOCODE ('' if it has none) and position [deg]."""

    name: str
    country_code: str
    locode: str
    lat: float
    lon: float

    def __str__(self) -> str:
        return f"{self.name}, {self.country_code}" + (f" ({self.locode})" if self.locode else "")


@dataclass(frozen=True)
class Ports:
    """All ports, read on first use."""

    @cached_property
    def all(self) -> tuple[Port, ...]:
        """Every port of the index, in the order of the file."""
        packed = resources.files("thalweg.chart").joinpath("data/world_port_index.csv.gz")
        text = gzip.decompress(packed.read_bytes()).decode("utf-8")
        return tuple(_port_from_row(row) for row in csv.DictReader(io.StringIO(text)))

    @cached_property
    def others(self) -> tuple[Port, ...]:
        """Ports that are missing from the index."""
        table = resources.files("thalweg.chart").joinpath("data/more_ports.csv")
        text = table.read_text(encoding="utf-8")
        return tuple(_port_from_row(row) for row in csv.DictReader(io.StringIO(text)))

    def lookup(self, text: str) -> Port:
        """Return the port of a name ('Rotterdam', 'Rotterdam, NL') or UN/LOCODE ('NLRTM').

        Case and accents do not matter.

        Raises
        ------
        InputError
            If the port is unknown (the message lists similar names), or several ports have the
            name (the message lists their LOCODEs).
        """
        wanted = normalised_port_name(text)
        known = (*self.all, *self.others)
        found = [
            port for port in known if port.locode and normalised_port_name(port.locode) == wanted
        ]
        found = found[:1] or self._named(text)
        if len(found) == 1:
            return found[0]
        if not found:
            raise self._unknown(text)
        raise InputError(
            f"There are {len(found)} ports named {text!r}.",
            "They are " + "; ".join(str(port) for port in found[:10]) + ".",
            "Give the UN/LOCODE, or add the country: " + _with_country(found[0]) + ".",
            value=text,
            near=[port.locode or _with_country(port) for port in found],
        )

    def _named(self, text: str) -> list[Port]:
        """Return the ports of a name: exactly, by English name, or as words of a longer name."""
        name, _, country = text.rpartition(",") if "," in text else (text, "", "")
        code = country.strip().upper()
        wanted = normalised_port_name(name)
        pool, others = (
            [port for port in ports if not code or port.country_code == code]
            for ports in (self.all, self.others)
        )
        found = [port for port in pool if normalised_port_name(port.name) == wanted]
        if not found and wanted in ENGLISH_NAMES:
            found = [port for port in (*pool, *others) if port.locode == ENGLISH_NAMES[wanted]][:1]
        if not found:
            found = [port for port in others if normalised_port_name(port.name) == wanted]
        if not found and len(wanted) >= 4:
            found = [
                port for port in pool if f" {wanted} " in f" {normalised_port_name(port.name)} "
            ]
        return found

    def _unknown(self, text: str) -> InputError:
        wanted = normalised_port_name(text.split(",")[0])
        by_name = {normalised_port_name(port.name): port for port in (*self.others, *self.all)}
        within = [n for n in by_name if len(wanted) >= 3 and wanted in n.split()]
        near = list(dict.fromkeys([*close_matches(wanted, by_name, 4), *within]))[:5]
        listed = "; ".join(str(by_name[name]) for name in near)
        return InputError(
            f"There is no port named {text!r} in the index of ports.",
            f"Nearest in spelling: {listed}." if near else "No port has a similar name.",
            "Give one of these, its UN/LOCODE, or a position such as 52.0N 4.1E.",
            value=text,
            near=[by_name[name].name for name in near],
        )


#: Letters that are not a base letter with an accent.
_LETTER_SUBSTITUTES: Final = str.maketrans(
    {"ø": "o", "æ": "ae", "œ": "oe", "ł": "l", "đ": "d", "ð": "d"}
)


def normalised_port_name(text: str) -> str:
    """Return text without case, accents, punctuation and double spaces, for comparing."""
    plain = unicodedata.normalize("NFKD", text.casefold().translate(_LETTER_SUBSTITUTES))
    characters = (c if c.isalnum() else " " for c in plain if not unicodedata.combining(c))
    return " ".join("".join(characters).split())


def _port_from_row(row: dict[str, str]) -> Port:
    locode = row["unlocode"].replace(" ", "").upper()
    country = row.get("country_code") or locode[:2]
    return Port(row["name"], country, locode, float(row["lat"]), float(row["lon"]))


def _with_country(port: Port) -> str:
    return f"'{port.name}, {port.country_code}'"


PORTS = Ports()
