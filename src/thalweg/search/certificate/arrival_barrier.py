"""Barrier functions: search, check and scaling on one mesh."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from thalweg.core.geodesy import inverse
from thalweg.core.types import BoolArray, FloatArray
from thalweg.kernels.certificate.barrier_check import (
    BarrierExcess,
    KeptSpeeds,
    check_barrier,
    closed_throughout,
)
from thalweg.kernels.certificate.barrier_solver import (
    COURSES,
    UNREACHED,
    RingTimes,
    SolvedNodes,
    solve_barrier,
)
from thalweg.kernels.certificate.cell_conditions import ANGLES, SECTORS, TimeWindows
from thalweg.kernels.codes import SPEED_FIELD
from thalweg.search.certificate.barrier_mesh import (
    BarrierMesh,
    plane_at_source,
    strongest_current_near,
)
from thalweg.search.certificate.linked_solutions import joined_edges, links_kept, solve_joined

_KEPT_SHARE = 0.02  # of the step of the data, for windows in which speeds of cells are kept
_BESIDE_BAND = 3  # cells that are solved on either side, so that values on its edge are right
_CAP_RATIO = 1.25  # barriers are cut off at this multiple of the known time
_ROUNDING = 1e-9
_LEAST_FACTOR = 0.05
_SETTLED, _LEAST_GAIN = 1e-3, 2e-4  # excess and gain of a round at which no more are made
_CLOSING_ROUNDS, _CLOSING_MARGIN = 12, 4e-4  # rounds that lower only, and below the limit
_CLOSING_GROWTH = 0.2  # of a correction, from one closing round to the next
_GENTLE_ROUNDS = 3  # closing rounds that correct nodes beside a cell by half only
_DIVISIONS = 3  # of a barrier that closing rounds do not correct
_RAISE = 0.7  # of the slack, where the barrier rises more slowly than it may
_BESIDE_EXCESS = 0.5  # share of an excess by which nodes beside the corners of a cell are corrected


@dataclass(frozen=True, eq=False)
class CheckedBarrier:
    """A barrier function that passed the check.

    Attributes
    ----------
    phi : Values at the nodes [s], (Y, X).
    centre : Values at the centres of the cells [s], (Y - 1, X - 1).
    value : At the position to be bounded [s].
    complete : Whether no checked cell touches the edge of the mesh.
    factor : Factors on the times with which it was solved: a start for finer meshes, (Y, X).
    """

    phi: FloatArray
    centre: FloatArray
    value: float
    complete: bool
    factor: FloatArray


@dataclass(frozen=True, eq=False)
class BarrierTask:
    """What a barrier function on one mesh is for.

    Attributes
    ----------
    source, target : Where the barrier is zero, and where its value is wanted [deg].
    known : Time of a route that exists [s].
    own, other : float64 array (Y - 1, X - 1)
        Lower bounds of the time between the source and each cell, and between it and the target.
    forward : Whether the source is the departure.
    course : Course [rad from north] on which the barrier should rise at the source; by default that
        of the geodesic to the target.
    factor : Factors on the times to begin with (see `finer_factors`), (Y, X); by default 1.
    """

    mesh: BarrierMesh
    source: tuple[float, float]
    target: tuple[float, float]
    known: float
    own: FloatArray
    other: FloatArray
    forward: bool
    course: float | None = None
    factor: FloatArray | None = None

    @property
    def band(self) -> BoolArray:
        """The cells that a route faster than the known one may touch."""
        return np.asarray(self.own + self.other < self.known)

    def counts(self, phi: FloatArray, scale: float = 1.0) -> BoolArray:
        """Return the cells where a faster ship may be as early as a barrier says, once divided."""
        early = np.asarray(cell_minimum(phi) / scale + self.other < self.known)
        return self.band & early & (-cell_minimum(-phi) >= self.own)


def find_barrier(task: BarrierTask, rounds: int) -> CheckedBarrier | None:
    """Return the best barrier found in some rounds of solving, checking and correcting.

    Returns
    -------
    CheckedBarrier or None : None where no function passed the check.
    """
    from scipy import ndimage

    mesh, known = task.mesh, task.known
    shape = mesh.shape
    cells = shape[0] - 1, shape[1] - 1
    windows = _windows(task)
    around = ndimage.binary_dilation(task.band, np.ones((3, 3), bool), iterations=_BESIDE_BAND)
    closed = around.copy()
    may_close = np.zeros(cells, bool)
    closed_throughout(mesh.world, windows, closed, may_close)
    may_close |= (closed | ~around) if may_close.any() else closed
    solvable = nodes_of(around & ~closed, shape)
    latest = windows.last + mesh.world.departures
    node_windows = TimeWindows(_node_minimum(windows.first), -_node_minimum(-latest))
    given = _plane_of_task(task)
    f = np.ones(shape) if task.factor is None else task.factor.copy()
    rings = _no_ring_times(shape)
    found = BarrierExcess(np.empty(cells), np.empty(cells))
    kept = no_kept_speeds(mesh)
    before, closing = -math.inf, 0

    def solve(values: FloatArray) -> FloatArray:
        fixed = ~np.isnan(values)
        phi = np.where(fixed, values, UNREACHED)
        nodes = SolvedNodes(fixed, f, solvable, may_close)
        cap = _CAP_RATIO * known
        solve_barrier(mesh.world, phi, nodes, node_windows, task.forward, cap, rings)
        return np.minimum(phi, _CAP_RATIO * known)

    for number in range(rounds + _CLOSING_ROUNDS):
        phi = solve_joined(mesh, solve, given, 1.0 + closing)
        check_barrier(
            mesh.world, phi, task.counts(phi, 1.3), windows, task.forward, closing > 0, found, kept
        )
        scale = _least_scale(task, phi, found.excess)
        if closing and scale == 0.0:
            return _verified(task, phi, f, windows, kept)
        value = mesh.value_at(phi, found.centre, *task.target) / (1.0 + scale)
        settled = scale < _SETTLED and value - before < _LEAST_GAIN * known
        before = value
        if closing == _CLOSING_ROUNDS:
            return _divided(task, phi, scale, f, windows, kept)
        if closing or number + 1 >= rounds or settled:
            closing += 1
        excess = found.excess + (closing > 0) * _CLOSING_MARGIN
        correct_factors(f, excess, closing)
    return None


def _divided(
    task: BarrierTask,
    phi: FloatArray,
    scale: float,
    factor: FloatArray,
    windows: TimeWindows,
    kept: KeptSpeeds,
) -> CheckedBarrier | None:
    """Divide a barrier that rises too fast in places by its greatest rate, and check it."""
    for _ in range(_DIVISIONS):
        phi = phi / (1.0 + scale + _CLOSING_MARGIN)
        barrier = _verified(task, phi, factor, windows, kept)
        if barrier is not None:
            return barrier
    return None


def first_arrivals(task: BarrierTask) -> FloatArray:
    """Return approximate earliest arrivals at the nodes of a mesh [s]: a hint, not a bound.

    Returns
    -------
    float64 array (Y, X) : Since departure; a multiple of the known time where they are later.
    """
    mesh, shape = task.mesh, task.mesh.shape
    solvable = nodes_of(task.band & ~mesh.world.closed, shape)
    windows = TimeWindows(np.zeros(shape), np.zeros(shape))
    given = np.full(shape, math.nan)
    j, i = mesh.cell_of(*task.source)
    given[j : j + 2, i : i + 2] = mesh.times_to_corners(*task.source)
    phi = np.where(np.isnan(given), UNREACHED, given)
    never = np.zeros((shape[0] - 1, shape[1] - 1), bool)
    nodes = SolvedNodes(~np.isnan(given), np.ones(shape), solvable, never)
    cap = _CAP_RATIO * task.known
    solve_barrier(mesh.world, phi, nodes, windows, True, cap, _no_ring_times(shape))
    return np.minimum(phi, cap)


def _no_ring_times(shape: tuple[int, int]) -> RingTimes:
    """Return room for the times round the nodes of a mesh."""
    return RingTimes(np.zeros((*shape, COURSES), np.float32), np.full(shape, math.nan))


def no_kept_speeds(mesh: BarrierMesh) -> KeptSpeeds:
    """Return room for the speeds in the cells of a mesh, for ships that weather slows down."""
    cells = mesh.shape[0] - 1, mesh.shape[1] - 1
    world = mesh.world
    sectors = SECTORS if world.ship.needs & ANGLES else 1
    if not world.ship.needs or world.raster.channel_index[SPEED_FIELD] >= 0:
        return KeptSpeeds(np.empty((0, 0)), np.empty((0, 0)), np.empty((0, 0, 1), np.float32), 0.0)
    longer = max(_KEPT_SHARE * float(world.raster.times[1] - world.raster.times[0]), 30.0)
    first, last = (np.full(cells, math.nan) for _ in range(2))
    return KeptSpeeds(first, last, np.empty((*cells, sectors), np.float32), longer)


def _verified(
    task: BarrierTask,
    phi: FloatArray,
    factor: FloatArray,
    windows: TimeWindows,
    kept: KeptSpeeds,
) -> CheckedBarrier | None:
    """Check a barrier for good, in every cell that a faster route may touch; None if it fails."""
    mesh = task.mesh
    cells = phi.shape[0] - 1, phi.shape[1] - 1
    found = BarrierExcess(np.empty(cells), np.empty(cells))
    mask = task.counts(phi)
    check_barrier(mesh.world, phi, mask, windows, task.forward, True, found, kept)
    excess, centre = found
    if float(excess[mask].max(initial=-1.0)) > -_ROUNDING or not links_kept(
        mesh, phi, centre, task.known
    ):
        return None
    if mesh.is_round and not np.array_equal(phi, joined_edges(phi)):
        return None
    edges = mask[0].any() or mask[-1].any() or mask[:, 0].any() or mask[:, -1].any()
    edges = edges and not mesh.is_round
    value = mesh.value_at(phi, centre, *task.target)
    return CheckedBarrier(phi, centre, value, not edges, factor)


def _least_scale(task: BarrierTask, phi: FloatArray, excess: FloatArray) -> float:
    """Return the least R with excess <= R in all cells that count once the barrier is scaled."""
    scale = 0.0
    for _ in range(60):
        mask = task.counts(phi, 1.0 + scale)
        needed = max(0.0, float(excess[mask].max(initial=0.0)))
        if needed <= scale:
            break
        scale = needed
    return scale


def _plane_of_task(task: BarrierTask) -> FloatArray:
    """Return the plane at the source, as steep as the local speed over ground allows."""
    course = task.course
    if course is None:
        course = float(inverse(*task.source, *task.target)[1])

    def slowness(rows: slice, columns: slice) -> float:
        current = strongest_current_near(task.mesh, rows, columns)
        return 1.0 / (task.mesh.world.top_speed + current)

    return plane_at_source(task.mesh, task.source, course, slowness)


def correct_factors(f: FloatArray, excess: FloatArray, closing: int) -> None:
    """Lower the factor on the times where the barrier rises too fast, raise it where it may.

    Corners of cells that rise too fast are corrected in full, and nodes beside them by half.
    In the closing rounds nothing is raised, and more is corrected from round to round.
    """
    from scipy import ndimage

    node = -_node_minimum(-excess)
    unused = node <= -1.0
    beside = 1.0 if closing > _GENTLE_ROUNDS else _BESIDE_EXCESS
    np.maximum(node, beside * ndimage.maximum_filter(node, 3), out=node)
    raised = np.minimum(_RAISE * np.maximum(-node, 0.0), _RAISE * (1.0 - f))
    f /= 1.0 + np.where(node > 0.0, (1.0 + _CLOSING_GROWTH * closing) * node, 0.0)
    if not closing:
        f *= 1.0 + np.where((node < 0.0) & ~unused, raised, 0.0)
        f[unused] += _RAISE * (1.0 - f[unused])
    np.clip(f, _LEAST_FACTOR, 1.0, out=f)


def finer_factors(factor: FloatArray) -> FloatArray:
    """Return factors for a mesh with cells of half the size, where deficits are half as large."""
    rows = np.empty((2 * factor.shape[0] - 1, factor.shape[1]))
    rows[::2], rows[1::2] = factor, 0.5 * (factor[1:] + factor[:-1])
    fine = np.empty((rows.shape[0], 2 * rows.shape[1] - 1))
    fine[:, ::2], fine[:, 1::2] = rows, 0.5 * (rows[:, 1:] + rows[:, :-1])
    result: FloatArray = 0.5 + 0.5 * fine
    return result


def _windows(task: BarrierTask) -> TimeWindows:
    """Return the times since departure at which a faster route may be in each cell [s]."""
    if task.forward:
        return TimeWindows(task.own, task.known - task.other)
    return TimeWindows(task.other, np.maximum(task.known - task.own, task.other))


def nodes_of(band: BoolArray, shape: tuple[int, int]) -> BoolArray:
    """Return the nodes of the cells in a band."""
    nodes = np.zeros(shape, bool)
    for rows in (slice(None, -1), slice(1, None)):
        for columns in (slice(None, -1), slice(1, None)):
            nodes[rows, columns] |= band
    return nodes


def cell_minimum(nodes: FloatArray) -> FloatArray:
    """Return for each cell the least value of its four nodes."""
    low = np.minimum(nodes[:-1], nodes[1:])
    return np.minimum(low[:, :-1], low[:, 1:])


def _node_minimum(cells: FloatArray) -> FloatArray:
    """Return for each node the least value of the cells round it."""
    nodes = np.full((cells.shape[0] + 1, cells.shape[1] + 1), np.inf)
    for rows in (slice(None, -1), slice(1, None)):
        for columns in (slice(None, -1), slice(1, None)):
            part = nodes[rows, columns]
            np.minimum(part, cells, out=part)
    return nodes
