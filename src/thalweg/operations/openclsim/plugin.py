"""OpenCLSim vessels that sail Thalweg's routes (needs ``pip install "thalweg[openclsim]"``).

`PlannedRouteMovable` is a mix-in class for OpenCLSim; it replaces ``Movable`` among the base
classes of a vessel. When an activity moves the vessel, the leg is planned for the present time of
the simulation and the present load of the vessel; its duration, distance, waits, energy and fuel
are those of the plan and are written to the vessel's log.
"""

from __future__ import annotations

from collections.abc import Generator
from typing import TYPE_CHECKING, Any

import numpy as np
from shapely.geometry import Point, shape

from thalweg.core.errors import InputError
from thalweg.core.geodesy import Position
from thalweg.core.given_numbers import finite_or_none
from thalweg.deprecated_names import renamed_arguments
from thalweg.operations.dredging.cycle_records import SailedLeg

try:
    from openclsim.core import LogState, Movable
except ImportError as error:
    raise ImportError(
        "OpenCLSim is not installed. The plug-in needs it: pip install 'thalweg[openclsim]'."
    ) from error

if TYPE_CHECKING:
    from thalweg.operations.openclsim.leg_planner import LegPlanner


class PlannedRouteMovable(Movable):
    """Mix-in class of an OpenCLSim vessel that moves along routes planned by Thalweg.

    Parameters
    ----------
    leg_planner : LegPlanner
        The ship, the sea and the chart. The simulation's clock (``env.now``) is in seconds since
        1970-01-01T00:00Z, as in the logs of OpenCLSim.
    *args, **kwargs
        For the other base classes: ``env``, ``geometry``, ``capacity`` ...

    Attributes
    ----------
    legs : list of SailedLeg
        All legs sailed so far, in order, as evaluated by the referee.

    Notes
    -----
    The load factor is the level of the vessel's container over its capacity; a vessel without a
    container sails as its ship is loaded. Every move writes ``START`` and ``STOP`` to the log, and
    ``WAIT_START`` and ``WAIT_STOP`` with the position for each wait on the way; ``STOP`` carries
    ``distance_m``, ``waiting_s``, ``least_clearance_m``, ``least_clearance_with_squat_m``,
    ``energy_j`` and ``fuel_kg`` (None where unknown) beside the state of the vessel.

    Examples
    --------
    A vessel is composed as usual in OpenCLSim::

        Vessel = type("Vessel", (Identifiable, PlannedRouteMovable, Processor, LoadingFunction,
                                 UnloadingFunction, HasContainer, HasResource, Log), {})
    """

    @renamed_arguments(fairways="leg_planner")
    def __init__(self, leg_planner: LegPlanner, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self.leg_planner = leg_planner
        self.legs: list[SailedLeg] = []

    @property
    def load_factor(self) -> float:
        """Level of the container over its capacity; the ship's own load without a container."""
        container = getattr(self, "container", None)
        if container is None:
            return self.leg_planner.ship.loading.load_factor
        return float(container.get_level() / container.get_capacity())

    @property
    def v(self) -> float:
        """Speed through calm, deep water at the present load [m/s]."""
        return float(self.leg_planner.ship.with_load_factor(self.load_factor).speeds[-1])

    def plan_leg(self, destination: Any, origin: Any = None) -> SailedLeg:
        """Return the leg for a departure at the present time.

        Parameters
        ----------
        destination, origin : geometry or object with one
            Points (lon, lat); default of the origin: the position of the vessel.

        Returns
        -------
        SailedLeg
            Route, waits, departure and arrival at the present load factor.

        Raises
        ------
        NoRouteError, CoverageError
            If there is no route, or the data do not cover it.
        """
        here = _position(self.geometry if origin is None else origin)
        there = _position(destination)
        return self.leg_planner.sail(
            here, there, depart=float(self.env.now), load_factor=self.load_factor
        )

    def compute_distance(self, origin: Any, destination: Any) -> float:
        """Return the length of the route for a departure at the present time.

        Parameters
        ----------
        origin, destination : geometry or object with one
            Points (lon, lat) [deg].

        Returns
        -------
        float
            Length [m]; 0 if both are the same position.
        """
        if _same_position(origin, destination):
            return 0.0
        return self.plan_leg(destination, origin).distance

    def compute_duration(self, origin: Any, destination: Any, engine_order: float = 1.0) -> float:
        """Return the duration for a departure at the present time, waits included.

        Parameters
        ----------
        origin, destination : geometry or object with one
            Points (lon, lat) [deg].
        engine_order : float
            1; no other order is possible.

        Returns
        -------
        float
            Duration [s]; 0 if both are the same position.

        Raises
        ------
        InputError
            For an engine order other than 1.
        """
        _check_order(engine_order)
        return (
            0.0
            if _same_position(origin, destination)
            else self.plan_leg(destination, origin).duration
        )

    def move(
        self, destination: Any = None, duration: float | None = None, engine_order: Any = None
    ) -> Generator[Any, Any, None]:
        """Sail to a destination along a route planned for the present time, as a SimPy process.

        Parameters
        ----------
        destination : object with a geometry, optional
            A point (lon, lat) [deg].
        duration : float, optional
            Time that the move takes [s]; no route is planned then, as in OpenCLSim.
        engine_order : float, optional
            1; no other order is possible.

        Returns
        -------
        generator
            A SimPy process; it appends the leg to ``legs``.

        Raises
        ------
        InputError
            For an engine order other than 1.
        NoRouteError, CoverageError
            If there is no route, or the data do not cover it.
        """
        _check_order(1.0 if engine_order is None else engine_order)
        if destination is None or duration is not None or _same_position(self, destination):
            yield from super().move(destination, duration=duration or 0.0)
            return
        leg = self.plan_leg(destination)
        self.log_entry_v1(self.env.now, self.activity_id, LogState.START)
        for begin, length, place in _waits(leg):
            yield self.env.timeout(max(0.0, begin - self.env.now), value=self.activity_id)
            self.geometry = place
            self.log_entry_v1(self.env.now, self.activity_id, LogState.WAIT_START)
            yield self.env.timeout(length, value=self.activity_id)
            self.log_entry_v1(self.env.now, self.activity_id, LogState.WAIT_STOP)
        yield self.env.timeout(max(0.0, leg.arrive - self.env.now), value=self.activity_id)
        self.geometry = shape(destination.geometry)
        self.legs.append(leg)
        self.log_entry_v1(
            self.env.now, self.activity_id, LogState.STOP, additional_state=_leg_summary(leg)
        )


def _waits(leg: SailedLeg) -> list[tuple[float, float, Point]]:
    """Return (begin, length, place) of every wait on a leg."""
    track, arrive = leg.route.track, leg.route.legs["arrive"]
    return [
        (
            leg.depart if k == 0 else float(arrive[k - 1]),
            float(track.wait[k]),
            Point(float(track.lon[k]), float(track.lat[k])),
        )
        for k in np.flatnonzero(track.wait)
    ]


def _leg_summary(leg: SailedLeg) -> dict[str, float | None]:
    facts = {
        "distance_m": leg.distance,
        "waiting_s": leg.waiting,
        "least_clearance_m": leg.clearance,
        "least_clearance_with_squat_m": leg.clearance_with_squat,
        "energy_j": leg.energy,
        "fuel_kg": leg.fuel,
    }
    return {key: finite_or_none(value) for key, value in facts.items()}


def _position(place: Any) -> Position:
    """Return (lat, lon) of a point geometry, or of an object that has one."""
    point = shape(getattr(place, "geometry", place))
    return float(point.y), float(point.x)


def _same_position(origin: Any, destination: Any) -> bool:
    return bool(np.allclose(_position(origin), _position(destination), rtol=0.0, atol=1e-9))


def _check_order(engine_order: float) -> None:
    if engine_order != 1.0:
        raise InputError(
            f"The engine order is {engine_order!r}.",
            "A vessel on planned routes sails at the highest setting of its ship.",
            "Omit the engine order, and give the ship other speeds (Ship.with_speeds).",
        )
