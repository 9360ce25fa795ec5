"""Errors of a ship file in three parts, from those of its schema."""

from __future__ import annotations

import math
import reprlib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, Literal, get_args, get_origin

from annotated_types import Ge, Gt, Le
from pydantic import BaseModel, ValidationError
from pydantic.fields import FieldInfo

from thalweg.core.errors import InputError, close_matches, nearest_names, unknown_name_error
from thalweg.core.given_numbers import is_number
from thalweg.core.units import FOOT

_UNKNOWN_KEY = ("extra_forbidden", "invalid_key")
#: Sections whose keys are names of the user's own: what they hold, and an example.
_BY_NAME = {
    "places": (
        "names with distances ahead of midship [m], abaft negative",
        "{bridge: 45.0, mess: -20.0}",
    ),
    "tasks": (
        "names with keys of their own",
        "{deck work: {place: mess, max_vertical_acceleration_m_s2: 0.5}}",
    ),
}
#: Words that others use for keys, by what their letters begin with.
_OTHER_WORDS = {
    "lengthm": ("length_between_perpendiculars_m", "length_overall_m"),
    "loa": ("length_overall_m",),
    "lpp": ("length_between_perpendiculars_m",),
    "lbp": ("length_between_perpendiculars_m",),
    "lwl": ("length_waterline_m",),
    "beam": ("breadth_m",),
    "width": ("breadth_m",),
    "dwt": ("deadweight_t",),
    "mcr": ("power_kw",),
    "servicespeed": ("reference_speed_kn", "speeds_kn"),
}
_OUT_OF_RANGE = ("greater_than", "greater_than_equal", "less_than_equal")


def input_error(
    problem: ValidationError, schema: type[BaseModel], data: Any, source: str
) -> InputError:
    """Return the error of a ship file for the first fault that its schema found.

    Parameters
    ----------
    schema : The class of the whole file.
    data : As read from the file.
    source : Name of the data in the error.

    Returns
    -------
    InputError : Unknown keys come first: a misspelt key is often the cause of the other faults.
    """
    faults = problem.errors(include_url=False)
    fault = next((f for f in faults if f["type"] in _UNKNOWN_KEY), faults[0])
    kind, context = fault["type"], fault.get("ctx", {})
    keys = [part for part in fault["loc"] if isinstance(part, str)]
    if kind == "value_error" and isinstance(context["error"], InputError):
        return context["error"]
    if kind in _UNKNOWN_KEY:
        return _unknown_key_error(fault["loc"][-1], schema, fault["loc"][:-1])
    if kind == "missing":
        return InputError(
            f"The {source} has no name.", "Every ship has one.", "Add 'name: ...'.", key="name"
        )
    if kind == "no_value":
        return _no_value_error(schema, [*keys, context["key"]])
    where, value = ".".join(keys), _value_at(data, fault["loc"])
    if kind in ("model_type", "model_attributes_type", "dict_type", "mapping_type"):
        return _not_a_section_error(schema, keys, value, source)
    if kind == "literal_error":
        return unknown_name_error(where, value, _words(schema, keys))
    wanted = _range_words(schema, keys) if kind in _OUT_OF_RANGE else context.get("wanted", kind)
    most = float(context["le"]) if kind == "less_than_equal" else math.inf
    return _wrong_value_error(where, value, wanted, most)


def _unknown_key_error(
    name: Any, schema: type[BaseModel], section: Sequence[int | str]
) -> InputError:
    known = list(_section_class(schema, section).model_fields)
    place = f"'{section[0]}'" if section else "a ship file"
    near = _keys_of_other_word(str(name), known) or close_matches(str(name)[:80], known)
    remedy = f"Did you mean {' or '.join(repr(n) for n in near)}?" if near else "Leave it out."
    return InputError(
        f"{_abbreviated(name)} is not a key of {place}.",
        f"Keys are: {nearest_names(str(name)[:80], known)}.",
        remedy,
        key=str(name)[:80],
        near=near,
    )


def _keys_of_other_word(word: str, known: Sequence[str]) -> list[str]:
    """Return the known keys for which others use a word."""
    letters = "".join(letter for letter in word.casefold() if letter.isalnum())
    found = (keys for begin, keys in _OTHER_WORDS.items() if letters.startswith(begin))
    return [key for keys in found for key in keys if key in known]


def _not_a_section_error(
    schema: type[BaseModel], keys: Sequence[str], value: Any, source: str
) -> InputError:
    if keys and keys[0] in _BY_NAME and len(keys) == 1:
        return _not_names_error(keys[0], f"holds {_abbreviated(value)}")
    known = ", ".join(_section_class(schema, keys).model_fields)
    if not keys:
        return InputError(
            f"The {source} holds {_abbreviated(value)}, not keys with values.",
            f"Its keys are among: {known}.",
            "Write 'name: ...', 'hull: ...' and so on.",
        )
    return InputError(
        f"'{keys[0]}' holds {_abbreviated(value)}, not keys with values.",
        f"Its keys are among: {known}.",
        "Indent the keys under it.",
        key=keys[0],
    )


def _not_names_error(section: str, what: str) -> InputError:
    wanted, example = _BY_NAME[section]
    return InputError(
        f"'{section}' {what}.",
        f"It holds {wanted}, such as {example}.",
        "Write it so, without dashes, or leave it out.",
        key=section,
    )


def _wrong_value_error(where: str, value: Any, wanted: str, most: float) -> InputError:
    remedy = "Correct it in the ship file."
    if where.endswith("_m") and is_number(value) and most < value <= most / FOOT:
        remedy = f"Give metres; {value:g} feet are {FOOT * value:.4g} m."
    return InputError(
        f"'{where}' is {_abbreviated(value)}.",
        f"It must be {wanted}.",
        remedy,
        key=where,
    )


def _no_value_error(schema: type[BaseModel], keys: Sequence[str]) -> InputError:
    if len(keys) == 1 and keys[0] in _BY_NAME:
        return _not_names_error(keys[0], "has no value")
    wanted = _range_words(schema, keys)
    return InputError(
        f"'{'.'.join(keys)}' has no value.",
        f"It must be {wanted}." if wanted else "Every key of a ship file has a value.",
        "Give a value, or leave the key out.",
        key=".".join(keys),
    )


def _section_class(schema: type[BaseModel], keys: Sequence[int | str]) -> type[BaseModel]:
    """Return the class of a section of the file, or of the whole file for no key."""
    for key in keys:
        if str(key) not in schema.model_fields:  # the name of one of several, such as a task
            continue
        parts = _parts(schema.model_fields[str(key)].annotation)
        schema = next(p for p in parts if isinstance(p, type) and issubclass(p, BaseModel))
    return schema


def _annotation_parts(schema: type[BaseModel], keys: Sequence[str]) -> list[Any]:
    field = _section_class(schema, keys[:-1]).model_fields[keys[-1]]
    return [*field.metadata, *_parts(field.annotation)]


def _range_words(schema: type[BaseModel], keys: Sequence[str]) -> str:
    """Return the range of a key's numbers as text."""
    words = []
    for part in _annotation_parts(schema, keys):
        words += [f"greater than {part.gt:g}"] if isinstance(part, Gt) else []
        words += [f"at least {part.ge:g}"] if isinstance(part, Ge) else []
        words += [f"at most {part.le:g}"] if isinstance(part, Le) else []
    return " and ".join(words)


def _words(schema: type[BaseModel], keys: Sequence[str]) -> tuple[str, ...]:
    """Return the words that a key may have."""
    parts = _annotation_parts(schema, keys)
    return next(get_args(part) for part in parts if get_origin(part) is Literal)


def _parts(annotation: Any) -> Iterator[Any]:
    """Yield an annotation, its arguments and their metadata, at all depths."""
    yield annotation
    inner: Iterable[Any] = ()
    if isinstance(annotation, FieldInfo):
        inner = annotation.metadata
    elif get_origin(annotation) is not Literal:
        inner = get_args(annotation)
    for one in inner:
        yield from _parts(one)


def _value_at(data: Any, loc: Sequence[int | str]) -> Any:
    """Return the value in the data that an error is about, as the file gives it."""
    for part in loc:
        rows = isinstance(data, (list, tuple))
        if isinstance(part, int) and not rows:
            break  # one value where the schema takes a list
        if isinstance(part, str) and rows:  # a table given as rows
            data = [row[part] for row in data]
        else:
            data = data[part]
    return data


def _abbreviated(value: Any) -> str:
    if isinstance(value, (Mapping, list, tuple)):
        return f"a {type(value).__name__} of {len(value)}"
    return reprlib.repr(value)
