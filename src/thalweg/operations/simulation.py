"""Simulating a project: cycle after cycle, each with the load that produces most."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from thalweg.core.errors import OutsidePeriodError
from thalweg.core.time import format_time
from thalweg.operations.cycles import Cycle, Leg, leg_energy
from thalweg.operations.project_world import Loaded, Tell, Ways, World
from thalweg.route import Route, Track, evaluate
from thalweg.search import Passage, Passages

FloatArray = NDArray[np.float64]

#: Depth added for a leg while the referee finds a limit broken between the nodes [m].
CAREFUL = (0.0, 0.05, 0.2, 0.5)
LARGEST_STEP = 600.0  #: twice the referee's coarser step at most [m]
_ASIDE = 0.5  # nodes so near the line between their neighbours are no waypoints [m]
_METRES = 111_000.0  # of a degree
_LEAST = 1e-6  # share of a hopper that is still worth a cycle


@dataclass(frozen=True, eq=False)
class Both:
    """The passages of one load: from the loading site with it, and back empty."""

    load_factor: float
    full: Passages
    empty: Passages
    lasted: dict[str, float] = field(default_factory=dict)

    def sail(self, which: str, depart: float, arrive_by: float) -> Passage:
        """Search a passage, "full" or "empty"; the last one's time is the first guess."""
        passages: Passages = getattr(self, which)
        guess = self.lasted.get(which, math.inf)
        found = passages.sail(depart, known=depart + 1.15 * guess + 300.0, arrive_by=arrive_by)
        if found.found:
            self.lasted[which] = found.arrive - depart
        return found


class Option(NamedTuple):
    """One load for the next cycle, and the most it could produce [m3/s]."""

    bound: float
    volume: float
    share: float
    both: Both


class Choice(NamedTuple):
    """A load that was looked at: production [m3/s], its option, the passage with it."""

    production: float
    option: Option
    full: Passage


class Simulator:
    """Sails a project cycle by cycle over one set of ways.

    Parameters
    ----------
    world : World
    ways : Ways
    factors : sequence of float
        Loads to choose from.
    tell : callable
        Called with a short text now and then.
    """

    def __init__(self, world: World, ways: Ways, factors: Sequence[float], tell: Tell) -> None:
        self.world, self.ways, self.tell = world, ways, tell
        self.loads: dict[float, Loaded] = {}
        empty = self._loaded(0.0)
        back = ways.passages(empty, full=False)
        self.both = [
            Both(x, ways.passages(self._loaded(x), full=True), replace(back))
            for x in sorted(set(factors))
            if x > 0.0
        ]
        self._careful: dict[tuple[float, bool, float], Passages] = {}
        self.step = 0.5 * min(ways.network.meta.spacing_m, LARGEST_STEP)
        self.workers = max(1, min(os.cpu_count() or 1, len(self.both)))

    @property
    def possible(self) -> list[float]:
        """Loads that have a way at some tide."""
        return [
            b.load_factor for b in self.both if max(b.full.shortest, b.empty.shortest) < math.inf
        ]

    def run(self) -> list[Cycle]:
        """Sail until the volume is moved.

        Raises
        ------
        OutsidePeriodError
            If it is not moved by the end of the period looked at.
        """
        work, project = self.world.project.work, self.world.project
        cycles: list[Cycle] = []
        time, left = project.start, work.volume
        with ThreadPoolExecutor(self.workers) as pool:
            while left > _LEAST * work.hopper:
                choice = self._choose(pool, time, left)
                cycle = None if choice is None else self._sail(len(cycles) + 1, time, choice)
                if cycle is None:
                    raise self._too_short(work.volume - left, time)
                cycles.append(cycle)
                time, left = cycle.end, left - cycle.volume
                if len(cycles) % 10 == 0:
                    self.tell(f"{len(cycles)} cycles, {work.volume - left:,.0f} m3 moved")
        return cycles

    def _options(self, left: float) -> list[Option]:
        """Return the loads for the next cycle, the most promising first."""
        work = self.world.project.work
        found = []
        for both in self.both:
            volume = min(left, both.load_factor * work.hopper)
            share = volume / work.hopper
            fastest = both.full.shortest + both.empty.shortest
            fastest += work.loading.time(share) + work.unloading.time(share)
            if fastest < math.inf:
                found.append(Option(volume / fastest, volume, share, both))
        # of loads that all hold what is left, the lightest
        enough = [o for o in found if o.volume >= left]
        found = [o for o in found if o.volume < left] + enough[:1]
        return sorted(found, key=lambda o: -o.bound)

    def _choose(self, pool: ThreadPoolExecutor, time: float, left: float) -> Choice | None:
        """Return the load with the highest production of its whole cycle."""
        best: Choice | None = None
        for lot in _lots(self._options(left), self.workers):
            least = 0.0 if best is None else best.production
            live = [option for option in lot if option.bound > least]
            count = len(live)
            for choice in pool.map(self._look, [time] * count, live, [least] * count):
                if choice is not None and (best is None or choice.production > best.production):
                    best = choice
        return best

    def _look(self, time: float, option: Option, least: float) -> Choice | None:
        """Search a cycle; None if it does not produce more than ``least`` [m3/s]."""
        work, both = self.world.project.work, option.both
        longest = option.volume / least if least > 0.0 else math.inf
        unloading = work.unloading.time(option.share)
        depart = time + work.loading.time(option.share)
        by = time + longest - unloading - both.empty.shortest
        full = both.sail("full", depart, by)
        if not full.found:
            return None
        empty = both.sail("empty", full.arrive + unloading, time + longest)
        if not empty.found:
            return None
        return Choice(option.volume / (empty.arrive - time), option, full)

    def _sail(self, number: int, time: float, choice: Choice) -> Cycle | None:
        """Let the referee sail both legs of a cycle; None if the data end before."""
        work, option = self.world.project.work, choice.option
        loading, unloading = work.loading.time(option.share), work.unloading.time(option.share)
        load_factor = option.both.load_factor
        out = self._leg(load_factor, time + loading, choice.full)
        if out is None:
            return None
        back = self._leg(0.0, out.arrive + unloading, None)
        if back is None:
            return None
        return Cycle(
            number=number,
            start=time,
            load_factor=load_factor,
            volume=option.volume,
            loading=loading,
            unloading=unloading,
            out=out,
            back=back,
        )

    def _leg(self, load_factor: float, depart: float, passage: Passage | None) -> Leg | None:
        """Sail one leg in fine steps; with more water planned for, while a limit is broken."""
        world, loaded = self.world, self._loaded(load_factor)
        best: Route | None = None
        for extra in CAREFUL:
            if passage is None:
                passage = self._again(load_factor, extra).sail(depart)
            if passage.found:
                route = evaluate(
                    _track(self.ways, passage, loaded.setting),
                    ship=loaded.ship,
                    sea=world.sea,
                    chart=world.chart,
                    min_ukc=world.project.sites.min_ukc,
                    step=self.step,
                    strict=False,
                )
                best = route if best is None or route.feasible else best
                if route.feasible:
                    break
            passage = None
        if best is None or not math.isfinite(best.arrive):
            return None
        return Leg(best, leg_energy(best, loaded.ship))

    def _again(self, load_factor: float, extra: float) -> Passages:
        full = load_factor > 0.0
        key = (load_factor, full, extra)
        if key not in self._careful:
            loaded = self._loaded(load_factor)
            self._careful[key] = self.ways.passages(loaded, full=full, extra_depth=extra)
        return self._careful[key]

    def _loaded(self, load_factor: float) -> Loaded:
        if load_factor not in self.loads:
            self.loads[load_factor] = self.world.loaded(load_factor)
        return self.loads[load_factor]

    def _too_short(self, moved: float, time: float) -> OutsidePeriodError:
        project = self.world.project
        return OutsidePeriodError(
            f"By {format_time(project.end)} only {moved:,.0f} of {project.work.volume:,.0f} m3 "
            "can be moved.",
            f"The last cycle that is sailed out ends {format_time(time)}.",
            "Give more days (and data for them), or a smaller volume.",
            moved_m3=moved,
        )


def _lots(options: list[Option], size: int) -> Iterator[list[Option]]:
    for first in range(0, len(options), size):
        yield options[first : first + size]


def _track(ways: Ways, passage: Passage, setting: int) -> Track:
    """Return the track of a passage; waits below a second are none."""
    wait = np.maximum(0.0, passage.node_depart - passage.node_arrive)
    wait[-1] = 0.0
    wait = np.where(wait < 1.0, 0.0, wait)
    network = ways.network
    lat, lon = network.lat[passage.nodes], network.lon[passage.nodes]
    keep = _corners(lat, lon) | (wait > 0.0)
    count = int(keep.sum())
    return Track(lat[keep], lon[keep], passage.depart, wait[keep], np.full(count - 1, setting))


def _corners(lat: FloatArray, lon: FloatArray) -> NDArray[np.bool_]:
    """Return which nodes of a way are needed so that it stays within `_ASIDE` of all of them."""
    scale = math.cos(math.radians(float(lat.mean())))
    x, y = _METRES * scale * (lon - lon[0]), _METRES * (lat - lat[0])
    keep = np.zeros(len(lat), bool)
    keep[[0, -1]] = True
    first = 0
    for last in range(2, len(lat)):
        inside = slice(first + 1, last)
        dx, dy = x[last] - x[first], y[last] - y[first]
        aside = np.abs(dx * (y[inside] - y[first]) - dy * (x[inside] - x[first]))
        if aside.max() > _ASIDE * math.hypot(dx, dy):
            first = last - 1
            keep[first] = True
    return keep
