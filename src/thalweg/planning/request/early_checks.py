"""Checks that need neither the chart nor a network: they come before anything large is loaded."""

from __future__ import annotations

from thalweg.core.errors import InputError
from thalweg.core.limits import DEEPEST_DRAUGHT
from thalweg.kernels import codes
from thalweg.planning.request.ordered_speed import with_order
from thalweg.planning.request.requirements import check_departure_in_data, check_variables
from thalweg.planning.voyage import Voyage
from thalweg.sea import Sea, standard_names
from thalweg.ship import Ship

_CURRENT = (codes.CURRENT_EAST, codes.CURRENT_NORTH)


def check_request(voyage: Voyage, ship: Ship, sea: Sea) -> None:
    """Check that the ship has the speed and the sea the variables and times of a voyage.

    Parameters
    ----------
    sea : A single sea or an ensemble.

    Raises
    ------
    InputError : If the ship does not have the speed, or has a draught that no ship has.
    MissingVariableError : If the ship needs variables that the sea does not have.
    OutsidePeriodError : If the departure is outside the period of the data.
    """
    _check_draught(float(ship.draught))
    with_order(ship, voyage)
    check_variables(ship, sea)
    if voyage.departure_is_open:
        return
    channels = {c for c, name in standard_names.CHANNEL_VARIABLES.items() if name in ship.needs}
    if all(name in sea.variables for name in standard_names.CURRENT.pair):
        channels.update(_CURRENT)
    check_departure_in_data(voyage, sea, channels)


def _check_draught(draught: float) -> None:
    """Refuse a draught [m] out of the range of ship files and distances; 0 where it is unknown."""
    if not 0.0 <= draught <= DEEPEST_DRAUGHT:
        raise InputError(
            f"The draught is {draught:g} m.",
            f"Draughts are above 0 and at most {DEEPEST_DRAUGHT:g} m.",
            "Correct it.",
            field="draught_m",
        )
