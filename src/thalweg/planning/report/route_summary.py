"""A refereed route in a few lines for the person who sails it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from thalweg.chart.canal_parts import first_legs_of_transits, part_number_of_legs
from thalweg.chart.canals import canals_with_dues
from thalweg.core.geodesy import format_position_minutes
from thalweg.core.time import duration_text, utc_text
from thalweg.core.units import HOUR, KNOT
from thalweg.kernels import codes
from thalweg.planning.report.approach_report import (
    APPROACH_TOO_SMALL,
    LOW_BRIDGE,
    OVER_LAND,
    PORT_TOO_SHALLOW,
)
from thalweg.planning.report.closed_way_report import CLOSED_ON_ROUTE
from thalweg.planning.report.depth_report import CHECK_DEPTH, CROSSES_SHOAL
from thalweg.planning.report.filled_weather import wave_shares
from thalweg.planning.report.lane_report import AGAINST_TRAFFIC
from thalweg.planning.report.squat_report import SQUAT_UNCOUNTED
from thalweg.planning.report.waiting_report import WAITS
from thalweg.route.number_texts import amount_text, miles_text
from thalweg.sea.fill_policies import is_calm_layer
from thalweg.sea.models.cyclone_layer import AmbientSea, StormLayer
from thalweg.ship.comfort.broken_seaway_limits import sickness_limit_text
from thalweg.ship.fuel_prices import FACTOR_OF_REQUEST, FACTOR_OF_SHIP_FILE

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.chart.canals import Canal
    from thalweg.route import Route
    from thalweg.sea import Sea
    from thalweg.ship import Ship

_WAVES = "sea_surface_wave_significant_height"
_WIND = ("eastward_wind", "northward_wind")
_CURRENT = ("eastward_sea_water_velocity", "northward_sea_water_velocity")
_NAMES = (_WAVES, *_WIND, *_CURRENT)
_UNDER_KEEL_CLEARANCE: Final = codes.REASONS[codes.DEPTH]
_SAME_CLEARANCE: Final = 0.005  # [m]
_MOST: Final = 0.99  # of the waits at one place, so that no other is named
_TENTH: Final = 0.1  # by which waves in a wait are higher to be named [m]
_LEAST_PERCENT: Final = 0.5  # smaller shares of the way are not named
_SEE_NOTES: Final = {  # first words of notes on what the referee does not check, and its name
    CROSSES_SHOAL: "a charted shoal",
    AGAINST_TRAFFIC: "traffic lanes",
    OVER_LAND: "an approach over land",
    LOW_BRIDGE: "the size of the ship in a port or passage",
    PORT_TOO_SHALLOW: "the size of the ship in a port or passage",
    APPROACH_TOO_SMALL: "the size of the ship in a port or passage",
    CLOSED_ON_ROUTE: "the size of the ship in a port or passage",
}
_SOURCES: Final = {  # other sources of prices by their own name
    "request": "given",
    FACTOR_OF_SHIP_FILE: "by the factor of the ship file",
    FACTOR_OF_REQUEST: "by the given factor",
}


def route_items(
    route: Route, *, sea: Sea | None, chart: Chart | None, ship: Ship, notes: Sequence[str] = ()
) -> list[tuple[str, str]]:
    """Return the lines on an evaluated route as pairs of a word and a text.

    Parameters
    ----------
    sea, chart : With which it was evaluated.
    notes : Warnings about the route; those on depth show among the limits.
    """
    canals = canals_with_dues(canals_passed(route, chart), ship.file.hull)
    broken = [str(violation) for violation in route.violations]
    if not broken and not math.isfinite(route.arrive):
        broken = ["the route cannot be sailed to its end"]
    limits = [f"NOT KEPT: {text}" for text in dict.fromkeys(broken)] or [
        kept_text(route, ship, notes)
    ]
    return [
        ("Depart", utc_text(route.depart)),
        ("Arrive", arrival_text(route)),
        ("Distance", distance_text(route, canals)),
        ("Fuel", fuel_text(route)),
        ("Cost", cost_text(route, canals)),
        ("Weather", weather_text(route, sea) + sickness_text(route, ship)),
        ("Depth", least_clearance_text(route)),
        *(("Limits", text) for text in limits),
    ]


def arrival_text(route: Route) -> str:
    """Return the arrival and the time from departure, waits and their place named."""
    if not math.isfinite(route.arrive):
        return "never: the route cannot be sailed to its end"
    waits = ""
    if route.waiting_h >= 1.0 / 60.0:
        waits = f", of it waiting {duration_text(route.waiting_h * HOUR)}{_where_waits(route)}"
    return f"{utc_text(route.arrive)}, after {duration_text(route.arrive - route.depart)}{waits}"


def _where_waits(route: Route) -> str:
    """Return where the ship waits longest: at the start, or at a position on the way."""
    wait = np.asarray(route.track.wait, float)
    at = int(np.argmax(wait))
    where = "at the start"
    if at > 0:
        track = route.track
        where = f"at {format_position_minutes(float(track.lat[at]), float(track.lon[at]))}"
    return f" {where}" if wait[at] >= _MOST * wait.sum() else f", most of it {where}"


def distance_text(route: Route, canals: Sequence[Canal]) -> str:
    """Return the distance, the mean speed, the canals and the encounters with other ships."""
    sailing = route.time_h - route.waiting_h
    mean = f", mean speed {route.distance_nm / sailing:.1f} kn" if sailing > 0.0 else ""
    by = f", by {' and '.join(canal.title for canal in canals)}" if canals else ""
    met = "" if route.encounters is None else f", {route.encounters:.1f} encounters expected"
    return f"{miles_text(route.distance_nm)} nm{mean}{by}{met}"


def canals_passed(route: Route, chart: Chart | None) -> list[Canal]:
    """Return the canals that a route passes, in order."""
    if chart is None:
        return []
    lat, lon = np.asarray(route.track.lat), np.asarray(route.track.lon)
    number = np.array(chart.canal_of_legs(lat[:-1], lon[:-1], lat[1:], lon[1:]))
    if chart.approaches is not None:  # ports on canals, which are entered on the way
        part = part_number_of_legs(chart.canals, lat, lon)
        number = np.where(first_legs_of_transits(part), part, number)
    return [chart.canals[k] for k in number[number >= 0].tolist()]


def fuel_text(route: Route) -> str:
    """Return the fuel, and how much of it is burnt in emission control areas."""
    if route.fuel_t is None:
        return f"not known: {_why_unknown(route, 'the ship file has no fuel')}"
    inside = route.fuel_eca_t
    areas = f", of it {amount_text(inside, 't')} in emission control areas" if inside else ""
    return f"{amount_text(route.fuel_t, 't')}{areas}"


def cost_text(route: Route, canals: Sequence[Canal]) -> str:
    """Return the cost with its prices and their sources, and the canal dues in it."""
    dues = sum(canal.fee for canal in canals)
    bases = " and ".join(dict.fromkeys(canal.fee_basis for canal in canals if canal.fee_basis))
    basis = f" (by {bases})" if bases else ""
    if route.cost is None:
        paid = f"; canal dues {dues:,.0f} USD{basis}" if dues else ""
        return f"not known: {_why_unknown(route, 'no price of fuel or time')}{paid}"
    prices, rate = prices_text(route.prices), (route.prices or {}).get("usd_rate")
    at_rate = f" at {rate:g} {route.currency}" if rate else ""
    paid = f", of it canal dues {dues:,.0f} USD{at_rate}{basis}" if dues else ""
    inside, outside = ((route.prices or {}).get(f"fuel{k}_per_t") or {} for k in ("_in_eca", ""))
    if route.fuel_eca_t and outside.get("value") and inside.get("value") == outside["value"]:
        prices += "; no dearer fuel in control areas, where at most 0.10 % of sulphur is allowed"
    amount = amount_text(route.cost, route.currency) + _parts_text(route)
    return f"{amount}{paid}" + (f"; {prices}" if prices else "")


def _why_unknown(route: Route, usual: str) -> str:
    """Return why the fuel or the cost of a route is not known."""
    if not math.isfinite(route.time_h):
        return "the route cannot be sailed to its end"
    if "canal dues" in route.cost_parts and route.cost_parts["canal dues"] is None:
        return f"canal dues are in USD, prices in {route.currency}, and no fuel.usd_rate is given"
    charges, fuel = (route.prices.get(key) or {} for key in ("european_charges", "fuel_per_t"))
    if fuel.get("value") is not None and charges.get("voyage_share") and charges["euro_price"]:
        return "the FuelEU penalty of this fuel is not known; leave out the price of the euro"
    return usual


def _parts_text(route: Route) -> str:
    """Return the parts of a cost, but canal dues in USD, where there are two or more."""
    beside = "canal dues" if route.currency == "USD" else ""  # stated after the sum
    parts = [(n, v) for n, v in route.cost_parts.items() if v is not None and n != beside]
    own = {"fuel": "propulsion"} if route.fuel_t is None else {}  # priced by speed
    known = {own.get(name, name): value for name, value in parts if value >= 0.5}
    if len(known) < 2:
        return ""
    return f" ({', '.join(f'{name} {value:,.0f}' for name, value in known.items())})"


def prices_text(prices: Mapping[str, Any]) -> str:
    """Return the prices of a route that count, such as ``fuel 300 USD/t (ship file)``."""
    currency = prices.get("currency", "USD")

    def value(name: str) -> float | None:
        known = prices.get(name) or {}
        return known.get("value") or None  # a price of zero counts nothing

    texts = []
    fuel, inside, hire = (
        value(name) for name in ("fuel_per_t", "fuel_in_eca_per_t", "time_per_day")
    )
    cubed = value("per_second_per_cubed_speed")
    if fuel is not None:
        source = f" ({_source(prices, 'fuel_per_t')})"
        more = ""
        if inside not in (None, fuel):
            of_inside = f" ({_source(prices, 'fuel_in_eca_per_t')})"
            more = f"{'' if of_inside == source else source} and {inside:,.0f} in control areas"
            source = of_inside
        texts.append(f"fuel {fuel:,.0f} {currency}/t{more}{source}")
    if cubed is not None:
        source = _source(prices, "per_second_per_cubed_speed")
        texts.append(f"{cubed:g} {currency}/s per cubed speed ({source})")
    if hire is not None:
        own = prices["time_per_day"].get("replaced")
        more = "" if own is None else f" in place of {own:,.0f} of the ship file"
        texts.append(f"time {hire:,.0f} {currency}/day ({_source(prices, 'time_per_day')}{more})")
    elif texts:
        texts.append("no price of time")
    texts += _charges_texts(prices.get("european_charges") or {})
    return ", ".join(texts)


def _charges_texts(charges: Mapping[str, Any]) -> list[str]:
    """Return which charges of the European Union count, and which do not for want of a price."""
    if not charges.get("voyage_share"):
        return []
    share = f"on {100.0 * charges['voyage_share']:.0f} % by the rules of {charges['year']}"
    missing = charges["not_counted"]
    if len(missing) != 1:
        return [f"EU charges {share}"]
    if charges["allowance_price"]:
        return [f"EU ETS {share}", "FuelEU not counted (no --eur-rate)"]
    return [f"FuelEU {share}", "EU ETS not counted (no --ets-price)"]


def _source(prices: Mapping[str, Any], name: str) -> str:
    source = str(prices[name].get("source"))
    return _SOURCES.get(source, source)


def weather_text(route: Route, sea: Sea | None) -> str:
    """Return the highest waves, or the strongest wind or current, with place and time.

    Parameters
    ----------
    sea : Gives what the ship model does not read; without it only that is named.
    """
    weather = weather_on_route(route, sea)
    waves = weather.get(_WAVES)
    wind, current = (_speed(weather, pair) for pair in (_WIND, _CURRENT))
    if waves is not None and np.nanmax(waves, initial=0.0) > 0.0:
        at = int(np.nanargmax(waves))
        more = "" if wind is None else f" with wind of {wind[at]:.0f} kn"
        found = f"highest waves {waves[at]:.1f} m{more}, {_place(route, at)}"
        found += _waves_in_waits(route, float(waves[at]))
        return found + _ambient_text(sea, float(waves[at])) + _unknown_text(route, sea, waves)
    for values, word in ((wind, "wind"), (current, "current")):
        if values is not None and np.nanmax(values, initial=0.0) > 0.0:
            at = int(np.nanargmax(values))
            digits = 0 if word == "wind" else 1
            return f"strongest {word} {values[at]:.{digits}f} kn, {_place(route, at)}"
    known = [values for values in (waves, wind, current) if values is not None]
    if sea is not None and sea.layers and all(map(is_calm_layer, sea.layers)):
        return "calm: no wind, waves or currents"
    if len(known) == 3 and all(np.isfinite(values).all() for values in known):
        return "calm: no wind, waves or currents"
    if known and not any(np.isfinite(values).any() for values in known):
        return "not known: the data have no values on the way at that time"
    return "calm or not known: no wind, waves or currents in the data"


def _waves_in_waits(route: Route, under_way: float) -> str:
    """Return the highest waves while the ship waits at sea, where they are higher [m]."""
    if not route.wait_samples or _WAVES not in route.wait_samples:
        return ""
    at_sea = route.wait_samples["leg"] > 0
    highest = float(np.nanmax(route.wait_samples[_WAVES][at_sea], initial=0.0))
    return f"; {highest:.1f} m in a wait at sea" if highest >= under_way + _TENTH else ""


def _unknown_text(route: Route, sea: Sea | None, waves: np.ndarray) -> str:
    """Return on what shares of the way waves are not known, filled, or not counted."""
    shares = wave_shares(route, sea, waves)
    texts = (
        (shares.unknown, "waves not known on {:.0f} % of the way"),
        (shares.filled, "waves filled, not of the data, on {:.0f} % of the way"),
        (shares.approaches, "no weather counted on the approaches, {:.0f} % of the way"),
    )
    return "".join(f"; {text.format(share)}" for share, text in texts if share >= _LEAST_PERCENT)


def _ambient_text(sea: Sea | None, highest: float) -> str:
    """Return the uniform sea that is assumed around a modelled storm; empty without a storm."""
    storms = [one for one in (sea.layers if sea is not None else ()) if isinstance(one, StormLayer)]
    if not storms:
        return ""
    ambient: AmbientSea = storms[0].ambient
    wind = math.hypot(*ambient.wind) / KNOT
    values = f"waves {ambient.wave_height:.1f} m, wind {wind:.0f} kn"
    text = f"uniform sea assumed around the storm ({values})"
    return f": the {text}" if highest <= ambient.wave_height + 0.05 else f"; {text}"


def weather_on_route(route: Route, sea: Sea | None) -> dict[str, np.ndarray]:
    """Return waves, wind and current along a route, as far as the sea has them.

    The referee samples what the ship model needs; the rest comes from the sea.
    """
    samples = route.samples
    found = {name: np.asarray(samples[name]) for name in _NAMES if name in samples}
    if sea is None or sea.members:
        return found
    more = [name for name in _NAMES if name not in found and name in sea.variables]
    if more:
        time = np.where(np.isfinite(samples["time"]), samples["time"], route.depart)
        found |= sea.sample(more, time, samples["lat"], samples["lon"])
    return found


def sickness_text(route: Route, ship: Ship | None) -> str:
    """Return the share of people sick at each place of the ship; empty where it has none.

    The limit of the ship file holds for another exposure, and mostly at another place.
    """
    found = route.indicators
    places = [
        f"{name} {row['sick_percent']:.0f} %"
        for name, row in found["places"].items()
        if row["sick_percent"] is not None
    ]
    roll = found.get("max_roll_rms_deg")
    rolling = "" if roll is None else f"; roll to {roll:.1f} deg (root mean square)"
    allowed = sickness_limit_text(None if ship is None else ship.limits.safety)
    limit = f" (limit: {allowed})" if allowed else ""
    whole = "sick after the whole voyage"
    return f"; {whole}: {', '.join(places)}{limit}{rolling}" if places else ""


def least_clearance_text(route: Route) -> str:
    """Return the least under-keel clearance with place and time, or that depth is not known."""
    least, clearance = route.min_ukc_m, route.samples["under_keel_clearance"]
    if least is None:
        return "not known: no depth in the data"
    text = f"least under-keel clearance {_clearance_text(route, least)} m"
    if not np.isfinite(clearance).any():
        return text
    at = int(np.nanargmin(clearance))
    return f"{text} {_place(route, at)}" if clearance[at] <= least + 0.05 else text


def _clearance_text(route: Route, least: float) -> str:
    """Return the least clearance [m] as its violation states it, else 5 mm too much at most."""
    for one in route.violations:
        if one.reason == _UNDER_KEEL_CLEARANCE and abs(one.value - least) < _SAME_CLEARANCE:
            return one.number_texts()[0]
    return f"{math.floor(10.0 * (least + 5e-3)) / 10.0:.1f}" if least >= -1e-4 else f"{least:.2f}"


def kept_text(route: Route, ship: Ship | None, notes: Sequence[str]) -> str:
    """Return that all limits are kept, or which, where the depth is not known.

    Notes on lanes, shoals and the size of the ship, which are no limits of the referee, are named.
    """
    under_way = any(note.startswith(WAITS) for note in notes)
    seen = [what for first, what in _SEE_NOTES.items() if _any_starts(notes, first)]
    first = f"SEE THE NOTES on {', '.join(dict.fromkeys(seen))}; otherwise " if seen else ""
    if route.min_ukc_m is not None:
        where = ["under way, see the note on the wait"] if under_way else []
        if any(note.startswith(SQUAT_UNCOUNTED) for note in notes):
            where.append("at rest, NOT with squat: see the note on the clearance")
        return first + " ".join(("all kept", "; ".join(where))).rstrip()
    checked = ["land", "zones"]
    if ship is not None:
        named = (("waves", ship.limits.wave_height), ("wind", ship.limits.wind_speed))
        limited = [what for what, limit in named if math.isfinite(limit)]
        limited += ["safety and comfort in waves"] if ship.limits.safety is not None else []
        checked += [f"{what} under way" for what in limited] if under_way else limited
    depth = "NOT checked"
    if _any_starts(notes, CHECK_DEPTH):
        depth = "TO BE CHECKED: the depth layer has too little, see the note"
    required = 0.0 if ship is None else ship.min_under_keel_clearance
    depth += f" (the ship file requires {required:g} m: give --depth FILE)" if required else ""
    return f"{first}kept: {', '.join(checked)}; depth under the keel {depth}"


def _any_starts(notes: Sequence[str], first: str) -> bool:
    return any(note.startswith(f"{first} ") or note.startswith(f"{first}:") for note in notes)


def _speed(weather: dict[str, np.ndarray], pair: tuple[str, str]) -> np.ndarray | None:
    if not all(name in weather for name in pair):
        return None
    return np.asarray(np.hypot(*(weather[name] for name in pair)) / KNOT)


def _place(route: Route, at: int) -> str:
    samples = route.samples
    where = format_position_minutes(float(samples["lat"][at]), float(samples["lon"][at]))
    return f"at {where} on {utc_text(float(samples['time'][at]))}"
