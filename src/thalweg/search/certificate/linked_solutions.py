"""Solutions on meshes with canals, and round the globe: equal values where edges of a mesh join."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from thalweg.core.types import FloatArray
from thalweg.search.certificate.barrier_mesh import BarrierMesh

_LINK_SLACK = 2e-3  # of the time of a canal, for the values at the centres of cells at its ends
_JOININGS, _JOINING_TOLERANCE = 8, 1.0  # solutions until the edges of a globe join, and [s]


def solve_joined(
    mesh: BarrierMesh,
    solve: Callable[[FloatArray], FloatArray],
    given: FloatArray,
    share: float,
) -> FloatArray:
    """Solve, and again until canals and the joined edges of a mesh round the globe are kept.

    Parameters
    ----------
    solve : Returns a solution for values at nodes that are given, NaN elsewhere.
    share : Of the usual slack along canals.
    """
    slack = share * _LINK_SLACK
    phi = _solve_with_links(mesh, solve, given, slack)
    if not mesh.is_round:
        return phi
    for _ in range(_JOININGS):
        joined = joined_edges(phi)
        lower = joined < phi - _JOINING_TOLERANCE
        if not lower.any():
            break
        given = np.where(lower, np.fmin(given, joined), given)
        phi = _solve_with_links(mesh, solve, given, slack)
    return joined_edges(phi)


def joined_edges(phi: FloatArray) -> FloatArray:
    """Return values on a mesh round the globe that continue beyond its edges.

    The first and the last column are one meridian. Beyond the first and the last row, round the
    poles, the function is constant, as along them.
    """
    joined = phi.copy()
    joined[:, 0] = joined[:, -1] = np.minimum(phi[:, 0], phi[:, -1])
    joined[0] = joined[0].min()
    joined[-1] = joined[-1].min()
    return joined


def _solve_with_links(
    mesh: BarrierMesh,
    solve: Callable[[FloatArray], FloatArray],
    given: FloatArray,
    slack: float,
) -> FloatArray:
    """Solve, and again with lower values at the ends of canals while these allow it.

    Past a canal the barrier may be no more than its time higher than before it, less a share of
    that time for the values at the centres of cells.
    """
    phi = solve(given)
    for _ in range(2 * len(mesh.links)):
        values, changed = given, False
        for source, target, seconds in _one_way_links(mesh):
            most = _least_value(mesh, phi, *source) + (1.0 - slack) * seconds
            j, i = mesh.cell_of(*target)
            corners = slice(j, j + 2), slice(i, i + 2)
            if phi[corners].max() > most + 1.0:
                values = values.copy() if values is given else values
                values[corners] = np.fmin(values[corners], np.minimum(phi[corners], most))
                changed = True
        if not changed:
            break
        given = values
        phi = solve(given)
    return phi


def _one_way_links(
    mesh: BarrierMesh,
) -> Iterator[tuple[tuple[float, float], tuple[float, float], float]]:
    for link in mesh.links:
        yield link.one, link.other, link.seconds
        yield link.other, link.one, link.seconds


def _least_value(mesh: BarrierMesh, phi: FloatArray, lat: float, lon: float) -> float:
    """Return the least value at the corners of the cell of a position."""
    j, i = mesh.cell_of(lat, lon)
    return float(phi[j : j + 2, i : i + 2].min())


def links_kept(mesh: BarrierMesh, phi: FloatArray, centre: FloatArray, known: float) -> bool:
    """Return whether the barrier rises along no canal by more than the time it takes."""
    for source, target, seconds in _one_way_links(mesh):
        before, after = (mesh.value_at(phi, centre, *place) for place in (source, target))
        if before < known and after - before > seconds:
            return False
    return True
