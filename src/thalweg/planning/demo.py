"""The demonstration voyage: New York to Bishop Rock while a hurricane's remains catch up."""

from __future__ import annotations

from thalweg.planning.voyage import Voyage


def demo_voyage() -> Voyage:
    """Return the voyage of ``make demo``.

    Departing on 30 August 1998 the great circle meets Danielle south-west of Ireland, where the
    storm, fresh from its turn to the north-east, overtakes the ship.
    """
    return Voyage(start="New York", goal="49.7N 6.5W", depart="1998-08-30T00:00Z")
