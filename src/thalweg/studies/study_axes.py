"""Values of the axes of a study, and draws of its sample."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Mapping
from typing import Any, Final

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.time import format_time, parse_time
from thalweg.core.units import HOUR
from thalweg.sea.fill_policies import check_fill

MOST_ROWS: Final = 2_000_000  #: of one study
_TIMES: Final = ("depart", "arrive", "arrive_by")  # entries that are times


def axis_values(name: str, given: Any) -> list[Any]:
    """Return the values of an axis: a list, or a range with from, to and step."""
    if isinstance(given, Mapping) and {"from", "to"} <= set(given):
        return _range(name, given)
    values = given if isinstance(given, list) else [given]
    if not values:
        raise InputError(
            f"The axis {name} has no values.",
            "It is a list, or a range with from, to and step.",
            "Add values.",
            field=name,
        )
    return [plain_data(value) for value in values]


def _range(name: str, given: Mapping[str, Any]) -> list[Any]:
    low, high = given["from"], given["to"]
    if "step_h" in given:
        first, last = parse_time(low), parse_time(high)
        step = float(given["step_h"]) * HOUR
        if not (step > 0.0 and last >= first):
            raise _range_error(name, given)
        count = _count(name, (last - first) / step)
        return [format_time(first + k * step) for k in range(count)]
    step = given.get("step", 1)
    numbers = all(isinstance(value, (int, float)) for value in (low, high, step))
    if not (numbers and step > 0 and high >= low):
        raise _range_error(name, given)
    count = _count(name, (high - low) / step)
    return [low + k * step for k in range(count)]


def _count(name: str, steps: float) -> int:
    """Return the number of values of a range."""
    if steps >= MOST_ROWS:
        raise InputError(
            f"The range of {name} has {steps:,.0f} values.",
            f"At most {MOST_ROWS:,} voyages are run in one study.",
            "Use a larger step.",
            field=name,
        )
    return int(steps + 1e-9) + 1


def _range_error(name: str, given: Mapping[str, Any]) -> InputError:
    return InputError(
        f"The range of {name} is {', '.join(f'{key} {value}' for key, value in given.items())}.",
        "A range of times has from, to and step_h; a range of numbers from, to and step, with to "
        "not below from.",
        "Correct it.",
        field=name,
    )


def sample_draws(sample: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Return the draws of a sample; each entry has its own stream of random numbers."""
    count = int(sample.get("count", 1))
    columns: dict[str, list[Any]] = {}
    for name, distribution in sample.items():
        if name in ("count", "seed"):
            continue
        key = int.from_bytes(hashlib.blake2b(name.encode(), digest_size=8).digest(), "big")
        generator = np.random.default_rng([int(sample.get("seed", 0)), key])
        ((kind, values),) = distribution.items()
        if kind == "choice":
            picked = generator.integers(len(values), size=count)
            columns[name] = [values[k] for k in picked]
            continue
        draw = getattr(generator, kind)(*distribution_numbers(name, distribution), size=count)
        columns[name] = [format_time(round(x)) if name in _TIMES else float(x) for x in draw]
    return [dict(zip(columns, values)) for values in zip(*columns.values())] or [{}] * count


def distribution_numbers(name: str, distribution: Mapping[str, Any]) -> tuple[float, float]:
    """Return the two numbers of a uniform or normal distribution; times as seconds.

    Raises
    ------
    InputError
        If they are no numbers or times, the upper bound is below the lower one, or the standard
        deviation is negative.
    """
    ((kind, (first, second)),) = distribution.items()
    times, uniform = name in _TIMES, kind == "uniform"
    try:
        low = parse_time(first) if times else float(first)
        high = parse_time(second) if times and uniform else float(second)
    except (TypeError, ValueError):  # an InputError is a ValueError, too
        low = high = math.nan
    spread = high - low if uniform else high
    if not (math.isfinite(low) and 0.0 <= spread < math.inf):
        what = "times" if times else "numbers"
        deviation = "hours" if times else "a number"
        raise InputError(
            f"The distribution of {name} is {dict(distribution)!r}.",
            f"uniform has two {what}, the upper one not below the lower one; normal a mean and a "
            f"standard deviation of 0 or more ({deviation}).",
            "Correct it.",
            field=name,
        )
    return low, high * HOUR if times and not uniform else high


def plain_data(value: Any) -> Any:
    """Return YAML data as JSON data: dates become text."""
    if isinstance(value, Mapping):
        return {str(key): plain_data(part) for key, part in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain_data(part) for part in value]
    if value is None or isinstance(value, (str, int, float, bool)):
        return value
    return format_time(parse_time(value))


def fill_policies(fill: Any) -> list[tuple[str, Any]]:
    """Return what unknown values of a sea are taken as, by quantity and priority.

    Parameters
    ----------
    fill : mapping or None
        Of a quantity a value (two numbers: east and north), or several that are tried in turn.

    Returns
    -------
    list of tuple

    Raises
    ------
    InputError
        If a quantity or a value is not possible.
    """
    if not isinstance(fill, Mapping | None):
        raise InputError(
            f"fill is {fill!r}.",
            "It is a mapping of quantities to values, such as {waves: fetch_limited, wind: 0}.",
            "Correct it.",
            field="fill",
        )
    found = []
    for name, given in (fill or {}).items():
        in_turns = isinstance(given, list) and any(isinstance(one, str | list) for one in given)
        for value in given if in_turns else [given]:
            check_fill(str(name), value)
            found.append((str(name), value))
    return found
