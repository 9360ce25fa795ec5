"""Checks of the entries of a study: names, axes that exclude each other, distributions."""

from __future__ import annotations

import itertools
import json
from collections.abc import Mapping, Sequence
from typing import Any, Final

from thalweg.chart.zones.zone_set import Zones
from thalweg.core.errors import InputError, errors_about, unknown_name_error
from thalweg.core.given_numbers import shortened_repr
from thalweg.planning.request.voyage_surroundings import check_charges, check_limits
from thalweg.planning.voyage import Voyage
from thalweg.studies.study_axes import distribution_numbers

#: Entries of a row beside those of a voyage.
SURROUNDINGS: Final = (
    "ship", "load_factor", "limits", "charges", "sea", "map", "fill", "member", "sampling", "coast",
    "depths", "areas", "traffic", "eca", "network", "resolution_nm", "detail", "track",
)  # fmt: skip
COMPARISONS: Final = ("weather_blind",)
_DISTRIBUTIONS: Final = {"uniform": 2, "normal": 2, "choice": None}


def check_entry(name: str) -> None:
    """Refuse a name that is no entry of a voyage or its surroundings, with near ones."""
    known = (*Voyage.__dataclass_fields__, *SURROUNDINGS)
    if name not in known:
        raise unknown_name_error("entry of a voyage", name, known, field=name)


def check_surroundings(entries: Mapping[str, Any]) -> None:
    """Check the limits, charges and areas of a study, as those of a single voyage are checked."""
    if entries.get("limits") is not None:
        check_limits(entries["limits"])
    if entries.get("charges") is not None:
        check_charges(entries["charges"])
    if isinstance(entries.get("areas"), Mapping):
        with errors_about("areas"):
            Zones.read(entries["areas"])


def compared_names(given: Any) -> tuple[str, ...]:
    """Return the names of comparisons, from one or a list; `InputError` for others."""
    names = [given] if isinstance(given, str) else given
    if not isinstance(names, (list, tuple)) or not all(isinstance(name, str) for name in names):
        raise InputError(
            f"compare is {shortened_repr(given)}.",
            f"It is one of {', '.join(COMPARISONS)}, or a list of them.",
            "Correct it, or leave it out.",
            field="compare",
        )
    return tuple(names)


def check_mappings(axes: Any, sample: Any) -> None:
    """Refuse axes and samples that are no mappings, and draws that are no distributions."""
    for what, value in (("axes", axes), ("sample", sample)):
        if not isinstance(value, Mapping):
            raise InputError(
                f"{what} is {value!r}.",
                "It is a mapping of entries to their values.",
                "Correct it.",
                field=what,
            )
    for name, value in sample.items():
        if name in ("count", "seed"):
            whole = isinstance(value, int) and not isinstance(value, bool)
            least = 1 if name == "count" else 0
            if not whole or value < least:
                raise InputError(
                    f"{name} of the sample is {value!r}.",
                    f"It is a whole number, {least} or more.",
                    "Correct it.",
                )
        elif not _is_distribution(value):
            raise InputError(
                f"The distribution of {name} is {value!r}.",
                "It is {uniform: [low, high]}, {normal: [mean, standard deviation]} or "
                "{choice: [values]}.",
                "Give one of these.",
                field=name,
            )
        elif "choice" not in value:
            distribution_numbers(name, value)


def _is_distribution(value: Any) -> bool:
    if not isinstance(value, Mapping) or len(value) != 1:
        return False
    ((kind, numbers),) = value.items()
    if kind not in _DISTRIBUTIONS or not isinstance(numbers, list) or not numbers:
        return False
    return _DISTRIBUTIONS[kind] in (None, len(numbers))


def canonical_json(value: Any) -> str:
    """Return JSON that is the same for equal data; `InputError` for NaN and infinity."""
    try:
        return json.dumps(value, sort_keys=True, separators=(",", ":"), allow_nan=False)
    except ValueError:
        raise InputError(
            "A value of the study is .nan or .inf.", "Values are finite.", "Correct it."
        ) from None


def entries_of_value(axis: str, value: Any) -> dict[str, Any]:
    """Return the entries of a request that a value of an axis sets."""
    if isinstance(value, Mapping):
        return {key: part for key, part in value.items() if key != "name"}
    return {axis: value}


def label_of_value(axis: str, value: Any) -> Any:
    """Return what stands for a value of an axis in tables."""
    if isinstance(value, Mapping):
        return value.get("name") or canonical_json(entries_of_value(axis, value))
    return value


def check_axes(axes: Mapping[str, Sequence[Any]], sample: Mapping[str, Any]) -> None:
    """Refuse axes and draws that set the same entry, and values of one axis with the same name.

    Raises
    ------
    InputError
        With the two axes, or the name.
    """
    keys = {
        f"the axis {axis}": {key for value in values for key in entries_of_value(axis, value)}
        for axis, values in axes.items()
    }
    drawn = {name for name in sample if name not in ("count", "seed")}
    for (one, first), (other, second) in itertools.combinations(
        [*keys.items(), ("the sample", drawn)], 2
    ):
        for key in sorted(first & second):
            raise InputError(
                f"Both {one} and {other} set {key}.",
                "One value of it would hide the other: an entry is set by one axis.",
                f"Take {key} out of one of them, or combine them in one axis of named values.",
                field=key,
            )
    for axis, values in axes.items():
        known: dict[str, Any] = {}
        for value in values:
            name = str(label_of_value(axis, value)) if isinstance(value, Mapping) else str(value)
            if known.setdefault(name, value) != value:
                raise InputError(
                    f"Two values of the axis {axis} have the name {name!r}.",
                    "Tables tell the values of an axis apart by their names.",
                    "Give each value a name of its own.",
                    field=axis,
                )
