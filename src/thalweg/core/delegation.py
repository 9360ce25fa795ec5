"""Methods of a class that call a function of another module."""

from __future__ import annotations

import functools
import inspect
import re
from collections.abc import Callable
from typing import Any, Concatenate, ParamSpec, TypeVar, cast

_Arguments = ParamSpec("_Arguments")
_Result = TypeVar("_Result")

#: A section Parameters: its heading, and then entries of which the text is indented further.
_PARAMETERS = r"^( *)Parameters\n *-+\n"


def delegated(
    function: Callable[Concatenate[Any, _Arguments], _Result], part: str | None = None
) -> Callable[Concatenate[Any, _Arguments], _Result]:
    """Return a method that calls a function with the object, or a part of it, as first argument.

    The method has the signature and the docstring of the function without that first argument, so
    that both are written once.

    Parameters
    ----------
    function : Takes the object or the part, then the arguments of the method.
    part : Attribute that is the first argument, such as ``layers``; by default the object itself.

    Returns
    -------
    callable
        A method, to be assigned in the body of a class.
    """

    @functools.wraps(function)
    def method(self: Any, *args: _Arguments.args, **kwargs: _Arguments.kwargs) -> _Result:
        return function(getattr(self, part) if part else self, *args, **kwargs)

    found = inspect.signature(function)
    first, *others = found.parameters.values()
    method.__signature__ = found.replace(  # type: ignore[attr-defined]
        parameters=[first.replace(name="self", annotation=first.empty), *others]
    )
    method.__doc__ = without_first_parameter(function.__doc__ or "")
    return cast(Callable[Concatenate[Any, _Arguments], _Result], method)


def without_first_parameter(docstring: str) -> str:
    """Return a numpydoc docstring without the first entry of its section Parameters.

    Parameters
    ----------
    docstring : The section is left out when it has one entry.

    Returns
    -------
    str
        The shortened docstring.
    """
    heading = re.search(_PARAMETERS, docstring, re.M)
    if heading is None:
        return docstring
    indent = heading.group(1)
    entry = rf"{indent}\S.*\n(?:{indent} +\S.*\n)*"
    rest = re.sub(rf"\A{entry}", "", docstring[heading.end() :])
    is_empty = re.match(r"\s*\n|\s*\Z", rest) is not None
    return docstring[: heading.start()] + ("" if is_empty else heading.group(0)) + rest
