"""Deprecated names work and give a warning with the new name."""

from __future__ import annotations

import warnings
from importlib import import_module

import numpy as np
import pytest

from thalweg.chart import Chart
from thalweg.core.limits import Limits
from thalweg.deprecated_names import MOVED, RENAMED, limits_as_array, renamed_arguments
from thalweg.network import lattice, paths_without_canals
from thalweg.network.alternatives.path_search import alternative_paths
from thalweg.operations.openclsim.plugin import PlannedRouteMovable
from thalweg.operations.waiting.waiting_study import break_even_power, waiting_study
from thalweg.planning.plan_front import ParetoFront
from thalweg.sea import Sea

OLD = [
    (module, name, new)
    for table in (MOVED, RENAMED)
    for module, names in table.items()
    for name, new in names.items()
]


@pytest.mark.parametrize(("module", "name", "new"), OLD)
def test_an_old_name_gives_the_new_object_and_a_warning(module, name, new):
    with pytest.warns(DeprecationWarning, match=new[1]):
        found = getattr(import_module(module), name)
    with warnings.catch_warnings():
        warnings.simplefilter("error", DeprecationWarning)
        assert found is getattr(import_module(new[0]), new[1])


def test_names_that_never_were_are_refused():
    with pytest.raises(AttributeError, match="no attribute 'never'"):
        getattr(import_module("thalweg.search"), "never")  # noqa: B009
    with pytest.raises(ModuleNotFoundError):
        import_module("thalweg.search.never")


def test_an_argument_may_be_given_by_its_old_name_once():
    @renamed_arguments(most_wait="max_wait")
    def wait(*, max_wait):
        return max_wait

    with pytest.warns(DeprecationWarning, match="max_wait"):
        assert wait(most_wait=3.0) == 3.0
    with pytest.raises(TypeError, match="both"):
        wait(most_wait=3.0, max_wait=4.0)


@pytest.mark.parametrize(
    ("function", "old", "new"),
    [
        (alternative_paths, "weighings", "edge_weight_sets"),
        (paths_without_canals, "weighing", "edge_weights"),
        (waiting_study, "most_waits", "max_waits"),
        (break_even_power, "most_wait", "max_wait"),
        (PlannedRouteMovable.__init__, "fairways", "leg_planner"),
    ],
)
def test_documented_functions_take_arguments_by_their_old_names(function, old, new):
    with pytest.raises(TypeError, match=f"both '{old}' and '{new}'"):
        function(**{old: None, new: None})


@pytest.fixture(scope="module")
def chart():
    return Chart.open_water(-0.5, 0.5, -0.5, 1.5)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("station_lat", "stations.lat"),
        ("fee", "edges.fee"),
        ("price", "edges.price_factor"),
        ("target", "graph.target"),
        ("via_w", "samples.weight"),
    ],
)
def test_arrays_of_a_network_have_their_old_names(chart, old, new):
    network = lattice(chart, (0.0, 0.0), (0.0, 1.0), spacing=40_000.0)
    part, name = new.split(".")
    with pytest.warns(DeprecationWarning, match=f"use Network.{new}"):
        assert getattr(network, old) is getattr(getattr(network, part), name)
    assert not hasattr(network, "never")


def test_methods_of_a_chart_have_their_old_names(chart):
    with pytest.warns(DeprecationWarning, match=r"use Chart.zones.eca_fraction"):
        assert chart.eca_share(0.0, 0.0, 0.0, 1.0) == 0.0
    with pytest.warns(DeprecationWarning, match=r"use thalweg.chart.ports.PORTS.lookup"):
        assert chart.port("NLRTM").name
    with pytest.warns(DeprecationWarning, match=r"use thalweg.chart.ports.PORTS"):
        assert chart.ports.lookup("NLRTM")
    for old in ("depth_at", "shore_distance", "in_eca", "land", "kernel", "warning_depth_at"):
        with pytest.warns(DeprecationWarning, match=f"Chart.{old} is deprecated"):
            assert getattr(chart, old) is not None
    assert not hasattr(chart, "never")


def test_other_renamed_methods():
    with pytest.warns(DeprecationWarning, match=r"use Sea.provides"):
        assert not Sea.calm().knows("air_pressure_at_mean_sea_level")
    (canal, *_) = Chart.gshhg("c").canals
    with pytest.warns(DeprecationWarning, match=r"use Canal.transit_restriction"):
        assert canal.why_not(draught=99.0, beam=10.0)


def test_an_earlier_stage_of_a_front_is_read_as_that_of_today():
    front = ParetoFront("fuel", "t", np.ones(2), ("polish", "exact"), ("", ""))
    assert front.stages == ("local search", "exact")


def test_limits_may_be_an_array():
    @limits_as_array
    def search(*, limits):
        return limits

    with pytest.warns(DeprecationWarning, match=r"use thalweg.core.limits.Limits"):
        assert search(limits=np.array([5.0, 3.0, np.inf])) == Limits(5.0, 3.0)
    assert search(limits=Limits()) == Limits()


def test_a_package_named_like_a_former_function_can_be_called(chart):
    from thalweg.network import alternatives

    network = lattice(chart, (0.0, 0.0), (0.0, 1.0), spacing=40_000.0)
    with pytest.warns(DeprecationWarning, match="paths_without_canals"):
        (path,) = alternatives(network, chart)
    assert not path.canals
