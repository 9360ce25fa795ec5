"""Packages that import their modules when a name is first used: commands start sooner."""

from __future__ import annotations

import ast
import sys
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

from thalweg.deprecated_names import renamed


class LazyPackage(ModuleType):
    """A package in which an exported name is never that of one of its modules."""

    __all__: list[str]

    def __setattr__(self, name: str, value: Any) -> None:
        if not (isinstance(value, ModuleType) and name in self.__all__):
            super().__setattr__(name, value)


def lazy_exports(package: str, folder: str) -> tuple[Callable[[str], Any], list[str]]:
    """Return the ``__getattr__`` and the ``__all__`` of a package from its ``__init__.pyi``.

    The stub holds the imports that a package otherwise has in its ``__init__.py``, such as
    ``from thalweg.route.track import Track``. Type checkers read it as it is.

    Parameters
    ----------
    package : Its dotted name.
    folder : Its ``__path__[0]``.

    Returns
    -------
    callable, list of str
        The ``__getattr__`` answers for deprecated names too.
    """
    stub = ast.parse((Path(folder) / "__init__.pyi").read_text("utf-8"))
    places = {
        alias.asname or alias.name: (str(node.module), alias.name)
        for node in stub.body
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }
    this = sys.modules[package]
    this.__class__ = LazyPackage
    old_names = renamed(package, level=4)

    def getattr_of_package(name: str) -> Any:
        if name in places:
            module, name_there = places[name]
            value = getattr(import_module(module), name_there)
            setattr(this, name, value)
            return value
        return old_names(name)

    return getattr_of_package, sorted(places)
