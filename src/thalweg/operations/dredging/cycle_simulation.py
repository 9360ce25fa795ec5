"""Simulation of a project cycle by cycle, each with the load of the highest production."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from thalweg.core.errors import OutsidePeriodError
from thalweg.core.time import format_time
from thalweg.operations.dredging.cycle_records import DredgingCycle, with_other_consumption
from thalweg.operations.dredging.project import Project
from thalweg.operations.dredging.project_environment import (
    MessageCallback,
    ProjectEnvironment,
    SiteNetwork,
)
from thalweg.operations.dredging.verified_legs import SiteLegPlanner
from thalweg.operations.dredging.work_windows import WorkWindows
from thalweg.sea import standard_names as nm
from thalweg.sea.inspection import data_gaps
from thalweg.search import ProfileSearch, TimedPath

CycleCallback = Callable[[str, DredgingCycle], None]
_MIN_VOLUME_SHARE = 1e-6  # share of a hopper below which the remaining volume is ignored


@dataclass(frozen=True, eq=False)
class RoundTrip:
    """The searches of one load: out with the load, and back empty."""

    load_factor: float
    full: ProfileSearch
    empty: ProfileSearch
    last_duration: dict[str, float] = field(default_factory=dict)

    def sail(self, which: str, depart: float, arrive_by: float) -> TimedPath:
        """Return a path, "full" or "empty"; the duration of the last one is the first guess."""
        search: ProfileSearch = getattr(self, which)
        guess = self.last_duration.get(which, math.inf)
        found = search.sail(depart, known=depart + 1.15 * guess + 300.0, arrive_by=arrive_by)
        if found.found:
            self.last_duration[which] = found.arrive - depart
        return found


class LoadOption(NamedTuple):
    """One load for the next cycle, and an upper bound of its production [m3/s]."""

    bound: float
    volume: float
    share: float
    both: RoundTrip


class LoadChoice(NamedTuple):
    """An evaluated load: production [m3/s], its option, the path with it."""

    production: float
    option: LoadOption
    full: TimedPath


class Simulator:
    """Simulates a project cycle by cycle on one network.

    Parameters
    ----------
    factors : Loads to choose from; default: those of the project. The last cycle may also take a
        lighter one of the project that holds all that is left.
    report : Called with a short text every ten cycles.
    on_cycle : Called with the name of the run and each cycle.
    name : Name of the run, for errors.
    """

    def __init__(
        self,
        project: Project,
        environment: ProjectEnvironment,
        site_network: SiteNetwork,
        *,
        factors: Sequence[float] | None = None,
        report: MessageCallback = lambda text: None,
        on_cycle: CycleCallback | None = None,
        name: str = "",
    ) -> None:
        self.project, self.report, self.name = project, report, name
        self.on_cycle = on_cycle
        self.leg_planner = SiteLegPlanner(environment, site_network)
        back = self.leg_planner.profile_search(0.0, outward=False)
        chosen = project.work.load_factors if factors is None else factors
        lighter = {x for x in project.work.load_factors if x < max(chosen)} - set(chosen)

        self.both = self._round_trips(set(chosen), back)
        self.of_last_cycle = self._round_trips(lighter, back)
        sites, period = environment.sites, environment.period
        self.at_load, self.at_unload = (
            WorkWindows.at_site(place, period, ship=environment.ship, sea=environment.sea)
            for place in (sites.load, sites.unload)
        )
        self.workers = max(1, min(os.cpu_count() or 1, len(self.both)))
        #: When cycles ended that were sailed, by start and load [s since 1970-01-01T00:00Z].
        self.sailed: dict[tuple[float, float], float] = {}

    def _round_trips(
        self, loads: Iterable[float], back: ProfileSearch, step: int = 0
    ) -> list[RoundTrip]:
        search = self.leg_planner.profile_search
        return [
            RoundTrip(x, search(x, outward=True, step=step), replace(back))
            for x in sorted(loads)
            if x > 0.0
        ]

    def verified_round_trips(self) -> dict[float, RoundTrip]:
        """Return the searches of all loads with the limits that sailed legs needed to keep all."""
        step = self.leg_planner.step_needed
        loads = [one.load_factor for one in (*self.both, *self.of_last_cycle)]
        back = self.leg_planner.profile_search(0.0, outward=False, step=step)
        return {one.load_factor: one for one in self._round_trips(loads, back, step)}

    @property
    def possible(self) -> list[float]:
        """Loads that have a route at some tide."""
        return [
            b.load_factor for b in self.both if max(b.full.shortest, b.empty.shortest) < math.inf
        ]

    def run(self, loads: Sequence[float] = ()) -> list[DredgingCycle]:
        """Return the cycles until the volume is moved.

        Parameters
        ----------
        loads : Of the cycles; without them, and after the last, those of greatest production. A run
            with given loads is a trial: `on_cycle` is not called.

        Raises
        ------
        OutsidePeriodError : If it is not moved by the end of the period.
        """
        project, work = self.project, self.project.work
        cycles: list[DredgingCycle] = []
        time, left = project.start, work.volume
        with ThreadPoolExecutor(self.workers) as pool:
            while left > _MIN_VOLUME_SHARE * work.hopper:
                given = loads[len(cycles)] if len(cycles) < len(loads) else None
                cycle = self._best_cycle(pool, len(cycles) + 1, time, left, given)
                if cycle is None:
                    raise self._too_short(work.volume - left, time)
                cycles.append(cycle)
                if self.on_cycle is not None and not loads:
                    self.on_cycle(self.name, cycle)
                time, left = cycle.end, left - cycle.volume
                if len(cycles) % 10 == 0:
                    self.report(f"{len(cycles)} cycles, {work.volume - left:,.0f} m3 moved")
        return cycles

    def _best_cycle(
        self, pool: ThreadPoolExecutor, number: int, time: float, left: float, given: float | None
    ) -> DredgingCycle | None:
        """Return the cycle of the highest production as evaluated by the referee.

        A search samples the water and may pass a narrow sill later than the ship can. Where a cycle
        ends later than its search, the other loads that produce more by theirs are sailed too.
        """
        best: DredgingCycle | None = None
        options = self.options(left)
        options = [o for o in options if o.both.load_factor == given] or options
        while True:
            least = 0.0 if best is None else best.volume / (best.end - time)
            choice = self._choose(pool, time, options, least)
            if choice is None:
                return best
            cycle = self._sail(number, time, choice)
            load_factor = choice.option.both.load_factor
            self.sailed[time, load_factor] = math.inf if cycle is None else cycle.end
            if cycle is not None and cycle.volume / (cycle.end - time) > least:
                best = cycle
            late = (
                cycle is None or cycle.end > time + choice.option.volume / choice.production + 1.0
            )
            if not late:
                return best
            options = [o for o in options if o is not choice.option]

    def options(self, left: float) -> list[LoadOption]:
        """Return the loads for the next cycle, by descending upper bound of production."""
        work = self.project.work
        options = []
        holding = [b for b in self.of_last_cycle if b.load_factor * work.hopper >= left]
        for both in sorted([*self.both, *holding], key=lambda one: one.load_factor):
            volume = min(left, both.load_factor * work.hopper)
            share = volume / work.hopper
            fastest = both.full.shortest + both.empty.shortest
            fastest += work.loading.time(share) + work.unloading.time(share)
            if fastest < math.inf:
                options.append(LoadOption(volume / fastest, volume, share, both))
        # of the loads that hold the remaining volume, the lightest
        enough = [o for o in options if o.volume >= left]
        options = [o for o in options if o.volume < left] + enough[:1]
        return sorted(options, key=lambda o: -o.bound)

    def _choose(
        self, pool: ThreadPoolExecutor, time: float, options: list[LoadOption], least: float
    ) -> LoadChoice | None:
        """Return the load of highest production by its searches; None for none above ``least``."""
        best: LoadChoice | None = None
        for lot in _batches(options, self.workers):
            least = least if best is None else best.production
            live = [option for option in lot if option.bound > least]
            count = len(live)
            for choice in pool.map(self.evaluate_option, [time] * count, live, [least] * count):
                if choice is not None and (best is None or choice.production > best.production):
                    best = choice
        return best

    def evaluate_option(self, time: float, option: LoadOption, least: float) -> LoadChoice | None:
        """Return a searched cycle; None if it does not produce more than ``least`` [m3/s]."""
        work, both = self.project.work, option.both
        longest = option.volume / least if least > 0.0 else math.inf
        unloading = work.unloading.time(option.share)
        depart = self.at_load.end(time, work.loading.time(option.share))
        if math.isinf(depart):
            return None
        by = time + longest - unloading - both.empty.shortest
        full = both.sail("full", depart, by)
        if not full.found:
            return None
        unloaded = self.at_unload.end(full.arrive, unloading)
        if math.isinf(unloaded):
            return None
        empty = both.sail("empty", unloaded, time + longest)
        if not empty.found:
            return None
        return LoadChoice(option.volume / (empty.arrive - time), option, full)

    def _sail(self, number: int, time: float, choice: LoadChoice) -> DredgingCycle | None:
        """Return a cycle with both legs evaluated by the referee; None if the data end before."""
        work, option = self.project.work, choice.option
        loading, unloading = work.loading.time(option.share), work.unloading.time(option.share)
        load_factor = option.both.load_factor
        leg_planner = self.leg_planner
        loaded = self.at_load.end(time, loading)
        out = leg_planner.sail(load_factor, loaded, outward=True, path=choice.full)
        if out is None:
            return None
        unloaded = self.at_unload.end(out.arrive, unloading)
        if math.isinf(unloaded):
            return None
        back = leg_planner.sail(0.0, unloaded, outward=False)
        if back is None:
            return None
        cycle = DredgingCycle(
            number=number,
            start=time,
            load_factor=load_factor,
            volume=option.volume,
            loading=loading,
            unloading=unloading,
            out=out,
            back=back,
            loading_pause=max(0.0, loaded - time - loading),
            unloading_pause=max(0.0, unloaded - out.arrive - unloading),
        )
        return with_other_consumption(cycle, work, leg_planner.environment.ship)

    def _too_short(self, moved: float, time: float) -> OutsidePeriodError:
        project, which = self.project, f" ({self.name})" if self.name else ""
        return OutsidePeriodError(
            f"By {format_time(project.end)} only {moved:,.0f} of {project.work.volume:,.0f} m3 "
            f"can be moved{which}.",
            f"The last complete cycle ends {format_time(time)}."
            + data_gap_text(self.leg_planner.environment, (project.start, project.end)),
            "Give more days (and data for them), or a smaller volume.",
            moved_m3=moved,
        )


def data_gap_text(environment: ProjectEnvironment, period: tuple[float, float]) -> str:
    """Return sentences on the end of the data and their gaps in a period; may be empty."""
    sea = environment.sea
    needed = {nm.CHANNEL_VARIABLES[channel] for channel in environment.needs.channels}
    ends = [r.end for r in sea.coverage() if r.end is not None and r.variable in needed]
    last = min(ends, default=math.inf)
    sentences = [f" The data end {format_time(last)}."] if last < period[1] else []
    sentences += [
        f" There are no data from {format_time(gap.after)} to {format_time(gap.before)}."
        for gap in data_gaps(sea.layers)
        if gap.before > period[0] and gap.after < period[1]
    ]
    return "".join(sentences)


def _batches(options: list[LoadOption], size: int) -> Iterator[list[LoadOption]]:
    for first in range(0, len(options), size):
        yield options[first : first + size]
