"""Build the parts of a ship from the data of a ship file, and the model that the file chooses."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from thalweg.core.errors import InputError, refuse_other_file
from thalweg.ship.file.known_speed_ship_builder import (
    build_known_speed_model,
    estimates_of_known_speeds,
)
from thalweg.ship.file.part_builders import (
    build_limits,
    build_loading,
    resistance_methods,
    with_safety_limits,
)
from thalweg.ship.file.price_reader import fuel_terms
from thalweg.ship.hull.estimate import Estimate
from thalweg.ship.hull.hull import Hull, complete_hull
from thalweg.ship.loading_state import Loading
from thalweg.ship.model_protocol import DraughtModel, EstimatingModel, ShipModel
from thalweg.ship.models.function_model import model_of_function
from thalweg.ship.models.speed_power_laws import SPEED_POWER_LAWS
from thalweg.ship.schema.hull_types import check_hull_type
from thalweg.ship.schema.ship_schema import ShipFile, empty_ship_file
from thalweg.ship.schema.unusual_numbers import check_possible_numbers, check_speeds_of_powers
from thalweg.ship.ship_limits import ShipLimits


class ShipParts(NamedTuple):
    """The attributes of a ship, in the order of `thalweg.ship.Ship`."""

    name: str
    model: ShipModel
    loading: Loading
    limits: ShipLimits
    file: ShipFile
    estimated: tuple[Estimate, ...]


def ship_parts(data: Mapping[str, Any], source: str) -> ShipParts:
    """Return the attributes of a ship from the plain data of a ship file.

    Parameters
    ----------
    data : Keys of a ship file.
    source : What messages call the data.

    Returns
    -------
    ShipParts : At the load factor of the data.

    Raises
    ------
    InputError : For unknown or missing keys, numbers out of range and impossible hulls.
    """
    refuse_other_file(data, "a ship")
    file = ShipFile.of(data, source)
    check_possible_numbers(file)
    check_hull_type(file.hull.type)
    hull = complete_hull(file.hull.plain())
    loading = build_loading(file, hull)
    model = build_model(file, hull, loading)
    if file.powers_kw is not None:
        check_speeds_of_powers(file, model.speeds(loading.load_factor))
    limits = with_safety_limits(build_limits(file), file, hull, loading)
    if isinstance(model, EstimatingModel):
        estimated = model.estimated
    else:
        estimated = estimates_of_known_speeds(file, hull, loading)
    return ShipParts(file.name, model, loading, limits, file, estimated)


def bare_ship_parts(
    name: str, model: ShipModel, draught: float, limits: ShipLimits | None = None
) -> ShipParts:
    """Return the attributes of a ship without a ship file.

    Parameters
    ----------
    model : Its speed, power and fuel.
    draught : Draught at any load factor [m].
    limits : Limits of weather; by default none.

    Returns
    -------
    ShipParts : With an empty ship file.
    """
    loading = Loading(draught, draught)
    return ShipParts(name, model, loading, limits or ShipLimits(), empty_ship_file(), ())


def plugin_parts(name: str, offered: Any) -> ShipParts:
    """Return the attributes of a ship from what a plug-in offers.

    Parameters
    ----------
    offered : Data of a ship file, a model, or a function of conditions that returns speeds [m/s].

    Raises
    ------
    InputError : If it is none of these.
    """
    if isinstance(offered, Mapping):
        return ship_parts(offered, f"plug-in ship {name!r}")
    if isinstance(offered, ShipModel):
        draught = float(offered.draught) if isinstance(offered, DraughtModel) else 0.0
        return bare_ship_parts(name, offered, draught)
    if callable(offered):
        return bare_ship_parts(name, model_of_function(offered), 0.0)
    raise InputError(
        f"The plug-in ship {name!r} is {type(offered).__name__}.",
        "A plug-in offers a Ship, a mapping like a ship file, a ship model, or a function of "
        "conditions that returns speeds.",
        "Report this to the author of the plug-in.",
    )


def simple_data(
    *, name: str, speeds_kn: list[float], **sections: Mapping[str, Any]
) -> dict[str, Any]:
    """Return the data of a ship file from sections in which None means not given.

    Parameters
    ----------
    speeds_kn : Ordered speeds [kn].
    **sections : Keys and values of each section, such as ``hull``.

    Returns
    -------
    dict : Without the keys whose value is None.
    """
    given = {
        section: {key: value for key, value in values.items() if value is not None}
        for section, values in sections.items()
    }
    return {"name": name, "speeds_kn": speeds_kn, **given}


def build_model(file: ShipFile, hull: Hull, loading: Loading) -> ShipModel:
    """Return the model that a ship file chooses.

    Raises
    ------
    InputError : For unknown methods, methods that do not go together, and missing data.
    """
    fuel_terms(file)  # refuses unknown fuels and two prices for one thing
    if (file.models.calm_water or "none") in SPEED_POWER_LAWS and not resistance_methods(file):
        return build_known_speed_model(file, hull, loading)
    from thalweg.ship.file.resistance_ship_builder import (
        build_resistance_model,  # the physics is needed from here on
    )

    return build_resistance_model(file, hull, loading)
