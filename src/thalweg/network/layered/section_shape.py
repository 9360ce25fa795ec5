"""The shape of the sections of a layered network: layers, nodes and offset, and their counts."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.errors import InputError
from thalweg.core.given_numbers import is_number
from thalweg.core.types import Int32Array

#: One value for all sections, or one for each.
PerSection: TypeAlias = "float | Sequence[float]"

MAX_LAYERS, MAX_SEGMENTS_ACROSS, MAX_OFFSET = 2_000, 200, 1e6
_MAX_SEGMENTS = 20_000_000


@dataclass(frozen=True)
class SectionShape:
    """The rhombus of nodes between two waypoints.

    Attributes
    ----------
    layers : S, the number of layers between the two waypoints, 1 or more.
    fan : H, the number of segments that leave a node towards the next layer, 2 or more. An odd
        number has a segment straight ahead.
    offset : d, by how much a layer is wider than the one before, to either side [m].
    """

    layers: int
    fan: int
    offset: float

    def __post_init__(self) -> None:
        for name, least, most in (
            ("layers", 1, MAX_LAYERS), ("fan", 2, MAX_SEGMENTS_ACROSS),
            ("offset", 1.0, MAX_OFFSET),
        ):  # fmt: skip
            value = getattr(self, name)
            whole = name == "offset" or value == int(value)
            if not (math.isfinite(value) and least <= value <= most and whole):
                kind = "a number of metres" if name == "offset" else "a whole number"
                raise InputError(
                    f"A section of a layered network cannot have {name} {value!r}.",
                    f"It is {kind} from {least:g} to {most:g}.",
                    "Correct it.",
                    field=name,
                    value=value,
                )
        if self.n_segments > _MAX_SEGMENTS:
            raise InputError(
                f"A section of {self.layers} layers with a fan of {self.fan} has "
                f"{self.n_segments:,} segments.",
                f"At most {_MAX_SEGMENTS:,} are built.",
                "Take fewer layers or a smaller fan.",
            )

    @property
    def widest(self) -> int:
        """Number m of the first widest layer: half of the layers, rounded up."""
        return (self.layers + 1) // 2

    @property
    def nodes_in_layers(self) -> list[int]:
        """Number of nodes in every layer, start and end included."""
        own = [1 + k * (self.fan - 1) for k in range(self.widest + 1)]
        return [*own, *reversed(own[: self.layers + 2 - len(own)])]

    @property
    def n_nodes(self) -> int:
        """Number of nodes in closed form, start and end included (eq. 3.23)."""
        m, wider = self.widest, self.fan - 1
        return self.layers + 2 + wider * (m * m if self.layers % 2 else m * (m + 1))

    @property
    def n_segments(self) -> int:
        """Number of segments in closed form (eqs. 3.23 and 3.24; 3.25 corrected)."""
        h, m = self.fan, self.widest
        total = 2 * h * (m + (h - 1) * m * (m - 1) // 2)  # widening, and narrowing again
        if self.layers % 2 == 0:
            q = (h - 1) // 2
            total += (1 + m * (h - 1)) * (2 * q + 1) - q * (q + 1)
        return total

    @property
    def half_width(self) -> float:
        """Half of the width of the widest layer [m]."""
        return self.widest * self.offset

    def spacing_in_layer(self) -> float:
        """Return the distance c between neighbouring nodes of a layer [m]."""
        return 2.0 * self.offset / (self.fan - 1)

    def finer(self, factor: int) -> SectionShape:
        """Return this rhombus with layers and nodes so many times closer."""
        return SectionShape(
            factor * (self.layers + 1) - 1, self.fan, max(self.offset / factor, 1.0)
        )

    def segments(self) -> tuple[Int32Array, Int32Array]:
        """Return the nodes that the segments join, numbered by layers from port to starboard.

        Returns
        -------
        first, second : int32 array (n_segments,)
            From each layer to the next; 0 is the start, the last node the end.
        """
        sizes = self.nodes_in_layers
        begin = cumulative_sums(sizes)
        first, second = [], []
        q = (self.fan - 1) // 2
        for k in range(self.layers + 1):
            here, there = sizes[k], sizes[k + 1]
            step = {True: (0, self.fan - 1), False: (1 - self.fan, 0)}[there > here]
            low, high = (-q, q) if there == here else step
            i = np.repeat(np.arange(here), high - low + 1)
            j = i + np.tile(np.arange(low, high + 1), here)
            inside = (j >= 0) & (j < there)
            first.append(begin[k] + i[inside])
            second.append(begin[k + 1] + j[inside])
        return (
            np.concatenate(first).astype(np.int32),
            np.concatenate(second).astype(np.int32),
        )


def section_shapes(
    sections: int, layers: PerSection, fan: PerSection, offset: PerSection
) -> tuple[SectionShape, ...]:
    """Return the shape of every section; each value is one number, or one for each section.

    Parameters
    ----------
    sections : Number of sections R, 1 or more.
    layers, fan, offset : S, H and d [m] (`SectionShape`); forms may be mixed.

    Raises
    ------
    InputError : If a sequence has another length, or a value is not possible.
    """
    columns = [
        _of_sections(sections, name, given)
        for name, given in (("layers", layers), ("fan", fan), ("offset", offset))
    ]
    return tuple(SectionShape(int(s), int(h), float(d)) for s, h, d in zip(*columns))


def _of_sections(sections: int, name: str, given: Any) -> list[Any]:
    values = list(given) if isinstance(given, (list, tuple, np.ndarray)) else [given] * sections
    if len(values) != sections:
        raise InputError(
            f"{len(values)} values of {name} are given for {sections} section(s).",
            "Via points divide a voyage into sections, one more than there are via points.",
            "Give one value for all sections, or one for each.",
            field=name,
        )
    for value in values:
        if not is_number(value) or (name != "offset" and value != int(value)):
            raise InputError(
                f"{value!r} is no value of {name} of a layered network.",
                "layers and fan are whole numbers, offset is a length in metres.",
                "Correct it.",
                field=name,
            )
    return values
