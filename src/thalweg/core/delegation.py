"""Methods of a class that call a function of another module."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable
from typing import Any, Concatenate, ParamSpec, TypeVar, cast

_Arguments = ParamSpec("_Arguments")
_Result = TypeVar("_Result")
_Object = TypeVar("_Object")


def delegated(
    function: Callable[Concatenate[Any, _Arguments], _Result], part: str | None = None
) -> Callable[Concatenate[Any, _Arguments], _Result]:
    """Return a method that calls a function with the object, or a part of it, as first argument.

    The method has the signature of the function without that first argument, and its docstring,
    which describes the other arguments only, so that both are written once.

    Parameters
    ----------
    function : Takes the object or the part, then the arguments of the method.
    part : Attribute that is the first argument, such as ``layers``; by default the object itself.

    Returns
    -------
    callable : A method, to be assigned in the body of a class.
    """

    @functools.wraps(function)
    def method(self: Any, *args: _Arguments.args, **kwargs: _Arguments.kwargs) -> _Result:
        return function(getattr(self, part) if part else self, *args, **kwargs)

    found = inspect.signature(function)
    first, *others = found.parameters.values()
    method.__signature__ = found.replace(  # type: ignore[attr-defined]
        parameters=[first.replace(name="self", annotation=first.empty), *others]
    )
    return cast(Callable[Concatenate[Any, _Arguments], _Result], method)


def changed(
    function: Callable[Concatenate[Any, _Arguments], Any],
) -> Callable[Concatenate[_Object, _Arguments], _Object]:
    """Return a `delegated` method whose function returns an object of the same class.

    Parameters
    ----------
    function : Takes the object, then the arguments of the method; returns a changed copy.
    """
    method: Any = delegated(function)
    method.__signature__ = method.__signature__.replace(return_annotation="Self")
    return cast("Callable[Concatenate[_Object, _Arguments], _Object]", method)
