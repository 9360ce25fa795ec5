"""The wind of a cyclone's vortex along its best track."""

from __future__ import annotations

import math
from typing import Any, Final, NamedTuple

import numpy as np

from thalweg.core.geodesy import unit_vectors
from thalweg.core.types import FloatArray
from thalweg.sea.models import cyclone_formulas as formulas
from thalweg.sea.models.cyclone_track import BestTrack

FULL_RADIUS: Final = 600e3  #: [m] within this radius the vortex has its full wind
OUTER_RADIUS: Final = 1200e3  #: [m] beyond this radius the vortex has no wind
MAX_WIND_RADIUS: Final = 150e3  #: [m] largest radius of maximum wind of an extratropical storm


class VortexState(NamedTuple):
    """The vortex at several times; all arrays of one shape, SI units."""

    centre: FloatArray  # unit vectors, last axis 3
    coriolis: FloatArray  # negative in the south
    radius: FloatArray
    deficit: FloatArray
    b: FloatArray
    maximum: FloatArray  # symmetric gradient wind
    added: tuple[FloatArray, FloatArray]  # wind from translation
    fetch: FloatArray

    def at(self, pick: Any) -> VortexState:
        """Return the state at some of the times."""
        added = (self.added[0][pick], self.added[1][pick])
        return VortexState(
            self.centre[pick],
            self.coriolis[pick],
            self.radius[pick],
            self.deficit[pick],
            self.b[pick],
            self.maximum[pick],
            added,
            self.fetch[pick],
        )


def vortex_state(track: BestTrack, time: FloatArray) -> VortexState:
    r"""Return the parameters of the vortex at times.

    .. math:: V_m^2 + |f| R_m V_m = \frac{B \Delta p}{\rho e}

    Extratropical storms have a low central pressure and moderate wind: Holland's B would fall
    below its range. They are wide, so the radius of maximum wind is increased until gradient
    balance holds between the track's pressure and wind at B = 1, up to 150 km. The wind of the
    track has priority over its pressure: the pressure deficit of the profile is the one that gives
    this wind at this radius. Gradient balance (Holland 1980, eq. 4 at r = Rm).

    Parameters
    ----------
    time : Times [s since epoch], (N,).

    Returns
    -------
    VortexState : Arrays (N,).

    References
    ----------
    G. J. Holland, Monthly Weather Review 108 (1980) 1212-1218, eq. 4 at the radius of maximum
    wind.
    """
    lat, lon = track.position(time)
    wind = np.interp(time, track.time, track.wind)
    deficit = formulas.AMBIENT_PRESSURE - np.interp(time, track.time, track.pressure)
    east, north = track.velocity(time)
    added = formulas.translation_wind(east, north, lat)
    symmetric = np.maximum(wind - np.hypot(*added), 0.5 * wind) / formulas.SURFACE_FACTOR
    b = formulas.holland_b(symmetric, deficit)
    radius = formulas.radius_of_maximum_wind_willoughby2006(wind, lat)
    coriolis = formulas.coriolis_parameter(lat)
    turning = np.abs(coriolis) * np.maximum(symmetric, 1.0)
    surplus = b * deficit / (formulas.AIR_DENSITY * math.e) - symmetric**2
    radius = np.clip(
        surplus / np.maximum(turning, 1e-9), radius, np.maximum(radius, MAX_WIND_RADIUS)
    )
    fitted = formulas.AIR_DENSITY * math.e * (symmetric**2 + turning * radius) / b
    fetch = formulas.equivalent_fetch_young2013(wind, np.hypot(east, north), radius)
    centre = unit_vectors(lat, lon)
    return VortexState(centre, coriolis, radius, fitted, b, symmetric, added, fetch)


def vortex_wind(
    radius: FloatArray, inward: tuple[FloatArray, FloatArray], state: VortexState
) -> tuple[tuple[FloatArray, FloatArray], FloatArray]:
    r"""Return the contribution of the storm to the wind at 10 m.

    .. math::
        \mathbf{w} = s V_g(r)\, \mathbf{e}_{spiral} + \frac{V_g(r)}{V_m}
            \mathbf{w}_{translation}

    Parameters
    ----------
    radius : Distance from the centre [m].
    inward : Unit vector (east, north) towards the centre.
    state : The vortex at the time of each point.

    Returns
    -------
    wind : (east, north) towards [m/s].
    share : Local over maximum symmetric wind, 0 to 1; where it is 1 there is no ambient wind.

    References
    ----------
    The formulas of `thalweg.sea.models.cyclone_formulas`; s is the reduction from gradient wind
    to 10 m.
    """
    gradient = formulas.holland_gradient_wind(
        radius,
        radius_of_maximum=state.radius,
        pressure_deficit=state.deficit,
        b=state.b,
        coriolis=state.coriolis,
    )
    gradient = gradient * _taper(radius)
    share = np.clip(gradient / np.maximum(state.maximum, 1e-6), 0.0, 1.0)
    angle = formulas.inflow_angle(radius, state.radius)
    spin = np.where(state.coriolis >= 0.0, 1.0, -1.0)  # counter-clockwise in the north
    speed = gradient * formulas.SURFACE_FACTOR
    across, along = speed * np.cos(angle) * spin, speed * np.sin(angle)
    u = across * inward[1] + along * inward[0] + share * state.added[0]
    v = -across * inward[0] + along * inward[1] + share * state.added[1]
    return (u, v), share


def _taper(radius: FloatArray) -> FloatArray:
    """Return 1 within the full radius, decreasing smoothly to 0 at the outer radius."""
    x = np.clip((radius - FULL_RADIUS) / (OUTER_RADIUS - FULL_RADIUS), 0.0, 1.0)
    return 1.0 - x * x * (3.0 - 2.0 * x)
