"""A sea whose unknown values are filled by several policies of one quantity, in turns."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

from thalweg.sea.fill_policies import FETCH_LIMITED

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.sea import Sea


#: Of a fill: a number, the parts of a vector (east, north) [m/s], or the name of a policy.
FillValue: TypeAlias = float | tuple[float, float] | str


def filled_in_turns(
    sea: Sea, policies: Sequence[tuple[str, FillValue]], chart: Chart | None = None
) -> Sea:
    """Return a sea filled with policies; of one quantity the first is tried first.

    Parameters
    ----------
    policies : Quantity and value (see `thalweg.sea.Sea.filled`), by priority.
    chart : Its coast gives the fetch of ``waves`` that are ``fetch_limited``.

    Raises
    ------
    InputError : If a value is impossible.
    """
    turns: list[dict[str, Any]] = []
    for name, value in policies:
        turn = next((t for t in turns if name not in t), None)
        if turn is None:
            turns.append(turn := {})
        turn[name] = value
    for turn in turns:
        if turn.get("waves") == FETCH_LIMITED and chart is not None:
            from thalweg.chart.coastal_fetch import CoastalFetch

            turn["waves"] = CoastalFetch(chart)
        sea = sea.filled(**turn)
    return sea
