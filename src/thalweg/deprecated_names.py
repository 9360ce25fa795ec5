"""Old names of modules and functions: they still work, with a warning that names the new one.

An importer finds the old names of documented modules. It is the last one, so that it takes no time
when only new names are used. Packages support the names they once exported by `renamed`.
"""

from __future__ import annotations

import functools
import sys
import warnings
from collections.abc import Callable, Mapping, Sequence
from importlib import import_module
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from operator import attrgetter
from types import ModuleType
from typing import Any, Final, TypeVar, cast

_Function = TypeVar("_Function", bound=Callable[..., Any])

#: Old module, and for each of its old public names the module and name of today.
MOVED: Final[Mapping[str, Mapping[str, tuple[str, str]]]] = {
    "thalweg.chart.eca": {
        "emission_areas": ("thalweg.chart.zones.emission_control_areas", "emission_control_areas"),
    },
    "thalweg.network.ways": {
        "alternatives": ("thalweg.network.alternatives.path_search", "paths_without_canals"),
        "ways_round": ("thalweg.network.alternatives.path_search", "alternative_paths"),
    },
    "thalweg.operations.estuary": {
        "synthetic_estuary": ("thalweg.operations.examples.estuary", "synthetic_estuary"),
    },
    "thalweg.operations.fairways": {
        "Fairways": ("thalweg.operations.openclsim.leg_planner", "LegPlanner"),
    },
    "thalweg.operations.openclsim_plugin": {
        "SailsFairways": ("thalweg.operations.openclsim.plugin", "PlannedRouteMovable"),
    },
    "thalweg.operations.project": {
        "Project": ("thalweg.operations.dredging.project", "Project"),
    },
    "thalweg.operations.project_files": {
        "example_file": ("thalweg.operations.dredging.project_inputs", "example_file"),
        "open_project": ("thalweg.operations.dredging.project_inputs", "open_project"),
        "open_things": ("thalweg.operations.dredging.project_inputs", "open_project_inputs"),
    },
    "thalweg.operations.project_world": {
        "World": ("thalweg.operations.dredging.project_environment", "ProjectEnvironment"),
        "open_ways": ("thalweg.operations.dredging.project_environment", "freeze_site_network"),
        "project_network": ("thalweg.operations.dredging.project_environment", "project_network"),
    },
    "thalweg.operations.run_project": {
        "run_project": ("thalweg.operations.dredging.run_project", "run_project"),
    },
    "thalweg.operations.synthetic_tracks": {
        "Cycle": ("thalweg.operations.examples.synthetic_tracks", "SyntheticCycle"),
        "synthetic_track": ("thalweg.operations.examples.synthetic_tracks", "synthetic_track"),
    },
    "thalweg.operations.tracks_picture": {
        "draw_tracks": ("thalweg.operations.plots.track_plot", "draw_tracks"),
    },
    "thalweg.operations.trips": {
        "trip_table": ("thalweg.operations.waiting.trip_durations", "trip_table_of_window"),
    },
    "thalweg.operations.waiting_picture": {
        "draw_waiting": ("thalweg.operations.plots.waiting_plot", "draw_waiting"),
    },
    "thalweg.operations.waiting_study": {
        "break_even_power": ("thalweg.operations.waiting.waiting_study", "break_even_power"),
        "waiting_study": ("thalweg.operations.waiting.waiting_study", "waiting_study"),
    },
    "thalweg.planning.st_diagram": {
        "find_closures": ("thalweg.planning.plots.channel_closures", "find_closures"),
    },
    "thalweg.planning.st_picture": {
        "draw_st": ("thalweg.planning.plots.space_time_diagram", "draw_space_time_diagram"),
        "write_st": ("thalweg.planning.plots.space_time_diagram", "write_space_time_diagram"),
    },
    "thalweg.sea.constituents": {
        "Constituents": ("thalweg.sea.tides.constituents", "Constituents"),
    },
    "thalweg.sea.north_sea": {
        "M2_PERIOD": ("thalweg.sea.models.stratified_coast", "M2_PERIOD"),
        "SCENARIOS": ("thalweg.sea.models.stratified_coast", "TIDAL_ELLIPSES"),
        "north_sea_current": ("thalweg.sea.models.stratified_coast", "stratified_coast_current"),
    },
    "thalweg.sea.repeat": {
        "repeated": ("thalweg.sea.periodic_repeat", "repeat_in_time"),
    },
    "thalweg.sea.tide_files": {
        "read_constituents": ("thalweg.sea.tides.constituent_files", "read_constituents"),
        "write_constituents": ("thalweg.sea.tides.constituent_files", "write_constituents"),
    },
    "thalweg.ship.methods.squat": {
        "speed_limit": ("thalweg.ship.methods.shallow_water.squat", "shallow_water_speed_limit"),
    },
    "thalweg.ship.table": {
        "PerformanceTable": ("thalweg.ship.tables.performance_table", "PerformanceTable"),
        "TableError": ("thalweg.ship.tables.performance_table", "TableError"),
        "TablePart": ("thalweg.ship.tables.performance_table", "TablePart"),
    },
}
#: Package, and for each name it once exported the module and name of today.
RENAMED: Final[Mapping[str, Mapping[str, tuple[str, str]]]] = {
    "thalweg.evolution": {
        "Evolution": ("thalweg.evolution.evolve", "EvolutionResult"),
        "Habits": ("thalweg.evolution.variation", "VariationSettings"),
        "Mix": ("thalweg.evolution.variation", "OperatorWeights"),
        "Prices": ("thalweg.core.objective", "LegPrices"),
        "Progress": ("thalweg.evolution.evolve", "EvolutionProgress"),
    },
    "thalweg.network": {
        "Way": ("thalweg.network.alternatives.alternative_path", "AlternativePath"),
        "Weighing": ("thalweg.network.alternatives.alternative_path", "EdgeWeights"),
        "eca_shares": ("thalweg.network.alternatives.alternative_path", "eca_fractions"),
        "line": ("thalweg.network.fixed_route", "fixed_route"),
        "shortest": ("thalweg.network.shortest_paths", "shortest_path"),
        "ways_round": ("thalweg.network.alternatives.path_search", "alternative_paths"),
    },
    "thalweg.operations.waiting": {
        "RULES": ("thalweg.operations.waiting.waiting_optimisation", "DEPARTURE_RULES"),
    },
    "thalweg.route": {
        "Distribution": ("thalweg.route.ensemble_evaluation", "EnsembleResult"),
        "Spread": ("thalweg.route.ensemble_evaluation", "MemberStatistics"),
        "polish": ("thalweg.route.refinement.cost_refinement", "refine_cost"),
    },
    "thalweg.sea": {
        "Area": ("thalweg.core.bounding_box", "BoundingBox"),
    },
    "thalweg.search": {
        "Bound": ("thalweg.search.lower_bounds", "LowerBound"),
        "Front": ("thalweg.search.pareto.front_result", "NetworkFront"),
        "NetworkPassage": ("thalweg.search.timed_path", "TimedPath"),
        "Passage": ("thalweg.search.timed_path", "TimedPath"),
        "Passages": ("thalweg.search.profile_search", "ProfileSearch"),
        "Waters": ("thalweg.search.prepared_network", "PreparedNetwork"),
        "extreme": ("thalweg.ship.tables.table_bounds", "table_bounds"),
        "front": ("thalweg.search.pareto.pareto_search", "pareto_front"),
    },
}

#: Packages whose name was that of a function.
FUNCTIONS_OF_PACKAGES: Final[Mapping[str, tuple[str, str]]] = {
    "thalweg.network.alternatives": (
        "thalweg.network.alternatives.path_search",
        "paths_without_canals",
    ),
}


def warn_renamed(old: str, new: str, *, level: int = 3) -> None:
    """Warn that a name is deprecated.

    Parameters
    ----------
    old, new : Dotted names.
    level : Frames between this call and the caller's code.
    """
    warnings.warn(
        f"{old} is deprecated and will be removed in version 0.3; use {new}.",
        DeprecationWarning,
        stacklevel=level,
    )


def renamed(package: str, *, level: int = 3) -> Callable[[str], Any]:
    """Return a module's ``__getattr__`` that answers for old names.

    Parameters
    ----------
    package : A key of `MOVED`, or a package: that which once had the names.
    level : Frames between the warning and the caller's code.

    Returns
    -------
    callable
        Raises AttributeError for any other name.
    """
    names = MOVED.get(package) or RENAMED.get(package, {})

    def lookup(name: str) -> Any:
        if name not in names:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        module, new = names[name]
        warn_renamed(f"{package}.{name}", f"{module}.{new}", level=level)
        return getattr(import_module(module), new)

    return lookup


def renamed_arguments(**names: str) -> Callable[[_Function], _Function]:
    """Let a function take arguments by their old names too, with a warning.

    Parameters
    ----------
    **names : Old name = new name.

    Returns
    -------
    decorator
        Its function raises TypeError when an argument is given by both names.
    """

    def decorate(function: _Function) -> _Function:
        @functools.wraps(function)
        def accept(*args: Any, **kwargs: Any) -> Any:
            for old, new in names.items():
                if old in kwargs:
                    if new in kwargs:
                        raise TypeError(f"{function.__name__}() got both {old!r} and {new!r}")
                    warn_renamed(f"{function.__name__}({old}=)", f"{new}=")
                    kwargs[new] = kwargs.pop(old)
            return function(*args, **kwargs)

        return cast(_Function, accept)

    return decorate


def renamed_attributes(**names: str) -> Callable[[Any, str], Any]:
    """Return a class's ``__getattr__`` that answers for old names of attributes and methods.

    Parameters
    ----------
    **names : str
        Old name = new name, dotted if it is an attribute of an attribute; ``module:name`` for a
        function or constant of a module.

    Returns
    -------
    callable
        Raises AttributeError for any other name.
    """

    def lookup(self: Any, name: str) -> Any:
        owner = type(self).__name__
        if name not in names:
            raise AttributeError(f"{owner!r} object has no attribute {name!r}")
        new = names[name]
        if ":" not in new:
            warn_renamed(f"{owner}.{name}", f"{owner}.{new}")
            return attrgetter(new)(self)
        warn_renamed(f"{owner}.{name}", new.replace(":", "."))
        module, _, path = new.partition(":")
        return attrgetter(path)(import_module(module))

    return lookup


def limits_as_array(function: _Function) -> _Function:
    """Let a function take ``limits`` as the array of three numbers of before, with a warning."""

    @functools.wraps(function)
    def accept(*args: Any, **kwargs: Any) -> Any:
        if hasattr(kwargs.get("limits"), "dtype"):
            from thalweg.core.limits import Limits

            warn_renamed(f"{function.__name__}(limits=array)", "thalweg.core.limits.Limits")
            kwargs["limits"] = Limits(*kwargs["limits"])
        return function(*args, **kwargs)

    return cast(_Function, accept)


class CallableModule(ModuleType):
    """A package that can be called like the function which once had its name."""

    def __call__(self, *args: Any, **kwargs: Any) -> Any:
        """Call the function of today, `FUNCTIONS_OF_PACKAGES`, with a warning."""
        module, new = FUNCTIONS_OF_PACKAGES[self.__name__]
        warn_renamed(self.__name__, f"{module}.{new}")
        return getattr(import_module(module), new)(*args, **kwargs)


class _OldModules(MetaPathFinder, Loader):
    """Finds the modules of `MOVED`."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        return ModuleSpec(fullname, self) if fullname in MOVED else None

    def create_module(self, spec: ModuleSpec) -> ModuleType | None:
        return None

    def exec_module(self, module: ModuleType) -> None:
        module.__getattr__ = renamed(module.__name__)  # type: ignore[method-assign]


def install() -> None:
    """Let Python find the old modules, after all other importers."""
    if not any(isinstance(finder, _OldModules) for finder in sys.meta_path):
        sys.meta_path.append(_OldModules())
