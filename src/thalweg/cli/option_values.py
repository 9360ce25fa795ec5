"""From the values of shared options to objects: sea, ship, chart, position, output folder."""

from __future__ import annotations

import argparse
import contextlib
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from thalweg.cli.options import FILLABLE
from thalweg.core.errors import InputError, ThalwegError
from thalweg.core.units import DAY, HOUR, NAUTICAL_MILE

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.core.geodesy import Position
    from thalweg.planning.request.filled_sea import FillValue
    from thalweg.route import RouteFileOptions
    from thalweg.sea import Sea
    from thalweg.ship import Ship
    from thalweg.ship.methods.engine.european_charges import EuropeanCharges


def parse_pairs(option: str, texts: Sequence[str], form: str, example: str) -> dict[str, str]:
    """Return the pairs of an option that is written NAME=VALUE, several times.

    Parameters
    ----------
    option : Name of the option, for the message.
    texts : What was given.
    form, example : How a pair is written, and an example, for the message.

    Raises
    ------
    InputError : If one of them is not a pair.
    """
    pairs = [text.partition("=") for text in texts]
    for name, equals, value in pairs:
        if not (name and equals and value):
            raise InputError(
                f"{option} {name}{equals}{value} is not understood.",
                f"It is written {form}, such as {example}.",
                "Give the value in this form.",
            )
    return {name: value for name, _, value in pairs}


def variable_mapping(arguments: argparse.Namespace) -> dict[str, str]:
    """Return the variable of each quantity as ``--map`` states it.

    Raises
    ------
    InputError : If a part of it is not NAME=VARIABLE.
    """
    example = "eastward_wind=u or crs=EPSG:32611"
    return parse_pairs("--map", arguments.map, "NAME=VARIABLE", example)


def open_sea(arguments: argparse.Namespace) -> Sea:
    """Return the sea that the options name.

    Raises
    ------
    InputError : If no sea is named, or options contradict each other.
    """
    from thalweg.sea import Sea

    policies = [_parse_fill_policy(text) for text in arguments.fill]
    _check_options(arguments)
    if not arguments.calm and not arguments.sea:
        raise InputError(
            "No sea is given.",
            "Thalweg never assumes calm weather.",
            "Give --sea FILE..., --sea storm, or --calm.",
        )
    member = getattr(arguments, "member", None)
    if arguments.calm:
        calm = _check_ensemble_choice(Sea.calm(), arguments)
        return calm if member is None else calm.member(member)
    files = [name for name in arguments.sea if name != "storm"]
    options: dict[str, Any] = {
        "mapping": variable_mapping(arguments),
        "draught_m": arguments.average_over,
    }
    if files:
        arguments.progress(f"reading {', '.join(files)}")
    layers = [Sea.open(*files, **options)] if files else []
    of_members = getattr(arguments, "ensemble", None) or member is not None
    if len(files) > 1 and of_members and not layers[0].members:
        layers = [Sea.ensemble(*files, **options)]
    if "storm" in arguments.sea:
        layers.append(Sea.storm())
    sea = layers[0] if len(layers) == 1 else Sea.layered(*layers)
    sea = _check_ensemble_choice(sea, arguments)
    sea = sea if member is None else sea.member(member)
    if policies:
        from thalweg.planning.request.filled_sea import filled_in_turns
        from thalweg.planning.request.voyage_surroundings import chart_of_entries

        by_fetch = ("waves", "fetch_limited") in policies
        coast = chart_of_entries(_resolution(arguments)) if by_fetch else None
        sea = filled_in_turns(sea, policies, coast)
    return sea.sampled(getattr(arguments, "sampling", "linear"))


def _check_options(arguments: argparse.Namespace) -> None:
    """Raise `InputError` for options that have no effect on the sea that is named."""
    of_files = [("--map", arguments.map), ("--average-over", arguments.average_over is not None)]
    for option, given in [("--sea", arguments.sea), ("--fill", arguments.fill), *of_files]:
        if arguments.calm and given:
            raise InputError(
                f"Both --calm and {option} are given.",
                "A calm sea has no wind, waves or currents anywhere.",
                "Choose one.",
            )
    for option, given in of_files:
        if given and arguments.sea and set(arguments.sea) == {"storm"}:
            raise InputError(
                f"{option} is given without a file.",
                "It applies to files; the modelled storm of the package is not a file.",
                f"Omit {option}, or add a file to --sea.",
            )


def _check_ensemble_choice(sea: Sea, arguments: argparse.Namespace) -> Sea:
    """Return a sea; raise `InputError` if ``--ensemble`` is given and it has no members."""
    if getattr(arguments, "ensemble", None) and not sea.members:
        raise InputError(
            "--ensemble needs a forecast with several members, but the sea has none.",
            "A file may have a dimension of members (number, realization, ...), or there is one "
            "file for each member.",
            "Give such files with --sea, or omit --ensemble.",
        )
    return sea


def _parse_fill_policy(text: str) -> tuple[str, FillValue]:
    name, _, value = text.partition("=")
    try:
        if name not in FILLABLE:
            raise ValueError
        of_waves = name == "waves" and (
            value in ("wind", "head_seas", "fetch_limited") or value.startswith("coastal_shelter")
        )
        is_text = of_waves or (name, value) == ("wind", "waves") or value.startswith("nearest:")
        east, comma, north = value.partition(",")
        if comma and name in ("currents", "wind"):
            return name, (float(east), float(north))
        return name, value if is_text else float(value)
    except ValueError:
        raise InputError(
            f"--fill {text} is not understood.",
            f"It is one of {', '.join(f'{n}=0' for n in FILLABLE)}, currents=EAST,NORTH, "
            "wind=EAST,NORTH (towards, in m/s), wind=waves, waves=wind, waves=head_seas, "
            "waves=coastal_shelter, waves=fetch_limited, or NAME=nearest:NM.",
            "Give the value in this form.",
        ) from None


def check_chart_files(arguments: argparse.Namespace) -> None:
    """Raise `InputError` if a file of the chart does not exist, before anything is loaded."""
    for option in ("depth", "zones", "traffic"):
        for name in getattr(arguments, option, ()):
            if not Path(name).expanduser().exists():
                raise InputError(
                    f"There is no file {name}.",
                    f"--{option} names a file.",
                    "Check the path.",
                    file=name,
                )


def open_chart(arguments: argparse.Namespace) -> Chart:
    """Return the chart that the options name."""
    from thalweg.planning.request.voyage_surroundings import chart_of_entries

    arguments.progress("reading the chart")
    return chart_of_entries(
        _resolution(arguments),
        depths=arguments.depth,
        areas=arguments.zones,
        traffic=arguments.traffic,
        eca=not getattr(arguments, "no_eca", False),
    )


def _resolution(arguments: argparse.Namespace) -> str:
    from thalweg.chart.coast.gshhg import usual_resolution

    return getattr(arguments, "coast", None) or usual_resolution()


def open_ship(arguments: argparse.Namespace) -> Ship:
    """Return the ship that the options name, at the load they state."""
    from thalweg.ship import Ship

    arguments.progress(f"reading the ship {arguments.ship}")
    ship = Ship.load(arguments.ship)
    if arguments.load_factor is not None:
        ship = ship.with_load_factor(arguments.load_factor)
    if getattr(arguments, "approach_speed", None) is not None:  # some commands have no approaches
        ship = ship.with_approach_speed(arguments.approach_speed)
    return ship


def with_given_prices(ship: Ship, arguments: argparse.Namespace) -> Ship:
    """Return a ship with the prices that the options give.

    Raises
    ------
    InputError : For prices that are not possible, or in two currencies.
    """
    hourly = arguments.time_price
    priced = ship.with_prices(
        arguments.fuel_price,
        arguments.eca_price_factor,
        time_usd_per_day=None if hourly is None else hourly * DAY / HOUR,
    )
    charges = _european_charges(arguments)
    return priced if charges is None else priced.with_charges(charges)


def with_held_order(ship: Ship, arguments: argparse.Namespace) -> Ship:
    """Return a ship that holds the speed of ``--speed`` through water where ``--hold`` says so.

    Raises
    ------
    InputError : If there is no speed to hold, or the ship cannot hold it.
    """
    from thalweg.ship.held_speed import with_held_power, with_held_speed

    if arguments.hold is None:
        return ship
    if arguments.speed is None:
        raise InputError(
            f"--hold {arguments.hold} is given without a speed.",
            "It says what the engine holds at --speed.",
            "Add --speed, or leave out --hold.",
            field="hold",
        )
    if arguments.hold == "speed":
        return with_held_speed(ship, arguments.speed)
    return with_held_power(ship, arguments.speed)


def _european_charges(arguments: argparse.Namespace) -> EuropeanCharges | None:
    """Return the charges of the European Union that the options give."""
    from thalweg.planning.request.voyage_surroundings import check_charges
    from thalweg.ship.methods.engine.european_charges import EuropeanCharges

    share, allowance, euro = arguments.eu_share, arguments.ets_price, arguments.eur_rate
    year = _year_of_charges(arguments)
    check_charges({"ets_price": allowance or 0.0, "eur_rate": euro or 0.0, "year": year})
    if allowance is None and euro is None:
        return None
    prices = allowance or 0.0, euro or 0.0, year
    if share is not None:
        return EuropeanCharges(share / 100.0, *prices)
    from thalweg.planning.request.european_scope import share_between_places

    ends = (getattr(arguments, name, None) for name in ("start", "goal"))
    found, source = share_between_places(*ends)
    return EuropeanCharges(found, *prices, source)


def _year_of_charges(arguments: argparse.Namespace) -> int:
    """Return the year whose European rules hold: the one given, or that of the departure."""
    if arguments.eu_year is not None:
        return int(arguments.eu_year)
    from thalweg.planning.request.voyage_surroundings import year_of_rules
    from thalweg.route.formats import read_track

    times = vars(arguments)
    if times.get("route") is not None and times.get("depart") is None:
        with contextlib.suppress(ThalwegError):  # what is wrong with the file is stated later
            times = {"depart": read_track(times["route"]).depart}
    return year_of_rules(times)


def position_from_text(text: str) -> Position:
    """Return the position (lat, lon) [deg] that a text states.

    Raises
    ------
    InputError : If it is not a position; names of ports are not accepted here.
    """
    from thalweg.core.geodesy import parse_position

    position = parse_position(text)
    if position is None:
        raise InputError(
            f"{text!r} is not a position.",
            "A position is LAT,LON in degrees, such as 52.1,3.97 or 52.1N 3.97E.",
            "Give the value in this form.",
            value=text,
        )
    return float(position[0]), float(position[1])


def resolution_m(value_nm: float | None) -> float | None:
    """Return a resolution in metres from one in nautical miles.

    Raises
    ------
    InputError : If it is not between 0.001 and 300 nm.
    """
    if value_nm is None:
        return None
    if not 0.001 <= value_nm <= 300:
        raise InputError(
            f"The resolution is {value_nm:g} nm.",
            "It is between 0.001 and 300 nm.",
            "Correct --resolution.",
        )
    return value_nm * NAUTICAL_MILE


def route_file_options(arguments: argparse.Namespace) -> RouteFileOptions:
    """Return how route files are written.

    Raises
    ------
    InputError : If a number is impossible, or an option is given without ``--out``.
    """
    from thalweg.route import RouteFileOptions
    from thalweg.route.formats import ROUTE_FORMATS

    names = {
        "xtd": "cross_track_nm",
        "waypoint_spacing": "spacing_nm",
        "max_waypoints": "max_waypoints",
        "rtz": "rtz_version",
        "legs": "legs",
    }
    given = {name: getattr(arguments, option) for option, name in names.items()}
    given = {name: value for name, value in given.items() if value is not None}
    if arguments.formats is not None:
        endings = [ending.strip().casefold() for ending in arguments.formats.split(",")]
        given["formats"] = ROUTE_FORMATS if endings == ["all"] else tuple(endings)
    if given and not arguments.out:
        raise InputError(
            "Options of route files are given without --out.",
            "The files are written into the folder of --out.",
            "Add --out DIR.",
        )
    return RouteFileOptions(**given)


def prepare_output_folder(arguments: argparse.Namespace) -> None:
    """Create the folder of ``--out``, before any work is done.

    Raises
    ------
    InputError : If it cannot be created or written.
    """
    if arguments.out:
        from thalweg.core.file_writing import make_folder

        make_folder(arguments.out)


def prepare_output_file(path: str) -> Path:
    """Create the folder of an output file, before any work is done, and return its path.

    Raises
    ------
    InputError : If the path is a folder, or its folder cannot be created or written.
    """
    from thalweg.core.file_writing import make_folder

    target = Path(path)
    if target.is_dir():
        raise InputError(
            f"{path} is a folder.", "--out is a file here.", "Add the name of a file to it."
        )
    make_folder(target.parent)
    return target
