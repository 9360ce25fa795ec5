"""Recognise the variables of a dataset: by mapping, CF standard name or known name.

A variable that is ambiguous is an error; nothing is guessed.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from thalweg.core.errors import DatasetError, InputError, close_matches
from thalweg.sea import standard_names as nm
from thalweg.sea.files import unit_conversion, variable_aliases
from thalweg.sea.files.time_coordinates import time_coordinate
from thalweg.sea.files.vertical_levels import wind_height_fault

_ORIGIN_TEXT = re.compile(
    r"\b(coming|comes?|blow(s|ing)|arriv(es?|ing)|propagat(es?|ing)|travel(s|l?ing)) from\b"
    r"|\bfrom which\b|\bdirections? from\b|\bfrom[- _]direction|\(from\)|meteorological convention"
)
_TOWARDS_TEXT = re.compile(
    r"\b(going|goes|mov(es?|ing)|blow(s|ing)|flow(s|ing)|head(s|ing)|propagat(es?|ing|ion)"
    r"|travel(s|l?ing)) to(wards?)?\b|\bto(wards?)? which\b|\bdirections? to(wards?)?\b"
    r"|\bto[- _]direction|\(to(wards?)?\)|oceanographic convention"
)
_SAMPLES = 100_000  #: values that are read to distinguish radians from degrees
_BRACKETED_UNIT = re.compile(r"\[([^\[\]]+)\]\s*$")


@dataclass(frozen=True)
class AssignedVariable:
    """A variable of a file and the role it has.

    Attributes
    ----------
    role : Its role (see `thalweg.sea.files.variable_aliases`).
    variable : Its name in the file.
    factor : To SI (degrees for directions).
    units : As spelled in the file.
    how : How it was recognised.
    """

    role: str
    variable: str
    factor: float
    units: str
    how: str


@dataclass(frozen=True)
class IgnoredVariable:
    """A variable of a file that is not used.

    Attributes
    ----------
    variable : Its name.
    reason : Why not.
    """

    variable: str
    reason: str


@dataclass(frozen=True)
class RoleCandidate:
    """A variable that may have a role.

    Attributes
    ----------
    variable : Its name.
    rank : 0 by standard name, 1 by a second-choice standard name, 2 by a known name.
    origin, place : The source that uses its name, and its rank of preference there.
    how : How it was recognised.
    """

    variable: str
    rank: int
    origin: str
    place: int
    how: str


def recognise_variables(
    dataset: Any, *, mapping: Mapping[str, str], source: str, skip: frozenset[str]
) -> tuple[dict[str, AssignedVariable], list[IgnoredVariable]]:
    """Return the variable for each role in a dataset, and the variables ignored with the reason.

    Parameters
    ----------
    dataset : The file.
    mapping : Given by the user: canonical name (or role) to name in the file.
    source : File name for messages.
    skip : Coordinates and other variables that carry no field.

    Raises
    ------
    DatasetError : If two variables have the same role and no rule decides between them, or a unit
        does not fit the role.
    """
    fields = [str(n) for n in dataset.data_vars if str(n) not in skip and dataset[n].ndim > 0]
    fields = [n for n in fields if dataset[n].dtype.kind in "fiu"]
    mapped = _mapped_roles(dataset, mapping)
    candidates: dict[str, list[RoleCandidate]] = {}
    ignored: list[IgnoredVariable] = []
    for name in fields:
        if name in mapped.values():
            continue
        found = _role_candidate(dataset, name)
        if isinstance(found, tuple) and "wind" in found[0]:
            fault = wind_height_fault(dataset, dataset[name])
            found = IgnoredVariable(name, fault) if fault else found
        if isinstance(found, IgnoredVariable):
            ignored.append(found)
        elif found[0] not in mapped:
            candidates.setdefault(found[0], []).append(found[1])
    chosen = {
        role: _assign_with_unit(dataset, role, name, "mapping", source)
        for role, name in mapped.items()
    }
    for role, several in candidates.items():
        best = _best_candidate(several, role, dataset, source)
        if best.how.startswith("standard_name"):
            _check_direction_text(role, dataset[best.variable], source)
        taken = _assign_with_unit(dataset, role, best.variable, best.how, source)
        if isinstance(taken, AssignedVariable):
            chosen[role] = taken
        else:
            ignored.append(taken)
        ignored += [
            IgnoredVariable(c.variable, f"{best.variable} is preferred as {role}")
            for c in several
            if c is not best
        ]
    return {role: c for role, c in chosen.items() if isinstance(c, AssignedVariable)}, ignored


def _mapped_roles(dataset: Any, mapping: Mapping[str, str]) -> dict[str, str]:
    """Return role to file variable for the mapped variables that this file has."""
    return {_role_for(name): variable for name, variable in mapping.items() if variable in dataset}


def _role_for(name: str) -> str:
    canonical = nm.canonical_name(name)
    if canonical in variable_aliases.ROLES:
        return canonical
    role = variable_aliases.role_of_standard_name(name)
    return role[0] if role else name


def check_mapping(mapping: Mapping[str, str], present: frozenset[str]) -> None:
    """Raise `InputError` if the mapping names a variable that is in none of the files.

    Parameters
    ----------
    mapping : Canonical name to name in the file.
    """
    for name, variable in mapping.items():
        if name != "crs" and variable not in present:
            near = close_matches(variable, present)
            raise InputError(
                f"The mapping takes {name!r} from {variable!r}, which is in none of the files.",
                f"They hold: {', '.join(sorted(present))}.",
                f"Did you mean {' or '.join(map(repr, near))}?" if near else "Check the name.",
                field=name,
                value=variable,
            )


def _role_candidate(dataset: Any, name: str) -> tuple[str, RoleCandidate] | IgnoredVariable:
    """Return the role a variable may have, or the reason why it has none."""
    array = dataset[name]
    standard = "_".join(str(array.attrs.get("standard_name", "")).lower().split())
    spelled = variable_aliases.role_of_alias(name)
    if name.lower() in variable_aliases.UNUSED_VARIABLES:
        return IgnoredVariable(name, variable_aliases.UNUSED_VARIABLES[name.lower()])
    if standard and standard != "unknown":
        role = variable_aliases.role_of_standard_name(standard)
        if role is None:
            return IgnoredVariable(name, f"standard_name {standard!r} is not one that is used")
        origin, place = (
            ("", 0) if not spelled or spelled[0] != role[0] else (spelled[2], spelled[1])
        )
        return role[0], RoleCandidate(name, role[1], origin, place, f"standard_name {standard}")
    named_long = variable_aliases.LONG_NAMES.get(str(array.attrs.get("long_name", "")).lower())
    if spelled is None and named_long:
        origin = variable_aliases.LONG_NAME_SOURCE
        return named_long, RoleCandidate(name, 2, origin, -1, "recognised by its long_name")
    moving = _moving_quantity(dataset, array, name)
    if moving is not None:
        return moving
    if spelled is None:
        return IgnoredVariable(name, "no standard_name, and its name is not known")
    named, how = _role_by_direction_text(spelled[0], array), f"spelled as by {spelled[2]}"
    if named != spelled[0]:
        how += f"; direction as its long_name states: {_long_name(array)!r}"
    return named, RoleCandidate(name, 2, spelled[2], spelled[1], how)


def _role_by_direction_text(role: str, array: Any) -> str:
    """Return the role of a direction: from or towards, as its long name states, else as given."""
    vector = next((v for v in nm.VECTORS if role and role in (v.origin, v.towards)), None)
    if vector is None:
        return role
    text = " ".join(str(array.attrs.get(k, "")) for k in ("long_name", "description", "comment"))
    comes, goes = _ORIGIN_TEXT.search(text.lower()), _TOWARDS_TEXT.search(text.lower())
    if bool(comes) == bool(goes):
        return role
    return vector.origin if comes else vector.towards


def _check_direction_text(role: str, array: Any, source: str) -> None:
    """Raise `DatasetError` if a standard name and a long name contradict each other."""
    if _role_by_direction_text(role, array) == role:
        return
    raise DatasetError(
        f"{source}: {array.name!r} has the standard_name {array.attrs.get('standard_name')!r}, but "
        f"its long_name is {_long_name(array)!r}.",
        "One states the direction from which, the other the direction towards which.",
        "Correct the file, or name the variable as the one that it is (..._from_direction or "
        f"..._to_direction): {variable_aliases.naming_of(role, str(array.name))}.",
        variable=str(array.name),
        file=source,
    )


def _moving_quantity(
    dataset: Any, array: Any, name: str
) -> tuple[str, RoleCandidate] | IgnoredVariable | None:
    """Return what a name of a bed or depth means if it varies in time; None if it does not."""
    lower = name.lower()
    clock = time_coordinate(dataset, array)
    if lower == "elevation" and clock is not None and clock.dims[0] in array.dims:
        how = f"spelled {name}, and has times: level of the surface"
        return nm.WATER_LEVEL, RoleCandidate(name, 2, "", 0, how)
    if not _varies_in_time(dataset, array):
        return None
    if lower in variable_aliases.TIME_VARYING_DEPTHS:
        how = f"spelled {name}, and varies in time: depth below the moving surface"
        return nm.TOTAL_DEPTH, RoleCandidate(name, 2, "", 0, how)
    if lower in variable_aliases.STATIC_BEDS:
        return IgnoredVariable(name, "it varies in time: not the bed, and its name is ambiguous")
    return None


def _varies_in_time(dataset: Any, array: Any) -> bool:
    clock = time_coordinate(dataset, array)
    return clock is not None and array.sizes.get(clock.dims[0], 1) > 1


def _best_candidate(
    several: list[RoleCandidate], role: str, dataset: Any, source: str
) -> RoleCandidate:
    """Return the candidate of best rank; of equal ranks, the first in its source's order.

    Standard names have priority over known names. Among candidates of equal rank there is an order
    only if all are names of one source (CMEMS's total currents before its partial ones, nodes of
    a mesh before faces).
    """
    least = min(c.rank for c in several)
    tied = sorted((c for c in several if c.rank == least), key=lambda c: c.place)
    if len(tied) == 1 or (tied[0].origin and len({c.origin for c in tied}) == 1):
        return tied[0]
    raise DatasetError(
        f"{source}: {role} could be any of {', '.join(c.variable for c in tied)}.",
        "The file does not state which one to use: "
        + "; ".join(f"{c.variable}: {_long_name(dataset[c.variable])}" for c in tied)
        + ".",
        f"Choose one: {variable_aliases.naming_of(role, tied[0].variable)}.",
        variable=role,
        candidates=[c.variable for c in tied],
        file=source,
    )


def _long_name(array: Any) -> str:
    return str(array.attrs.get("long_name") or array.attrs.get("standard_name") or "no long_name")


def _assign_with_unit(
    dataset: Any, role: str, name: str, how: str, source: str
) -> AssignedVariable | IgnoredVariable:
    """Return the variable with its factor to SI; raise if its unit does not fit the role."""
    attributes = dataset[name].attrs
    unit = str(attributes.get("units", "")).strip()
    if unit_conversion.is_unspecified(unit):
        bracketed = _BRACKETED_UNIT.search(str(attributes.get("long_name", "")))
        unit = bracketed[1] if bracketed else ""
    dimension = variable_aliases.ROLE_DIMENSIONS.get(role)
    if dimension == "direction" and unit_conversion.is_unspecified(unit):
        _check_degrees(dataset[name], source)
    if (
        dimension is None
        or not unit
        or (dimension == "fraction" and unit_conversion.is_unspecified(unit))
    ):
        return AssignedVariable(role, name, 1.0, unit, how)
    factor = unit_conversion.si_factor(unit, dimension)
    if factor is not None:
        return AssignedVariable(role, name, factor, unit, how)
    if name.lower() in variable_aliases.AMBIGUOUS_ALIASES and how.startswith("spelled"):
        return IgnoredVariable(name, f"units {unit!r} are not those of {role}")
    raise DatasetError(
        f"{source}: {name!r} is recognised as {role}, but its units are {unit!r}.",
        f"Units of {dimension} are needed.",
        "Correct the units in the file, or map another variable.",
        variable=role,
        units=unit,
        file=source,
    )


def _check_degrees(array: Any, source: str) -> None:
    """Raise `DatasetError` if a direction without a unit could be in degrees or in radians."""
    stride = {d: max(1, n // 50) for d, n in array.sizes.items()} if array.size > _SAMPLES else {}
    part = array.isel({d: slice(None, None, step) for d, step in stride.items()})
    values = np.abs(np.asarray(part.values, float))
    largest = float(np.fmax.reduce(values, axis=None, initial=0.0))
    if 0.0 < largest <= 2.0 * np.pi + 0.01:
        raise DatasetError(
            f"{source}: the direction {str(array.name)!r} has no units, and its values are between "
            f"0 and {largest:g}.",
            "They could be radians or degrees.",
            "Add the attribute units to the file: 'degree' or 'radian'.",
            variable=str(array.name),
            file=source,
        )
