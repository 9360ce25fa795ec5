"""Times of passage between the nodes of a network, for the isochrones of maps."""

from types import SimpleNamespace

import numpy as np
import pytest

from thalweg.planning.pareto.plan_assembly import _plot_context
from thalweg.planning.plots.stage_passages import interpolated_between


def lattice(rows, columns):
    return np.stack(np.meshgrid(np.arange(columns), np.arange(rows)), axis=-1).reshape(-1, 2) * 1.0


def test_a_plane_is_found_between_the_places_and_nothing_outside_of_them():
    places = lattice(12, 20) + np.array([3.0, 50.0])
    wanted = np.array([[[3.0, 50.0], [7.25, 55.5]], [[22.0, 61.0], [22.1, 55.0]]])
    found = interpolated_between(places, places @ np.array([2.0, -3.0]), wanted)
    assert found.shape == (2, 2)
    assert found[:, 0] == pytest.approx(wanted[:, 0] @ np.array([2.0, -3.0]), rel=1e-12)
    assert found[0, 1] == pytest.approx(7.25 * 2.0 - 55.5 * 3.0, rel=1e-12)
    assert np.isnan(found[1, 1])


def test_places_given_twice_and_nearly_in_a_line_change_nothing():
    # Flat triangles along the edge of the lattice: SciPy's own search is slow at them, not wrong.
    from scipy.interpolate import LinearNDInterpolator

    random = np.random.default_rng(5)
    places = np.concatenate([lattice(9, 9), lattice(1, 9), lattice(1, 9) - [0.0, 1e-13]])
    values = np.hypot(places[:, 0] - 2.2, places[:, 1] - 7.1)
    wanted = random.uniform(0.0, 8.0, (500, 2))
    expected = LinearNDInterpolator(places, values)(wanted)
    found = interpolated_between(places, values, wanted)
    assert (
        np.abs(found - expected).max() < 0.08
    )  # where four places are on a circle either diagonal


def test_places_in_a_line_have_nothing_between_them():
    line = np.arange(5.0)[:, None] * np.array([1.0, 0.5])
    assert np.isnan(interpolated_between(line, line[:, 0], line + 0.1)).all()


def test_times_of_a_map_are_by_one_set_of_canals_where_networks_overlap():
    """Times by the Kiel Canal and round the Skaw, side by side, drew hundreds of closed lines."""

    def explored(lon, arrive, spacing):
        lon = np.asarray(lon, float)
        network = SimpleNamespace(
            lat=np.full(len(lon), 54.0), lon=lon, n_nodes=len(lon),
            meta=SimpleNamespace(spacing_m=spacing),
        )  # fmt: skip
        return SimpleNamespace(
            alternative=SimpleNamespace(network=network),
            fastest=SimpleNamespace(arrive=arrive),
            isochrones=np.full(len(lon), arrive),
        )

    slow = explored([4.02, 5.02, 9.0], 200.0, 65_000.0)
    fast = explored([4.0, 5.0, 6.0], 100.0, 65_000.0)
    context = SimpleNamespace(chart=None, sea=None, ship=None)
    shown = _plot_context(context, [slow, fast])
    assert sorted(zip(shown.lon.tolist(), shown.arrival.tolist())) == [
        (4.0, 100.0), (5.0, 100.0), (6.0, 100.0), (9.0, 200.0),
    ]  # fmt: skip
