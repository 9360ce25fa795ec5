"""The graph of all seas, kept in memory and on disk."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from thalweg.core.arrays.array_cache import load_or_make, remove_oldest
from thalweg.core.cache_folder import cache_folder
from thalweg.network.global_grid.endpoint_attachment import ConnectedWaters
from thalweg.network.global_grid.grid import FORMAT
from thalweg.network.global_grid.sea_graph import (
    NEAR_LAND_FACTOR,
    OFFING,
    RESOLUTION,
    SeaGraph,
    make_sea_graph,
)

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.chart.depth.shoals import Shoals
    from thalweg.core.types import FloatArray

_GRAPHS_KEPT: Final = 6  # on disk
_DRAUGHTS_KEPT: Final = 8  # on disk, of each graph
_FORMAT: Final = 7  # increase when the arrays or their construction change


def sea_graph(chart: Chart) -> SeaGraph:
    """Return the graph of a chart's coastline and canals, from memory or disk if made before.

    Parameters
    ----------
    chart : Zones, depth, the area and the offing of the chart are not used.
    """
    return _load_or_make(_request(chart))


def edge_excess(chart: Chart, shoals: Shoals) -> FloatArray:
    """Return by how much a mile counts more on each edge of the graph of a chart.

    Those of the last few draughts are kept on disk.

    Parameters
    ----------
    chart : As of `sea_graph`.

    Returns
    -------
    ndarray : 0 or more, float64 (E,); not to be changed.
    """
    return _excess(_request(chart), shoals)


def _request(chart: Chart) -> _GraphRequest:
    bare = type(chart)(
        chart.coastline,
        canals=chart.canals,
        passages=chart.passages,
        closed_passages=chart.closed_passages,
    )
    lines = [(passage.name, passage.line) for passage in chart.passages]
    facts = (FORMAT, _FORMAT, bare.fingerprint(), RESOLUTION, OFFING, NEAR_LAND_FACTOR, lines)
    name = hashlib.sha256(repr(facts).encode()).hexdigest()[:16]
    return _GraphRequest(bare, cache_folder("globe") / f"sea-{name}.npz")


@dataclass(frozen=True)
class _GraphRequest:
    """A graph to make, and its file in the cache; two requests for one file are equal."""

    chart: Chart
    path: Path

    def __hash__(self) -> int:
        return hash(self.path)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _GraphRequest) and other.path == self.path


@lru_cache(maxsize=2)
def _load_or_make(request: _GraphRequest) -> SeaGraph:
    return load_or_make(
        request.path,
        lambda: make_sea_graph(request.chart),
        pack=_graph_arrays,
        unpack=_graph,
        clean=lambda folder: remove_oldest(folder.glob(f"sea-{'?' * 16}.npz"), _GRAPHS_KEPT),
    )


@lru_cache(maxsize=2)
def _excess(request: _GraphRequest, shoals: Shoals) -> FloatArray:
    graph = _load_or_make(request)
    elsewhere = _excess_elsewhere(request, shoals.elsewhere)
    if not shoals.harbours:
        return elsewhere
    return graph.shoal_excess_round_harbours(shoals, elsewhere)


@lru_cache(maxsize=2)
def _excess_elsewhere(request: _GraphRequest, shoals: Shoals) -> FloatArray:
    graph = _load_or_make(request)
    facts = _FORMAT, shoals.text(), hashlib.sha256(shoals.arrays.code.tobytes()).hexdigest()
    layer = hashlib.sha256(repr(facts).encode()).hexdigest()[:16]
    path = request.path.with_name(f"{request.path.stem}-shoals-{layer}.npz")

    def unpack(arrays: Mapping[str, NDArray[Any]]) -> FloatArray:
        excess = arrays["excess"]
        if excess.shape != graph.target.shape or excess.dtype != np.float64:
            raise ValueError("not the excess of the edges of this graph")
        return excess

    def clean(folder: Path) -> None:
        remove_oldest(folder.glob(f"{request.path.stem}-shoals-*"), _DRAUGHTS_KEPT)

    return load_or_make(
        path,
        lambda: graph.shoal_excess(shoals),
        pack=lambda excess: {"excess": excess},
        unpack=unpack,
        clean=clean,
    )


def _graph_arrays(graph: SeaGraph) -> dict[str, NDArray[Any]]:
    waters = graph.waters
    return {
        "lat": waters.lat,
        "lon": waters.lon,
        "water": waters.water,
        "size": waters.size,
        "reach": np.array(waters.reach),
        "indptr": graph.indptr,
        "target": graph.target,
        "weight": graph.weight,
        "canal": graph.canal,
    }


def _graph(arrays: Mapping[str, NDArray[Any]]) -> SeaGraph:
    lat, lon, water, size = (arrays[name] for name in ("lat", "lon", "water", "size"))
    waters = ConnectedWaters(lat, lon, water, size, float(arrays["reach"]))
    graph = SeaGraph(waters, *(arrays[n] for n in ("indptr", "target", "weight", "canal")))
    n, e = len(waters.lat), len(graph.target)
    if len(graph.indptr) != n + 1 or int(graph.indptr[-1]) != e or int(graph.target.max()) >= n:
        raise ValueError("the arrays do not fit together")
    if not len(graph.weight) == len(graph.canal) == e:
        raise ValueError("the arrays do not fit together")
    return graph
