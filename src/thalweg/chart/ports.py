"""Ports by name or UN/LOCODE, from one table of four sources.

The table holds the World Port Index (NGA Pub. 150), ports of searoute 1.6.0 that the index lacks,
the other names that searoute uses, and a few more ports, names and corrections with their sources
(``data/port_aliases.csv``, ``port_sizes.csv``, ``port_positions.csv``), good to a few miles.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, cached_property, partial
from typing import Final

from thalweg.chart.port_names import (
    decimal_commas_error,
    is_in_state,
    loose_port_names,
    names_spelt_alike,
    normalised_port_name,
    place_name,
    written_names,
)
from thalweg.core.errors import InputError
from thalweg.core.file_reading import table_rows
from thalweg.core.geodesy import Position, distance, format_position, parse_position
from thalweg.core.units import NAUTICAL_MILE

#: Points for the harbour size of the World Port Index ("" is unknown). Each linked country adds
#: one point.
SIZE_POINTS: Final = {"large": 40, "medium": 12, "small": 4, "very small": 1, "": 1}
#: A port is clearly larger than another if it has this many times its points,
CLEARLY_LARGER: Final = 4.0
#: or this many times those of a port without liner connections (medium against small).
CLEARLY_LARGER_HARBOUR: Final = 3.0
#: Ports of one name and country within this distance [m] are parts of one port.
SAME_PORT: Final = 15.0 * NAUTICAL_MILE
#: Most ports that a message lists.
_MOST_LISTED: Final = 10


@dataclass(frozen=True)
class Port:
    """A port.

    Attributes
    ----------
    name : Name in the index.
    country_code : ISO 3166 code of the country.
    locode : UN/LOCODE, empty if the port has none.
    lat, lon : Position [deg].
    size : Harbour size of the World Port Index: large, medium, small, very small, or empty.
    region : Coast or region of the World Port Index, or empty.
    country_links : Countries to which searoute lists a liner connection.
    """

    name: str
    country_code: str
    locode: str
    lat: float
    lon: float
    size: str = ""
    region: str = ""
    country_links: int = 0

    def __str__(self) -> str:
        return self.label + (f" ({self.locode})" if self.locode else "")

    @property
    def display_name(self) -> str:
        """The name that people write, such as Bilbao for 'Puerto De Bilbao'."""
        return _corrected("name", "port_display_names.csv").get(self.locode, self.name)

    @property
    def label(self) -> str:
        """Display name and country: 'Sydney, AU'."""
        return f"{self.display_name}, {self.country_code}"

    @property
    def importance(self) -> int:
        """Points for harbour size and liner connections."""
        return SIZE_POINTS[self.size] + self.country_links

    def is_part_of(self, other: Port) -> bool:
        """Return whether both are in one country and within `SAME_PORT` of each other."""
        return self.country_code == other.country_code and (
            float(distance(self.lat, self.lon, other.lat, other.lon)) <= SAME_PORT
        )

    def is_in(self, place: str) -> bool:
        """Return whether the port is in a country (code or name) or region ('Nova Scotia')."""
        code = country_code_of(place)
        if code:
            return self.country_code == code
        words = normalised_port_name(place).split()
        return bool(words) and set(words) <= set(normalised_port_name(self.region).split())


@dataclass(frozen=True)
class Ports:
    """All ports, read on first use."""

    @cached_property
    def all(self) -> tuple[Port, ...]:
        """Every port of the table."""
        return tuple(port for port, _ in self._rows)

    @cached_property
    def _rows(self) -> list[tuple[Port, str]]:
        """Every port with its other names, separated by semicolons."""
        tables = (_table("world_port_index.csv.gz"), _table("more_ports.csv"))
        return [(_port_from_row(r), r.get("alternate_names", "")) for t in tables for r in t]

    @cached_property
    def _not_reached(self) -> frozenset[Port]:
        """The ports that cannot be reached from the sea: they have no approach in the table."""
        rows = _table("port_approaches.csv.gz")
        keys = {(r["unlocode"], r["name"], r["country_code"]) for r in rows if not r["line"]}
        return frozenset(p for p in self.all if (p.locode, p.name, p.country_code) in keys)

    @cached_property
    def _by_locode(self) -> dict[str, Port]:
        return {port.locode: port for port in self.all if port.locode}

    @cached_property
    def _by_name(self) -> dict[str, dict[Port, bool]]:
        """Ports by normalised name, and whether it is their own name or a former or local one.

        Names are entered with and without the word for "port".
        """
        by_name: dict[str, dict[Port, bool]] = defaultdict(dict)
        for name, port, own in self.names():
            normalised = normalised_port_name(name)
            by_name[normalised][port] = own or by_name[normalised].get(port, False)
            place = place_name(normalised)
            if place != normalised and not country_code_of(place):
                by_name[place][port] = own or by_name[place].get(port, False)
        by_name.pop("", None)
        return dict(by_name)

    def names(self) -> Iterator[tuple[str, Port, bool]]:
        """Return every name, its port and whether it is its own; one in brackets is another."""
        for port, others in self._rows:
            for i, name in enumerate(written_names(port.name)):
                yield name, port, i < 2
            for field in others.split(";"):
                for name in written_names(field):
                    yield name, port, False
        keyed = {f"{port.name}, {port.country_code}": port for port in self.all}
        keyed |= self._by_locode
        for row in _table("port_aliases.csv"):
            yield row["name"], keyed[row["port"]], True

    def lookup(self, text: str) -> Port:
        """Return the port of a name or UN/LOCODE.

        Names are "Rotterdam", "Rotterdam, NL", "Rotterdam, Netherlands", "Portland, ME" or, with a
        region of the World Port Index, "Sydney, Cape Breton Island". Case and accents do not
        matter, but a UN/LOCODE in small letters that is also a name is taken as a name. Of several
        ports of one name the answer is the one that is clearly larger than all others (by
        `CLEARLY_LARGER`); without a country or region, ports that can be reached from the sea come
        before all others. A former or local name of the World Port Index counts only where no port
        has it as its own name; if it belongs to a clearly larger port, the name is ambiguous. A
        name that no port has is compared by its loose form (`loose_port_names`) where that is one
        port's alone.

        Raises
        ------
        InputError : If the port is unknown (the message lists similar names), or ports of
            comparable size have the name (the message lists them and how to write each).
        """
        named = self._named(text)
        code = "".join(text.split())
        port = self._by_locode.get(code.upper())
        if port is not None and (code.isupper() or not named):
            return port
        if not named:
            raise self._unknown(text)
        return _clearly_largest(named, text)

    def find(self, text: str) -> Port | None:
        """Return the port of a name or UN/LOCODE as `lookup` does; None where that raises."""
        try:
            known = self._named(text) or "".join(text.split()).upper() in self._by_locode
            return self.lookup(text) if known else None
        except InputError:
            return None

    def is_unlike(self, text: str, port: Port) -> bool:
        """Return whether a text is only a former or local name of a port, unlike its own."""
        if self._named(text).get(port, True):
            return False
        own = normalised_port_name(port.display_name)
        return not names_spelt_alike(normalised_port_name(text.partition(",")[0]), [own])

    def _named(self, text: str) -> dict[Port, bool]:
        """Return the ports of a name, with or without its country or region."""
        found = self._with_name(text)
        if len(found) > 1:
            found = {p: own for p, own in found.items() if p not in self._not_reached} or found
        if not found and "," in text:
            name, _, place = text.rpartition(",")
            named = self._with_name(name)
            found = {port: own for port, own in named.items() if port.is_in(place)}
            found = found or {p: own for p, own in named.items() if is_in_state(place, p)}
        return found

    def _with_name(self, name: str) -> dict[Port, bool]:
        normalised = normalised_port_name(name)
        return (
            self._by_name.get(normalised)
            or self._by_name.get(place_name(normalised))
            or self._spelt_otherwise(normalised)
        )

    def _spelt_otherwise(self, normalised: str) -> dict[Port, bool]:
        """Return the one port of which a name is another spelling; empty for none or several."""
        if country_code_of(normalised):
            return {}
        for form in loose_port_names(normalised):
            found = self._by_loose_name.get(form, {})
            if len(_separate_ports(found)) == 1:
                return found
        return {}

    @cached_property
    def _by_loose_name(self) -> dict[str, dict[Port, bool]]:
        """Ports by the loose form of their whole names (`loose_port_names`)."""
        loose: dict[str, dict[Port, bool]] = defaultdict(dict)
        for name, ports in self._by_name.items():
            for form in loose_port_names(name)[:1]:
                loose[form].update(ports)
        return dict(loose)

    def _unknown(self, text: str) -> InputError:
        """Return the error of a name that no port has: a wrong country, a country, or a typo."""
        if commas := decimal_commas_error(text):
            return commas
        name, comma, place = text.rpartition(",") if "," in text else (text, "", "")
        elsewhere = _separate_ports(self._with_name(name)) if comma else []
        code = "" if comma else country_code_of(text)
        if elsewhere:
            problem = f"There is no port named {name.strip()!r} in {place.strip()!r}."
            return _listing_error(problem, "Ports of this name: ", elsewhere, text, name)
        if code:
            inside = _by_importance(port for port in self.all if port.country_code == code)
            problem = f"There is no port named {text!r}: it is a country or territory."
            return _listing_error(problem, "Its largest ports: ", inside[:5], text)
        return self._misspelt(text, normalised_port_name(name))

    def _misspelt(self, text: str, wanted: str) -> InputError:
        words = f" {wanted} " if len(wanted) >= 3 else "\n"
        within = [name for name in self._by_name if words in f" {name} ".replace("-", " ")]
        names = within[:4] or names_spelt_alike(wanted, self._by_name)
        near = list(dict.fromkeys(_by_importance(self._by_name[name])[0] for name in names))[:5]
        return InputError(
            f"There is no port named {text!r} in the table of ports.",
            f"Nearest in spelling: {'; '.join(map(str, near))}." if near else "",
            ("Give one of these" if near else "Check the spelling")
            + ", or give a UN/LOCODE or a position such as 52.0N 4.1E.",
            value=text,
            near=[port.locode or port.label for port in near],
        )


def _by_importance(ports: Iterable[Port]) -> list[Port]:
    return sorted(ports, key=lambda port: -port.importance)


def _separate_ports(ports: Iterable[Port]) -> list[Port]:
    """Return the ports, the most important first, without other parts of the same port."""
    separate: list[Port] = []
    for port in _by_importance(ports):
        if not any(port.is_part_of(other) for other in separate):
            separate.append(port)
    return separate


def _clearly_largest(named: Mapping[Port, bool], text: str) -> Port:
    """Return the port that a text means, of the ports with that name as own or former name."""
    own = _separate_ports(port for port, is_own in named.items() if is_own)
    former = [
        port
        for port in _separate_ports(port for port, is_own in named.items() if not is_own)
        if not any(port.is_part_of(other) for other in own)
    ]
    leader = (own or former)[0]
    points = leader.importance
    rivals = [port for port in own or former if _lead_needed(port) > points]
    if own:
        rivals += [port for port in former if port.importance > CLEARLY_LARGER * points]
    if rivals != [leader]:
        raise _ambiguous(text, _by_importance([*own, *former]))
    return leader


def _lead_needed(port: Port) -> float:
    """Return the points from which on another port is clearly larger."""
    times = CLEARLY_LARGER if port.country_links else CLEARLY_LARGER_HARBOUR
    return port.importance * times


def _ambiguous(text: str, found: Sequence[Port]) -> InputError:
    name = text.rpartition(",")[0] if "," in text else text
    problem = f"{len(found)} ports of comparable size can be meant by {text!r}."
    return _listing_error(problem, "They are ", found, text, name)


def _listing_error(
    problem: str, before: str, found: Sequence[Port], text: str, name: str = ""
) -> InputError:
    """Return an error that lists ports and how to write each."""
    listed = list(found[:_MOST_LISTED])
    spellings = [_unambiguous_name(port, found, name.strip()) for port in listed]
    return InputError(
        problem,
        before + "; ".join(map(_described, listed)) + ".",
        f"Write {' or '.join(map(repr, spellings))}.",
        value=text,
        near=[port.locode or port.label for port in listed],
    )


def _described(port: Port) -> str:
    facts = (port.locode or "no LOCODE", port.size and f"{port.size} harbour", port.region)
    return f"{port.label} ({', '.join(fact for fact in facts if fact)})"


def _unambiguous_name(port: Port, found: Sequence[Port], name: str) -> str:
    """Return a text that names one of the ports found: with country, LOCODE, region or position."""
    name = name or port.name
    compatriots = [p for p in found if p.country_code == port.country_code and p is not port]
    if not compatriots:
        return f"{name}, {port.country_code}"
    if port.locode:
        return port.locode
    if port.region and not any(p.is_in(port.region) for p in compatriots):
        return f"{name}, {port.region}"
    return format_position(port.lat, port.lon)


_table = partial(table_rows, "thalweg.chart")


@cache
def _corrected(column: str, name: str) -> dict[str, str]:
    """Return a column of a table of corrections by the first, UN/LOCODE or name and country."""
    return {next(iter(row.values())): row[column] for row in _table(name)}


def _port_from_row(row: dict[str, str]) -> Port:
    country = row.get("country_code") or row["unlocode"][:2]
    key, moved = row["unlocode"] or f"{row['name']}, {country}", "port_positions.csv"
    lat, lon = (float(_corrected(axis, moved).get(key, row[axis])) for axis in ("lat", "lon"))
    size = _corrected("size", "port_sizes.csv").get(row["unlocode"], row["size"])
    region, links = row.get("region", ""), int(row["country_links"])
    return Port(row["name"], country, row["unlocode"], lat, lon, size, region, links)


PORTS = Ports()


def place_positions(texts: Iterable[str]) -> list[Position]:
    """Return the positions (lat, lon) [deg] of places given as text; of ports that of the berth.

    Raises
    ------
    InputError
        For names that are no ports, and positions that cannot exist.
    """
    found = []
    for text in texts:
        position = parse_position(text)
        if position is None:
            port = PORTS.lookup(text)
            position = (port.lat, port.lon)
        found.append(position)
    return found


def country_code_of(text: str) -> str:
    """Return the ISO code of a country given by code or name ('NL', 'Netherlands'), '' if unknown.

    Case and accents do not matter.
    """
    return _codes_by_name().get(normalised_port_name(text), "")


@cache
def _codes_by_name() -> dict[str, str]:
    codes: dict[str, str] = {}
    for row in _table("countries.csv"):
        names = (row["country_code"], row["name"], *row["other_names"].split(";"))
        codes.update({normalised_port_name(name): row["country_code"] for name in names})
    codes.pop("", None)
    return codes
