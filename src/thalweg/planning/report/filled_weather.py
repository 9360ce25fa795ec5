"""Where the waves on a route are those of a fill value or policy, not of the data."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from thalweg.core.types import BoolArray, FloatArray
from thalweg.route.route_tables import LEG_KINDS
from thalweg.sea.fill_policies import layers_without_fills
from thalweg.sea.layer_stack import sample_stack, stack_variables

if TYPE_CHECKING:
    from thalweg.route import Route
    from thalweg.sea import Sea

FILLED: Final = "Waves are filled"  #: a note on such routes begins so
_WAVES: Final = "sea_surface_wave_significant_height"


def has_fills(sea: Sea) -> bool:
    """Return whether some layer of a sea holds fill values or policies."""
    return len(layers_without_fills(sea.layers)) < len(sea.layers)


def waves_are_filled(sea: Sea, time: FloatArray, lat: FloatArray, lon: FloatArray) -> BoolArray:
    """Return at which positions and times the height of the waves is filled.

    Parameters
    ----------
    sea : A single one, not an ensemble.
    time : float64 array (n,) [s since 1970-01-01T00:00Z]
    lat, lon : float64 array (n,) [deg]

    Returns
    -------
    bool array (n,) : False everywhere for a sea without fills for waves.
    """
    if sea.members or not has_fills(sea) or _WAVES not in sea.variables:
        return np.zeros(len(time), bool)
    layers = layers_without_fills(sea.layers)
    if _WAVES not in stack_variables(layers):
        return np.ones(len(time), bool)
    return np.isnan(sample_stack(layers, [_WAVES], time, lat, lon)[_WAVES])


class WaveShares(NamedTuple):
    """How the waves on a route are known.

    Attributes
    ----------
    unknown, filled : Share of the way at sea where they are not known, or filled [%].
    approaches : Share of the way in approaches of ports, where no weather counts [%].
    """

    unknown: float
    filled: float
    approaches: float


def wave_shares(route: Route, sea: Sea | None, height: FloatArray) -> WaveShares:
    """Return how the waves on a route are known.

    Parameters
    ----------
    route : Scored by the referee.
    sea : With which it was evaluated; without it nothing counts as filled.
    height : Significant wave height at its samples [m]; NaN where unknown.
    """
    samples = route.samples
    step = np.diff(np.asarray(samples["distance"], float), prepend=0.0)
    kind = np.asarray(route.legs.get("leg_kind", np.zeros(len(route.legs["length"]))))
    kinds, known = kind[samples["leg"]], ~np.isnan(height)
    at_sea = kinds == LEG_KINDS.index("sea")
    filled = np.zeros(len(step), bool)
    if sea is not None and has_fills(sea):
        time = np.where(np.isfinite(samples["time"]), samples["time"], route.depart)
        filled = waves_are_filled(sea, time, np.asarray(samples["lat"]), np.asarray(samples["lon"]))
    which = at_sea & ~known, at_sea & known & filled, kinds == LEG_KINDS.index("approach")
    return WaveShares(*(100.0 * float(step[one].sum() / max(step.sum(), 1.0)) for one in which))


def filled_waves_note(routes: Sequence[Route], sea: Sea) -> str:
    """Return on how much of each of some routes the waves are filled; empty where on none."""
    if sea.members or not has_fills(sea) or _WAVES not in sea.variables:
        return ""
    shares = []
    for route in routes:
        samples = route.samples
        time = np.where(np.isfinite(samples["time"]), samples["time"], route.depart)
        height = sea.sample([_WAVES], time, samples["lat"], samples["lon"])[_WAVES]
        shares.append(wave_shares(route, sea, np.asarray(height)).filled)
    if max(shares, default=0.0) < 0.5:
        return ""
    each = ", ".join(f"{number}: {share:.0f} %" for number, share in enumerate(shares, start=1))
    return (
        f"{FILLED}, not of the data, on this share of each route: {each}. Compare motions and "
        "sickness of the routes with that in mind."
    )
