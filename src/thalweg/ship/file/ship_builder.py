"""Build the model that a ship file chooses."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from thalweg.ship.file.known_speed_ship_builder import build_known_speed_model
from thalweg.ship.file.part_builders import resistance_methods
from thalweg.ship.fuel_prices import fuel_terms
from thalweg.ship.hull.hull import Hull
from thalweg.ship.loading_state import Loading
from thalweg.ship.model_protocol import ShipModel
from thalweg.ship.models.speed_power_laws import SPEED_POWER_LAWS
from thalweg.ship.schema.ship_schema import ShipFile


def simple_data(
    *, name: str, speeds_kn: list[float], **sections: Mapping[str, Any]
) -> dict[str, Any]:
    """Return the data of a ship file from sections in which None means not given."""
    given = {
        section: {key: value for key, value in values.items() if value is not None}
        for section, values in sections.items()
    }
    return {"name": name, "speeds_kn": speeds_kn, **given}


def build_model(file: ShipFile, hull: Hull, loading: Loading) -> ShipModel:
    """Return the model that a ship file chooses.

    Parameters
    ----------
    file : ShipFile
        The ship file.
    hull : Hull
        Its hull.
    loading : Loading
        Its loading.

    Returns
    -------
    ShipModel
        The model.

    Raises
    ------
    InputError
        For unknown methods, methods that do not go together, and missing data.
    """
    fuel_terms(file)  # refuses unknown fuels and two prices for one thing
    if (file.models.calm_water or "none") in SPEED_POWER_LAWS and not resistance_methods(file):
        return build_known_speed_model(file, hull, loading)
    from thalweg.ship.file.resistance_ship_builder import (
        build_resistance_model,  # the physics is needed from here on
    )

    return build_resistance_model(file, hull, loading)
