"""Methods that call a function of another module with a part of the object."""

from __future__ import annotations

import inspect
from dataclasses import dataclass

from thalweg.core.delegation import delegated, without_first_parameter


def scaled(numbers: tuple[float, ...], factor: float, *, offset: float = 0.0) -> list[float]:
    """Return scaled numbers.

    Parameters
    ----------
    numbers : tuple of float
        What is scaled,
        in order.
    factor : float
        Any.

    Returns
    -------
    list of float
    """
    return [factor * number + offset for number in numbers]


def count(row) -> int:
    """Return the length of a row.

    Parameters
    ----------
    row : Row
        A row.

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


def test_signature_and_text_are_those_of_the_function_without_the_part():
    assert str(inspect.signature(Row.scaled)).startswith("(self, factor: 'float', *, offset")
    assert list(inspect.signature(Row((1.0,)).scaled).parameters) == ["factor", "offset"]
    text = inspect.getdoc(Row.scaled)
    assert "numbers :" not in text and "in order" not in text
    assert "Parameters\n----------\nfactor : float\n    Any.\n\nReturns" in text
    assert "Parameters" not in inspect.getdoc(Row.count) and "Returns" in inspect.getdoc(Row.count)


def test_text_without_a_section_of_parameters_is_left_as_it_is():
    assert without_first_parameter("Do it.") == "Do it."
    only = "Do it.\n\nParameters\n----------\nrow : Row\n    A row.\n"
    assert without_first_parameter(only) == "Do it.\n\n"
