"""Which share of a voyage is in scope of charges of the European Union, by its ports."""

from __future__ import annotations

from thalweg.chart.ports import PORTS
from thalweg.core.errors import InputError
from thalweg.core.geodesy import parse_position
from thalweg.ship.methods.engine.european_charges import voyage_share_between


def share_between_places(start: object, goal: object) -> tuple[float, str]:
    """Return the share of a voyage between named ports in scope of the charges, and its source.

    Parameters
    ----------
    start, goal : Places as of a voyage.

    Returns
    -------
    share : 0, 0.5 or 1 [-].
    source : The ports and the rule.

    Raises
    ------
    InputError : If an end is not a port given by name.
    """
    if not all(isinstance(end, str) and parse_position(end) is None for end in (start, goal)):
        raise InputError(
            "A price of allowances or of a euro is given without the share of the voyage.",
            "It is 100 between two ports of the Union, 50 to or from one, else 0; it is found "
            "where both ends of a plan are ports given by name.",
            "Add the share (--eu-share, charges.share_percent).",
            field="eu_share",
        )
    first, last = (PORTS.lookup(str(end)) for end in (start, goal))
    share = voyage_share_between(first.country_code, last.country_code)
    rule = "Directive 2003/87/EC, article 3ga"
    return share, f"{first.label} to {last.label}: {100.0 * share:.0f} % ({rule})"
