"""Smooth currents with the least time of passage known to nine digits.

Zermelo's equation (1931) for a ship of speed 1 in a current (u, v), with the heading h from the
x axis::

    dh/dt = v_x sin^2 h + (u_x - v_y) sin h cos h - u_y cos^2 h

The first heading and the time of each flow are a root of the miss at the goal, started from the
best of a fan of 3,000 extremals.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import least_squares

Current = Callable[..., tuple[np.ndarray, np.ndarray]]
_STEP = 1e-5  # of differences


@dataclass(frozen=True)
class SmoothFlow:
    """A current in units of the ship's speed, with a start, a goal and the best of the fan.

    Attributes
    ----------
    current : (t, x, y) -> (u, v); t in units of length over the ship's speed.
    fan : Heading and time of the best extremal of the fan.
    """

    current: Current
    start: tuple[float, float]
    goal: tuple[float, float]
    fan: tuple[float, float]

    def _rates(self, t, state):
        x, y, heading = state
        u, v = self.current(t, x, y)
        along = np.subtract(self.current(t, x + _STEP, y), self.current(t, x - _STEP, y))
        across = np.subtract(self.current(t, x, y + _STEP), self.current(t, x, y - _STEP))
        (u_x, v_x), (u_y, v_y) = along / (2 * _STEP), across / (2 * _STEP)
        sine, cosine = np.sin(heading), np.cos(heading)
        turn = sine**2 * v_x + sine * cosine * (u_x - v_y) - cosine**2 * u_y
        return [u + cosine, v + sine, turn]

    def _extremal(self, heading, until, **options):
        state = (*self.start, heading)
        return solve_ivp(
            self._rates, (0.0, until), state, "DOP853", rtol=1e-12, atol=1e-12, **options
        ).y[:2]

    def optimum(self, points: int = 2) -> tuple[float, np.ndarray]:
        """Return the least time and points (2, n) at equal intervals of it on the best line."""

        def miss(unknown):
            return self._extremal(*unknown)[:, -1] - self.goal

        root = least_squares(miss, self.fan, xtol=1e-15, ftol=1e-15, gtol=1e-15)
        assert np.abs(root.fun).max() < 1e-8
        heading, time = root.x
        return time, self._extremal(heading, time, t_eval=np.linspace(0.0, time, points))


def _turning(t, x, y):
    return 0.9 * y, -0.9 * x


def _four_vortices(t, x, y):
    u = v = 0.0 * x
    for a, b, sign in ((2, 2, -1), (4, 4, -1), (2, 5, -1), (5, 1, 1)):
        strength = sign * 1.7 / (3 * ((x - a) ** 2 + (y - b) ** 2) + 1)
        u, v = u - strength * (y - b), v + strength * (x - a)
    return u, v


def _sink_with_growing_vortex(t, x, y):
    return -0.3 * x - (t - 0.5) * y, (t - 0.5) * x - 0.3 * y


FLOWS = {
    # solid rotation, Techy (2011), doi 10.1007/s11370-011-0092-9
    "circular": SmoothFlow(_turning, (-0.9, 0.3), (0.8, -0.4), (0.262, 1.512)),
    # Ferraro et al. (2021), doi 10.1016/j.ifacol.2021.11.097
    "four vortices": SmoothFlow(_four_vortices, (0.0, 0.0), (6.0, 2.0), (1.1574, 8.9495)),
    # figure 12 of Techy (2011): the vortex changes in time
    "growing vortex": SmoothFlow(
        _sink_with_growing_vortex, (np.cos(np.pi / 6), 0.5), (0.0, 1.0), (2.356, 1.026)
    ),
}
