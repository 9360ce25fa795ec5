"""Methods that call a function of another module with a part of the object."""

from __future__ import annotations

import inspect
from dataclasses import dataclass

from thalweg.core.delegation import delegated


def scaled(numbers: tuple[float, ...], factor: float, *, offset: float = 0.0) -> list[float]:
    """Return scaled numbers.

    Parameters
    ----------
    factor : float
        Any.

    Returns
    -------
    list of float
    """
    return [factor * number + offset for number in numbers]


def count(row) -> int:
    """Return the length of a row.

    Returns
    -------
    int
    """
    return len(row.numbers)


@dataclass(frozen=True)
class Row:
    numbers: tuple[float, ...]
    scaled = delegated(scaled, "numbers")
    count = delegated(count)


def test_the_part_or_the_object_is_the_first_argument():
    row = Row((1.0, 2.0))
    assert row.scaled(3.0, offset=1.0) == [4.0, 7.0]
    assert row.count() == 2


def test_signature_is_that_of_the_function_without_the_part_and_the_text_the_same():
    assert str(inspect.signature(Row.scaled)).startswith("(self, factor: 'float', *, offset")
    assert list(inspect.signature(Row((1.0,)).scaled).parameters) == ["factor", "offset"]
    assert Row.scaled.__doc__ == scaled.__doc__
