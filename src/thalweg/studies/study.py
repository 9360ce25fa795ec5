"""`Study`: what is planned, over which axes and samples, and the rows that follow from it."""

from __future__ import annotations

import hashlib
import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

import yaml

from thalweg.core.errors import InputError, refuse_other_file, unknown_name_error
from thalweg.core.file_reading import read_text_file
from thalweg.planning.voyage_parts import TRADE_OFF_OBJECTIVES
from thalweg.studies.annual_figures import ANNUAL_ENTRIES, checked_annual
from thalweg.studies.study_axes import (
    MOST_ROWS,
    axis_values,
    fill_policies,
    plain_data,
    sample_draws,
)
from thalweg.studies.study_checks import (
    COMPARISONS,
    SURROUNDINGS,
    canonical_json,
    check_axes,
    check_entry,
    check_mappings,
    check_surroundings,
    compared_names,
    entries_of_value,
    label_of_value,
)

DETAILS: Final = ("refined", "network")  #: of routes: as `plan` gives them, or on the network alone
_ENTRIES: Final = ("name", "voyage", "axes", "sample", "compare", "annual", *SURROUNDINGS)
_WITHOUT_SEED: Final = "exact"  # the method that does not depend on the seed
_WITHOUT_BLOCKS: Final = "exact"  # the method that holds no speed for a least time


@dataclass(frozen=True)
class StudyRow:
    """One voyage of a study.

    Attributes
    ----------
    id : Hash of the request: the same voyage has the same id in every study.
    request : mapping
        ``voyage`` (the entries of a `Voyage`) and the entries of `SURROUNDINGS`; plain data.
    labels : mapping
        Value or name of each axis and sample, for tables.
    """

    id: str
    request: Mapping[str, Any]
    labels: Mapping[str, Any]


@dataclass(frozen=True)
class Study:
    """Many voyages: one request, varied over axes and samples.

    The method ``exact`` does not depend on the seed: over an axis of seeds it is run once.

    Parameters
    ----------
    name : str
    base : mapping
        Request that all rows share: ``voyage`` and the entries of `SURROUNDINGS`.
    axes : mapping of str to sequence
        Values of entries; the rows are all combinations. A value may be a mapping with ``name``
        that sets several entries at once.
    sample : mapping
        ``count``, ``seed`` and, for each entry, a distribution: ``{uniform: [low, high]}``,
        ``{normal: [mean, standard deviation]}`` or ``{choice: [values]}``. Every combination of the
        axes gets ``count`` draws.
    compare : sequence of str
        ``weather_blind``: the route planned in calm weather, sailed in the real weather.
    folder : Path
        Files of the study are relative to it.
    annual : mapping
        ``port_h`` and ``year``: what the summary needs for the figures of a year.

    Raises
    ------
    InputError
        If an entry is not known or not understood.
    """

    name: str
    base: Mapping[str, Any]
    axes: Mapping[str, Sequence[Any]] = field(default_factory=dict)
    sample: Mapping[str, Any] = field(default_factory=dict)
    compare: tuple[str, ...] = ()
    folder: Path = Path()
    annual: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        check_surroundings(self.base)
        for entry in (*self.axes, *(key for key in self.sample if key not in ("count", "seed"))):
            for value in self.axes.get(entry, ()):
                for key in value if isinstance(value, Mapping) else ():
                    if key != "name":
                        check_entry(key)
                if isinstance(value, Mapping):
                    check_surroundings(value)
            named = all(isinstance(value, Mapping) for value in self.axes.get(entry, (None,)))
            if not named:
                check_entry(entry)
        check_axes(self.axes, self.sample)
        for name in self.compare:
            if name not in COMPARISONS:
                raise unknown_name_error("comparison", name, COMPARISONS, field="compare")
        for name in (self.base.get("detail", DETAILS[0]), *self.axes.get("detail", ())):
            if not isinstance(name, Mapping) and name not in DETAILS:
                raise unknown_name_error("detail", str(name), DETAILS)
        fill_policies(self.base.get("fill"))
        for axis, values in self.axes.items():
            for value in values:
                named = isinstance(value, Mapping) and "name" in value
                fill_policies(value.get("fill") if named else value if axis == "fill" else None)
        if self.size > MOST_ROWS:
            raise InputError(
                f"The study has {self.size:,} voyages.",
                f"At most {MOST_ROWS:,} are run in one study.",
                "Use fewer values, or several studies.",
            )

    @property
    def size(self) -> int:
        """Number of rows."""
        whole = math.prod(len(values) for values in self.axes.values()) * self._draws
        methods, seeds = self.axes.get("method", ()), self.axes.get("seed", ())
        if not methods or not seeds:
            return whole
        repeated = list(methods).count(_WITHOUT_SEED) * (len(seeds) - 1)
        return whole - whole // (len(methods) * len(seeds)) * repeated

    @property
    def _draws(self) -> int:
        return int(self.sample.get("count", 1))

    @property
    def without_speed_blocks(self) -> bool:
        """Whether all rows plan without blocks of speed, unless an entry sets their length.

        The method ``exact`` has none, so an axis that compares it with others has none either.
        """
        values = [(axis, value) for axis, given in self.axes.items() for value in given]
        methods = {str(entries_of_value(*one).get("method", "")) for one in values} - {""}
        return _WITHOUT_BLOCKS in methods and len(methods) > 1

    def rows(self) -> list[StudyRow]:
        """Return the rows: all combinations of the axes, each with all draws of the sample.

        Returns
        -------
        list of StudyRow
        """
        draws = sample_draws(self.sample)
        return [
            _row(self.base, values | draw, self.compare, even=self.without_speed_blocks)
            for values in self._combinations()
            for draw in draws
        ]

    def _combinations(self) -> Iterator[dict[str, Any]]:
        """Yield the values of the axes in all combinations, without repeated exact searches."""
        seeds = self.axes.get("seed", ())
        for values in itertools.product(*self.axes.values()):
            found = dict(zip(self.axes, values))
            repeated = found.get("method") == _WITHOUT_SEED and "seed" in found
            if not (repeated and found["seed"] != seeds[0]):
                yield found

    def chunks(self, rows: Sequence[StudyRow], length: int) -> list[list[StudyRow]]:
        """Return rows in chunks that share ship, sea and places, in order of departure.

        Parameters
        ----------
        rows : sequence of StudyRow
        length : int
            Most rows of a chunk; ten times as many with the detail ``network``.

        Returns
        -------
        list of list of StudyRow
        """
        groups: dict[str, list[StudyRow]] = {}
        for row in rows:
            places = {key: row.request["voyage"].get(key) for key in ("start", "goal", "via")}
            around = {key: row.request.get(key) for key in SURROUNDINGS}
            groups.setdefault(canonical_json([places, around]), []).append(row)
        chunks = []
        for group in groups.values():
            group.sort(key=lambda row: str(row.request["voyage"].get("depart", "")))
            step = 10 * length if group[0].request.get("detail") == "network" else length
            chunks += [group[k : k + step] for k in range(0, len(group), step)]
        return chunks

    def to_dict(self) -> dict[str, Any]:
        """Return the study as plain data; `Study.from_dict` reads it.

        Returns
        -------
        dict
        """
        return {
            "name": self.name,
            **self.base,
            "axes": {name: list(values) for name, values in self.axes.items()},
            "sample": dict(self.sample),
            "compare": list(self.compare),
            **({"annual": dict(self.annual)} if self.annual else {}),
        }

    @classmethod
    def from_dict(cls, data: Mapping[str, Any], folder: Path = Path()) -> Study:
        """Return the study that plain data describe.

        Parameters
        ----------
        data : mapping
            As in a study file.
        folder : Path
            Files of the study are relative to it.

        Returns
        -------
        Study

        Raises
        ------
        InputError
            If an entry is not known or not understood.
        """
        if not isinstance(data, Mapping):
            raise InputError(
                "The study is not a mapping.",
                f"It has the entries {', '.join(_ENTRIES)}.",
                "See the example in the documentation.",
            )
        refuse_other_file(data, "a study")
        for key in data:
            if key in ANNUAL_ENTRIES:
                raise InputError(
                    f"{key} is an entry of the study itself.",
                    "It belongs under annual.",
                    f"Write annual: {{{key}: {data[key]}}}, with the other entries of annual.",
                    field=str(key),
                )
            if key not in _ENTRIES:
                raise unknown_name_error("entry of a study", str(key), _ENTRIES, field=str(key))
        voyage = plain_data(data.get("voyage", {}))
        if not isinstance(voyage, dict) or (
            not {"start", "goal"} & set(voyage) and "axes" not in data
        ):
            raise InputError(
                "The study has no voyage.",
                "voyage: holds start, goal and other entries of a voyage.",
                "Add it.",
                field="voyage",
            )
        for key in voyage:
            check_entry(str(key))
        base = {"voyage": voyage}
        base |= {key: plain_data(data[key]) for key in SURROUNDINGS if key in data}
        axes = data.get("axes") or {}
        sample = data.get("sample") or {}
        check_mappings(axes, sample)
        compare = compared_names(data.get("compare") or ())
        return cls(
            str(data.get("name", "study")),
            base,
            {str(name): axis_values(str(name), values) for name, values in axes.items()},
            plain_data(sample),
            compare,
            folder,
            checked_annual(data["annual"]) if "annual" in data else {},
        )


def load_study(path: str | Path) -> Study:
    """Return the study of a YAML file.

    Parameters
    ----------
    path : path

    Returns
    -------
    Study

    Raises
    ------
    InputError
        If the file is missing, is not YAML, or has entries that are not understood.
    """
    text = read_text_file(path, "study")
    try:
        data = yaml.safe_load(text)
    except yaml.YAMLError as error:
        raise InputError(
            f"The study file {path} is not YAML: {str(error).splitlines()[0]}.",
            "A study is a YAML mapping.",
            "Correct the file.",
        ) from error
    return Study.from_dict(data, Path(path).resolve().parent)


def _row(
    base: Mapping[str, Any], chosen: Mapping[str, Any], compare: Sequence[str], *, even: bool
) -> StudyRow:
    """Return a row.

    Parameters
    ----------
    even : Whether it has no blocks of speed, as the method it is compared with.
    """
    request: dict[str, Any] = {key: value for key, value in base.items() if key != "voyage"}
    voyage = dict(base["voyage"])
    labels: dict[str, Any] = {}
    for name, value in chosen.items():
        labels[name] = label_of_value(name, value)
        for key, part in entries_of_value(name, value).items():
            (request if key in SURROUNDINGS else voyage)[key] = part
    if even and voyage.get("objective") in TRADE_OFF_OBJECTIVES:
        voyage.setdefault("speed_block_h", 0)
    request["voyage"] = voyage
    if compare:
        request["compare"] = list(compare)
    digest = hashlib.blake2b(canonical_json(request).encode(), digest_size=12).hexdigest()
    return StudyRow(digest, request, labels)
