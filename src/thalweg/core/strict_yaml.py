"""YAML files of plain data only: no tags, no references, no key given twice."""

from __future__ import annotations

import re
from itertools import pairwise
from typing import Any, Final

import yaml

from thalweg.core.errors import InputError

MAX_DEPTH = 30  #: levels of nesting; the deepest file of the documentation has six
_WHOLE_NUMBER: Final = re.compile(r"[-+]?[0-9]+")
_DIGITS: Final = re.compile(r"[0-9]+")


class StrictLoader(yaml.SafeLoader):
    """`yaml.SafeLoader` that refuses references, repeated keys and impossible values."""

    def __init__(self, stream: Any) -> None:
        super().__init__(stream)
        self._depth = 0

    def compose_node(self, parent: Any, index: Any) -> Any:
        """Refuse references, which can make a small file very large, and deep nesting."""
        if self.check_event(yaml.AliasEvent):
            event = self.peek_event()
            raise yaml.composer.ComposerError(
                None, None, "references (*name) are not allowed", event.start_mark
            )
        if self._depth >= MAX_DEPTH:
            raise yaml.composer.ComposerError(
                None, None, f"more than {MAX_DEPTH} levels are nested", self.peek_event().start_mark
            )
        self._depth += 1
        node = super().compose_node(parent, index)
        self._depth -= 1
        return node

    def construct_object(self, node: Any, deep: bool = False) -> Any:
        """Name the line of a value that cannot exist, such as 2026-99-99."""
        try:
            value = super().construct_object(node, deep=deep)
        except (ValueError, OverflowError) as problem:
            raise _value_error(node, str(problem).partition(";")[0]) from None
        if isinstance(value, int) and abs(value) >= 1 << 63:
            raise _value_error(node, "the number has too many digits")
        return value

    def construct_mapping(self, node: Any, deep: bool = False) -> Any:
        """Refuse decimal commas, and keys that are given twice."""
        _refuse_decimal_comma(node)
        seen: set[str] = set()
        for key, _ in node.value:
            word = key.value if isinstance(key.value, str) else None
            if word is not None and word in seen:
                raise yaml.constructor.ConstructorError(
                    None, None, f"the key {word[:80]!r} is given twice", key.start_mark
                )
            if word is not None:
                seen.add(word)
        return super().construct_mapping(node, deep=deep)


def _refuse_decimal_comma(node: Any) -> None:
    """Refuse ``{key: 11,8}``, which YAML reads as the key with 11 and a key 8 without a value."""
    for (key, value), (digits, nothing) in pairwise(node.value):
        if (
            nothing.value == ""
            and isinstance(value.value, str)
            and _WHOLE_NUMBER.fullmatch(value.value)
            and isinstance(digits.value, str)
            and _DIGITS.fullmatch(digits.value)
        ):
            given = f"{key.value}: {value.value},{digits.value}"
            raise yaml.constructor.ConstructorError(
                None,
                None,
                f"{given!r} has a comma, which begins the next key",
                digits.start_mark,
                f"Was a decimal comma meant? Write '{key.value}: {value.value}.{digits.value}'.",
            )


def _value_error(node: Any, why: str) -> yaml.MarkedYAMLError:
    written = str(node.value)
    shown = written if len(written) <= 40 else f"{written[:37]}..."
    return yaml.constructor.ConstructorError(
        None, None, f"{shown!r} cannot be used: {why}", node.start_mark
    )


class StrictDumper(yaml.SafeDumper):
    """`yaml.SafeDumper` that writes repeated values in full, so that `parse_yaml` can read them."""

    def ignore_aliases(self, data: Any) -> bool:
        """Write no references."""
        return True


def dump_yaml(data: Any, *, sort_keys: bool = True) -> str:
    """Return plain data as YAML text that `parse_yaml` can read.

    Parameters
    ----------
    data : Mappings, sequences, text, numbers, booleans and None.
    sort_keys : Sort the keys of mappings.
    """
    text: str = yaml.dump(data, Dumper=StrictDumper, sort_keys=sort_keys)
    return text


def parse_yaml(text: str, kind: str, source: str) -> Any:
    """Return plain data from YAML (or JSON) text.

    Parameters
    ----------
    kind : Kind of the file in errors, such as ``voyage``.
    source : Name of the file in errors.

    Returns
    -------
    object : Mappings, lists, text, numbers, dates, true and false.

    Raises
    ------
    InputError
        For text that is not YAML, tags, references and keys that are given twice; with the line.
    """
    try:
        return yaml.load(text, Loader=StrictLoader)
    except (yaml.YAMLError, RecursionError, ValueError) as problem:
        line, what, remedy = "", str(problem)[:120], ""
        if isinstance(problem, yaml.YAMLError):
            what = "it is not YAML"
        if isinstance(problem, yaml.MarkedYAMLError):
            line = f" (line {problem.problem_mark.line + 1})" if problem.problem_mark else ""
            what, remedy = problem.problem or what, problem.note or ""
        raise InputError(
            f"The {kind} file {source} cannot be read{line}: {what}.",
            f"{kind.capitalize()} files are YAML: 'key: value' lines, sections indented by spaces.",
            remedy or ("Correct that line." if line else "Correct it."),
            file=source,
        ) from None
