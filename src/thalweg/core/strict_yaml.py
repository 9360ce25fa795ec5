"""YAML files of plain data only: no tags, no references, no key given twice."""

from __future__ import annotations

from typing import Any

import yaml

from thalweg.core.errors import InputError


class StrictLoader(yaml.SafeLoader):
    """`yaml.SafeLoader` that refuses references and repeated keys."""

    def compose_node(self, parent: Any, index: Any) -> Any:
        """Refuse references, which can blow a small file up."""
        if self.check_event(yaml.AliasEvent):
            event = self.peek_event()
            raise yaml.composer.ComposerError(
                None, None, "references (*name) are not allowed", event.start_mark
            )
        return super().compose_node(parent, index)

    def construct_mapping(self, node: Any, deep: bool = False) -> Any:
        """Refuse keys that are given twice."""
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


class StrictDumper(yaml.SafeDumper):
    """`yaml.SafeDumper` that writes repeated values in full, so that `parse_yaml` can read them."""

    def ignore_aliases(self, data: Any) -> bool:
        """Write no references."""
        return True


def dump_yaml(data: Any, *, sort_keys: bool = True) -> str:
    """Return plain data as YAML text that `parse_yaml` can read.

    Parameters
    ----------
    data : object
        Mappings, sequences, text, numbers, booleans and None.
    sort_keys : bool, optional
        Sort the keys of mappings.

    Returns
    -------
    str
        YAML text.
    """
    text: str = yaml.dump(data, Dumper=StrictDumper, sort_keys=sort_keys)
    return text


def parse_yaml(text: str, kind: str, source: str) -> Any:
    """Return plain data from YAML (or JSON) text.

    Parameters
    ----------
    text : str
    kind : str
        Kind of the file in errors, such as ``voyage``.
    source : str
        Name of the file in errors.

    Returns
    -------
    object
        Mappings, lists, text, numbers, dates, true and false.

    Raises
    ------
    InputError
        For text that is not YAML, tags, references and keys that are given twice; with the line.
    """
    try:
        return yaml.load(text, Loader=StrictLoader)
    except yaml.YAMLError as problem:
        mark = problem.problem_mark if isinstance(problem, yaml.MarkedYAMLError) else None
        what = problem.problem if isinstance(problem, yaml.MarkedYAMLError) else None
        line = f" (line {mark.line + 1})" if mark else ""
        raise InputError(
            f"The {kind} file {source} cannot be read{line}: {what or 'it is not YAML'}.",
            f"{kind.capitalize()} files are YAML: 'key: value' lines, sections indented by spaces.",
            "Correct that line.",
            file=source,
        ) from None
    except (RecursionError, ValueError) as problem:
        raise InputError(
            f"The {kind} file {source} cannot be read: {str(problem)[:120]}.",
            f"{kind.capitalize()} files are YAML: 'key: value' lines, sections indented by spaces.",
            "Correct it.",
            file=source,
        ) from None
