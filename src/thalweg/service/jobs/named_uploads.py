"""The uploaded files that a request names, whatever its kind."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, Final, NamedTuple

from thalweg.core.errors import InputError
from thalweg.core.strict_yaml import parse_yaml
from thalweg.service.jobs.plan_request import EMBEDDED_SEAS

ESTUARY: Final = "synthetic-estuary"  #: the sea of the example project


class NamedUploads(NamedTuple):
    """Names in a request: ships (of the library or uploaded), and uploaded files of each kind."""

    ships: list[str]
    seas: list[str]
    routes: list[str]
    traffic: list[str]
    histories: list[str]


def named_uploads(request: Mapping[str, Any]) -> NamedUploads:
    """Return the ships, seas and routes that a request of any kind names."""
    if "project" in request:
        entries = request["project"]
        seas = [name for key in ("sea", "depth") for name in _texts(entries.get(key))]
        found = NamedUploads([*_texts(entries.get("ship", "hopper-dredger"))], seas, [], [], [])
    elif "study" in request:
        study = request["study"]
        keys = "ship", "sea", "depths", "track", "traffic"
        ships, seas, depths, tracks, traffic = ([*_study_texts(study, key)] for key in keys)
        found = NamedUploads(ships, [*seas, *depths], tracks, traffic, [])
    elif "source" in request:
        found = NamedUploads([], [], [], [], [])
    else:
        seas = [*request.get("seas", ()), *request.get("depths", ())]
        found = NamedUploads(
            [str(request["ship"])],
            seas,
            [*_texts(request.get("route"))],
            [*request.get("traffic", ())],
            [*_texts(request.get("history"))],
        )
    seas = [name for name in found.seas if name not in (*EMBEDDED_SEAS, ESTUARY)]
    return found._replace(seas=seas)


def _texts(value: Any) -> Iterator[str]:
    """Yield a text, or those of a list."""
    for part in value if isinstance(value, list) else [value]:
        if isinstance(part, str):
            yield part


def _study_texts(study: Mapping[str, Any], key: str) -> Iterator[str]:
    """Yield the values of an entry of a study: fixed, on an axis, or drawn.

    A value on an axis or in a sample may be a mapping that sets several entries.
    """
    yield from _texts(study.get(key))
    drawn = (study.get("sample") or {}).items()
    choices = [(name, part.get("choice")) for name, part in drawn if isinstance(part, Mapping)]
    for name, values in [*(study.get("axes") or {}).items(), *choices]:
        for value in values if isinstance(values, list) else [values]:
            if isinstance(value, Mapping):
                yield from _texts(value.get(key))
            elif name == key:
                yield from _texts(value)


def entries_of(given: dict[str, Any] | str, what: str) -> dict[str, Any]:
    """Return the entries of a file: given as data, or as its text.

    Raises
    ------
    InputError
        If the text is not a YAML mapping.
    """
    data = parse_yaml(given, what, what) if isinstance(given, str) else given
    if not isinstance(data, dict):
        raise InputError(
            f"The {what} is no mapping of entries.", "A file holds entries.", "Correct it.",
            field=what,
        )  # fmt: skip
    return data


def refuse_paths(data: Mapping[str, Any], keys: tuple[str, ...], what: str) -> None:
    """Raise `InputError` for an entry that names a file of the server by its path."""
    for key in keys:
        if any(True for _ in _study_texts(data, key)):
            raise InputError(
                f"{key} of the {what} names a file.",
                f"Files of the server are not opened; {key} holds its content.",
                "Give the content in place of the name.",
                field=key,
            )
