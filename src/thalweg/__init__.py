"""Thalweg: voyage optimisation for ships, with proof of how good the answer is."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from thalweg import deprecated_names

__version__: str

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.core.errors import (
        CoverageError,
        DatasetError,
        InputError,
        ModelRangeError,
        NoRouteError,
        ThalwegError,
    )
    from thalweg.network import Network, lattice, mesh
    from thalweg.planning import Plan, Voyage, plan
    from thalweg.route import Route, Track, evaluate
    from thalweg.sea import Sea
    from thalweg.ship import Ship

#: The package of each public name; it is imported when the name is first used.
_PACKAGE_OF = {
    "Chart": "chart",
    "CoverageError": "core.errors",
    "DatasetError": "core.errors",
    "InputError": "core.errors",
    "ModelRangeError": "core.errors",
    "Network": "network",
    "NoRouteError": "core.errors",
    "Plan": "planning",
    "Route": "route",
    "Sea": "sea",
    "Ship": "ship",
    "ThalwegError": "core.errors",
    "Track": "route",
    "Voyage": "planning",
    "distance": "planning.sea_distance",
    "evaluate": "route",
    "lattice": "network",
    "mesh": "network",
    "plan": "planning",
}

#: Names that differ in their package.
_NAME_THERE = {"distance": "sea_distance"}

__all__ = [
    "Chart",
    "CoverageError",
    "DatasetError",
    "InputError",
    "ModelRangeError",
    "Network",
    "NoRouteError",
    "Plan",
    "Route",
    "Sea",
    "Ship",
    "ThalwegError",
    "Track",
    "Voyage",
    "distance",
    "evaluate",
    "lattice",
    "mesh",
    "plan",
]

deprecated_names.install()


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from importlib.metadata import version

        return version("thalweg")
    if name not in _PACKAGE_OF:
        raise AttributeError(f"module 'thalweg' has no attribute {name!r}")
    module = import_module(f"thalweg.{_PACKAGE_OF[name]}")
    value = getattr(module, _NAME_THERE.get(name, name))
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted([*globals(), *_PACKAGE_OF])
