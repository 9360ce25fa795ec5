"""Legs that keep every limit in the small steps of the referee, planned again if needed."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from thalweg.core.geodesy import MEAN_RADIUS
from thalweg.core.limits import TIGHTENING
from thalweg.core.types import FloatArray
from thalweg.network.conformal_projection import conformal_unit_vectors
from thalweg.operations.dredging.cycle_records import SailedLeg, leg_energy
from thalweg.operations.dredging.project_environment import (
    LoadedShip,
    ProjectEnvironment,
    SiteNetwork,
)
from thalweg.planning.report.squat_report import least_water_with_squat
from thalweg.route import Route, Track, evaluate
from thalweg.route.referee.limit_checks import is_data_gap
from thalweg.search import ProfileSearch, TimedPath

LARGEST_STEP = 600.0  #: twice the longest step of the referee [m]
_CROSS_TRACK_TOLERANCE = 0.5  # nodes nearer to the line between waypoints are left out [m]


class SiteLegPlanner:
    """Plans legs on one network and evaluates them with the referee."""

    def __init__(self, environment: ProjectEnvironment, site_network: SiteNetwork) -> None:
        self.environment, self.site_network = environment, site_network
        self.step = 0.5 * min(site_network.network.meta.spacing_m, LARGEST_STEP)
        self._loaded: dict[float, LoadedShip] = {}
        self._searches: dict[tuple[float, bool, int], ProfileSearch] = {}
        #: The greatest step of `TIGHTENING` at which a leg was sailed that kept every limit.
        self.step_needed = 0

    def loaded(self, load_factor: float) -> LoadedShip:
        """Return the ship at a load."""
        if load_factor not in self._loaded:
            self._loaded[load_factor] = self.environment.loaded(load_factor)
        return self._loaded[load_factor]

    def profile_search(self, load_factor: float, *, outward: bool, step: int = 0) -> ProfileSearch:
        """Return the search for a load to the unloading site (outward) or back.

        ``step`` is the step of `TIGHTENING`.
        """
        key = (load_factor, outward, step)
        if key not in self._searches:
            loaded = self.loaded(load_factor)
            limits = loaded.limits.tightened(TIGHTENING[step])
            self._searches[key] = self.site_network.profile_search(
                loaded, full=outward, limits=limits
            )
        return self._searches[key]

    def sail(
        self,
        load_factor: float,
        depart: float,
        *,
        outward: bool,
        path: TimedPath | None = None,
    ) -> SailedLeg | None:
        """Return one leg; with more depth required while the referee finds a limit broken.

        Parameters
        ----------
        depart : Time at which the ship is ready [s since 1970-01-01T00:00Z].
        outward : From the loading site to the unloading site, or back.
        path : The result of a search already made.

        Returns
        -------
        SailedLeg or None : None if there is no route before the data end. If no attempt keeps every
            limit, the first leg is returned; its route lists the violations.
        """
        loaded, best = self.loaded(load_factor), None
        for step in range(len(TIGHTENING)):
            if path is None:
                path = self.profile_search(load_factor, outward=outward, step=step).sail(depart)
            if path.found:
                route = self._evaluated_path(path, loaded)
                best = route if best is None or route.feasible else best
                if route.feasible:
                    self.step_needed = max(self.step_needed, step)
                    break
            path = None
        if best is None or not math.isfinite(best.arrive):
            return None
        least = least_water_with_squat(best, loaded.ship)
        return SailedLeg(best, leg_energy(best), math.nan if least is None else least.clearance)

    def _evaluated_path(self, path: TimedPath, loaded: LoadedShip) -> Route:
        """Return the route by the corners of a path; by all nodes where these leave the data."""
        route = self._evaluated_track(
            track_of_path(self.site_network, path, loaded.setting), loaded
        )
        if any(is_data_gap(violation) for violation in route.violations):
            track = track_of_path(self.site_network, path, loaded.setting, corners=False)
            return self._evaluated_track(track, loaded)
        return route

    def _evaluated_track(self, track: Track, loaded: LoadedShip) -> Route:
        environment = self.environment
        return evaluate(
            track,
            ship=loaded.ship,
            sea=environment.sea,
            chart=environment.chart,
            min_ukc=environment.min_ukc,
            step=self.step,
            strict=False,
        )


def track_of_path(
    site_network: SiteNetwork, path: TimedPath, setting: int, *, corners: bool = True
) -> Track:
    """Return the track of a path by its corners or all its nodes, without waits below 1 s."""
    network = site_network.network
    places, arrive = (network.lat[path.nodes], network.lon[path.nodes]), path.node_arrive
    track = Track.along_path(*places, arrive=arrive, depart=path.node_depart, setting=setting)
    if not corners:
        return track
    return track.kept(np.flatnonzero(_essential_nodes(*places) | (track.wait > 0.0)))


def _essential_nodes(lat: FloatArray, lon: FloatArray) -> NDArray[np.bool_]:
    """Return the nodes to keep so that the track is within `_CROSS_TRACK_TOLERANCE` of all."""
    points = conformal_unit_vectors(lat, lon)
    keep = np.zeros(len(lat), bool)
    keep[[0, -1]] = True
    first = 0
    for last in range(2, len(lat)):
        across = np.cross(points[first], points[last])  # of the great circle between them
        cross_track = MEAN_RADIUS * np.abs(points[first + 1 : last] @ across)
        if cross_track.max() > _CROSS_TRACK_TOLERANCE * float(np.linalg.norm(across)):
            first = last - 1
            keep[first] = True
    return keep
