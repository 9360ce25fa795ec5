"""Compilation of the search kernels in a second process (`thalweg.kernels.compilation.warm_up`),
and of those of the certificate in a third.
"""

from __future__ import annotations

import contextlib
import subprocess
import sys

import numpy as np

from thalweg.core.geodesy import inverse
from thalweg.core.limits import Limits
from thalweg.kernels import codes
from thalweg.kernels.compilation.compiled_code_cache import COMPILED_FOLDER
from thalweg.network import Edges, Graph, Network, NetworkMeta, Samples, Stations

_CELLS = 24  # of the mesh of a certificate, along the geodesic


def search_is_compiled() -> bool:
    """Return whether the kernels of the search have been compiled for this computer."""
    return (COMPILED_FOLDER / "warm").exists()  # marker of `warm_up`


def compile_search() -> None:
    """Search and smooth a stretch between two nodes in open water, to compile the kernels.

    Another process compiles those of the certificate: a third of the whole, used last.
    """
    certificate = None
    if sys.executable and not getattr(sys, "frozen", False):
        with contextlib.suppress(OSError):
            command = [sys.executable, "-c", f"import {__name__} as k; k.compile_certificate()"]
            quiet = subprocess.DEVNULL
            certificate = subprocess.Popen(command, stdin=quiet, stdout=quiet, stderr=quiet)
    try:
        _search_and_smooth()
    finally:
        if certificate is not None:
            certificate.wait()


def compile_certificate() -> None:
    """Bound a stretch in open water, to compile the kernels."""
    from thalweg.sea import Sea
    from thalweg.search.certificate.barrier_check_cost import USUAL_SECONDS_A_CELL
    from thalweg.search.certificate.barrier_domain import BarrierDomain, StretchToBound
    from thalweg.search.certificate.barrier_mesh import ShipInBarrier
    from thalweg.search.certificate.time_certificate import BarrierSearch
    from thalweg.ship import Ship

    table = Ship.load("handysize-bulker").tabulate()
    top = float(table.largest(0))
    ship = ShipInBarrier(table.kernel_arrays(), 0, Limits(wave_height=8.0).array, top)
    length, _, _ = inverse(0.0, 0.0, 0.0, 1.0)
    waves = (codes.WIND_EAST, codes.WIND_NORTH, codes.WAVE_HEIGHT_CHANNEL)
    known = 1.1 * float(length) / top
    stretch = StretchToBound(Sea.calm(), None, ship, waves, (0.0, 0.0), (0.0, 1.0), 0.0, known)
    domain = BarrierDomain.around(stretch, _CELLS)
    assert domain is not None  # the stretch is short
    BarrierSearch(stretch, domain, _CELLS, USUAL_SECONDS_A_CELL[1]).refine()


def _search_and_smooth() -> None:
    from thalweg.route import Track, smooth
    from thalweg.sea import GridFields, StationFields
    from thalweg.search import ShipOnNetwork, earliest_arrival, lower_bound
    from thalweg.ship import Ship

    network = _two_nodes()
    times = np.array([0.0, 7200.0])
    index = np.full(codes.CHANNEL_COUNT, -1)
    index[[codes.WIND_EAST, codes.WIND_NORTH, codes.WAVE_HEIGHT_CHANNEL]] = [0, 1, 2]
    stations = StationFields(times, np.zeros((2, 2, 3), np.float32), index)
    table = Ship.load("handysize-bulker").tabulate()
    limits = Limits(wave_height=8.0)
    ship = ShipOnNetwork(network, stations, table, setting=0, limits=limits, top_speed=10.0)
    earliest_arrival(ship, start=0, goal=1, depart=0.0)
    lower_bound(ship, start=0, goal=1, depart=0.0)
    raster = GridFields(times, -0.1, 0.1, -0.1, 0.1, np.zeros((2, 4, 4, 3), np.float32), index)
    track = Track([0.0, 0.02, 0.0], [0.0, 0.05, 0.1], 0.0, None, [0, 0])  # type: ignore[arg-type]
    smooth(track, table=table, fields=raster, limits=limits)


def _two_nodes() -> Network:
    lat, lon = np.zeros(2), np.array([0.0, 0.1])
    length, _, _ = inverse(0.0, 0.0, 0.0, 0.1)
    ones = np.ones(2, np.float32)
    return Network(
        Stations(lat, lon, n_nodes=2),
        Graph(np.array([0, 1, 2]), target=np.array([1, 0], np.int32)),
        Edges(
            length=np.full(2, float(length)),
            course=np.radians([90.0, 270.0]).astype(np.float32),
            depth=np.full(2, np.inf, np.float32),
            penalty_factor=ones,
            price_factor=ones,
        ),
        Samples.none(2),
        can_wait=np.ones(2, np.bool_),
        meta=NetworkMeta("two nodes", 11_000.0, 2, np.pi / 8),
    )
