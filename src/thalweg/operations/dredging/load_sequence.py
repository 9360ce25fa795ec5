"""The loads of a whole project that move its volume in the least time.

The load of greatest production of each cycle is not the best for a project whose ship waits for the
tide: a smaller one may reach an earlier tide with the next. To be earlier with the same volume is
never worse, since the ship can wait. So the least times at which volumes are moved follow from each
other (dynamic programming over the volume).
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from thalweg.operations.dredging.cycle_records import DredgingCycle
    from thalweg.operations.dredging.cycle_simulation import LoadOption, Simulator

MOST_SEARCHES: Final = 4000  #: cycles searched for the loads of a project, at most
_STRIDES: Final = (1, 2, 5)  # of the loads: fewer for large projects
_ROUNDS: Final = 2  # in which loads are chosen
_DIGITS: Final = 6  # of shares of a hopper; volumes that agree to so many are one


@dataclass(order=True)
class _Moved:
    """Volume moved, as a number of hoppers, the least time at which it is, and by which loads."""

    hoppers: float
    time: float = field(compare=False)
    loads: tuple[float, ...] = field(compare=False, default=())


def cycles_of_least_time(
    simulator: Simulator,
    cycles: list[DredgingCycle],
    *,
    report: Callable[[str], None] = lambda text: None,
) -> list[DredgingCycle]:
    """Return the cycles with the loads that end a project first.

    Loads whose cycles end later than by their searches are chosen once more, knowing that.

    Parameters
    ----------
    simulator : After its run.
    cycles : Of that run; they are returned where no others end earlier.
    """
    best = cycles
    for _ in range(_ROUNDS):
        loads = loads_of_least_time(simulator, latest=best[-1].end, report=report)
        if not loads:
            break
        together = simulator.run(loads)
        if together[-1].end >= best[-1].end:
            continue
        best = together
        if tuple(cycle.load_factor for cycle in together) == loads:
            break
    return best


def loads_of_least_time(
    simulator: Simulator, *, latest: float, report: Callable[[str], None] = lambda text: None
) -> tuple[float, ...] | None:
    """Return the loads of all cycles with which a project ends first, by the searches of its legs.

    Cycles that were sailed before end when they did, which may be later than by their searches.

    Parameters
    ----------
    simulator : With the searches of all loads.
    latest : A known end of the project [s since 1970-01-01T00:00Z]; only earlier ones count.

    Returns
    -------
    tuple of float or None
        None where none ends earlier, or the project is too large for `MOST_SEARCHES`.
    """
    work = simulator.project.work
    shares = sorted(simulator.possible, reverse=True)
    total = round(work.volume / work.hopper, _DIGITS)
    chosen = next(
        (
            shares[::stride]
            for stride in _STRIDES
            if total / min(shares[::stride]) * len(shares[::stride]) <= MOST_SEARCHES
        ),
        None,
    )
    if chosen is None or len(chosen) < 2:
        return None
    fastest = max((o.bound for o in simulator.options(work.volume)), default=math.inf)
    report(f"{len(chosen)} loads for the whole project")
    verified = simulator.verified_round_trips()
    best: dict[float, _Moved] = {0.0: _Moved(0.0, simulator.project.start)}
    queue = [0.0]
    with ThreadPoolExecutor(simulator.workers) as pool:
        while queue:
            state = best[heapq.heappop(queue)]
            if state.hoppers >= total:
                return state.loads
            left = (total - state.hoppers) * work.hopper
            if state.time + left / fastest >= latest or _is_dominated(state, best):
                continue
            options = [
                option._replace(both=verified[option.both.load_factor])
                for option in simulator.options(left)
                if option.both.load_factor in chosen or option.volume >= left
            ]
            for option, end in zip(options, pool.map(_end_of(simulator, state.time), options)):
                moved = round(state.hoppers + option.share, _DIGITS)
                moved = total if moved > total - 10.0**-_DIGITS else moved
                if end >= min(latest, best[moved].time if moved in best else math.inf):
                    continue
                if moved not in best:
                    heapq.heappush(queue, moved)
                best[moved] = _Moved(moved, end, (*state.loads, option.both.load_factor))
    return None


def _end_of(simulator: Simulator, start: float) -> Callable[[LoadOption], float]:
    """Return when a cycle from a time on ends with a load [s]; inf without a way."""

    def end(option: LoadOption) -> float:
        sailed = simulator.sailed.get((start, option.both.load_factor))
        if sailed is not None:
            return sailed
        choice = simulator.evaluate_option(start, option, 0.0)
        return math.inf if choice is None else start + option.volume / choice.production

    return end


def _is_dominated(state: _Moved, best: dict[float, _Moved]) -> bool:
    """Return whether more is moved no later with other loads."""
    return any(
        other.time <= state.time for hoppers, other in best.items() if hoppers > state.hoppers
    )
