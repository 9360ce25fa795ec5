"""Tides of a model run: harmonic analysis at every node of a layer, cached on disk."""

from __future__ import annotations

import hashlib
import json
import warnings
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from thalweg.core.arrays.array_cache import load_or_make
from thalweg.core.cache_folder import cache_folder
from thalweg.core.errors import InputError, ThalwegWarning
from thalweg.core.types import FloatArray
from thalweg.sea import standard_names as nm
from thalweg.sea.ensemble_layer import check_not_ensemble
from thalweg.sea.grids.grid_protocol import grid_positions
from thalweg.sea.grids.gridded_layer import GridLayer
from thalweg.sea.grids.source_variables import GridWindow
from thalweg.sea.layer import Layer
from thalweg.sea.tides import harmonic_analysis
from thalweg.sea.tides.constituents import Constituents

TIDAL_VARIABLES: Final = (nm.EASTWARD_CURRENT, nm.NORTHWARD_CURRENT, nm.WATER_LEVEL)
CACHE_VERSION: Final = 1  #: of the cached analyses


def has_tides(layer: Layer) -> bool:
    """Return whether a layer holds currents or water levels over time at nodes."""
    if not isinstance(layer, GridLayer) or layer.period is None:
        return False
    return bool(set(TIDAL_VARIABLES) & layer.variables)


def tidal_analysis(
    layers: Sequence[Layer],
    *,
    constituents: Sequence[str] | None = None,
    rayleigh: float = harmonic_analysis.RAYLEIGH,
    progress: harmonic_analysis.ProgressCallback | None = None,
    cache: bool = True,
) -> harmonic_analysis.TideAnalysis:
    """Return the tides of the first layer that has any; other arguments as `analyse_layer`.

    Parameters
    ----------
    layers : The layers of a sea.

    Warns
    -----
    ThalwegWarning : If other layers hold currents or levels too.
    """
    check_not_ensemble(layers)
    tidal = [x for x in layers if isinstance(x, GridLayer) and has_tides(x)]
    if not tidal:
        raise no_tides_error()
    layer = tidal[0]
    left = sorted(set(TIDAL_VARIABLES) & {name for other in tidal[1:] for name in other.variables})
    if left:
        warnings.warn(
            f"{', '.join(left)} on another grid or at other times is not analysed; Sea.from_tides "
            "analyses all grids.",
            ThalwegWarning,
            stacklevel=2,
        )
    return analyse_layer(
        layer, constituents=constituents, rayleigh=rayleigh, progress=progress, cache=cache
    )


def no_tides_error() -> InputError:
    """Return the error for a sea without currents or levels to analyse."""
    return InputError(
        "The sea holds no currents or water levels on a grid or mesh over time.",
        "Tides are analysed at the nodes of files opened with Sea.open.",
        "Open the model run, or give Constituents.",
    )


def analyse_layer(
    layer: GridLayer,
    *,
    constituents: Sequence[str] | None = None,
    rayleigh: float = harmonic_analysis.RAYLEIGH,
    progress: harmonic_analysis.ProgressCallback | None = None,
    cache: bool = True,
) -> harmonic_analysis.TideAnalysis:
    """Return the tides of currents and water level at every grid point of a layer.

    The result is cached on disk.

    Parameters
    ----------
    layer : A layer with currents or water level over time.
    constituents, rayleigh, progress : As for `thalweg.sea.tides.harmonic_analysis.analyse`.
    cache : Whether the result is read from and written to the cache folder.
    """
    times = layer.axis.times
    names = harmonic_analysis.select_constituents(times, constituents, rayleigh)
    rows, columns = layer.grid.shape
    lat, lon = grid_positions(layer.grid)

    def make() -> harmonic_analysis.TideAnalysis:
        window = GridWindow(0, times.size, 0, rows, 0, columns)
        series: dict[str, Any] = {}
        for quantity in layer.quantities:
            if set(quantity.names) & set(TIDAL_VARIABLES):
                values = quantity.read(window, columns)
                series.update({n: values[n].T for n in quantity.names if n in TIDAL_VARIABLES})
        return harmonic_analysis.analyse(
            times, series, lat=lat, lon=lon, constituents=names, rayleigh=rayleigh,
            progress=progress,
        )  # fmt: skip

    if not cache:
        return make()
    unpack = partial(_analysis, lat=lat, lon=lon)
    return load_or_make(_cache_path(layer, names), make, pack=_arrays, unpack=unpack)


def _cache_path(layer: GridLayer, names: Sequence[str]) -> Path:
    key = [
        CACHE_VERSION,
        dict(layer.provenance()),
        list(names),
        harmonic_analysis.MIN_KNOWN_FRACTION,
        _sample_digest(layer),
    ]
    text = json.dumps(key, sort_keys=True, default=str)
    return cache_folder("tides") / f"{hashlib.sha256(text.encode()).hexdigest()[:32]}.npz"


def _sample_digest(layer: GridLayer) -> str:
    """Return a hash of the values at the middle time.

    Two files may have the same name, size and modification time.
    """
    rows, columns = layer.grid.shape
    middle = layer.axis.times.size // 2
    digest = hashlib.sha256(np.ascontiguousarray(layer.axis.times).tobytes())
    for quantity in layer.quantities:
        if set(quantity.names) & set(TIDAL_VARIABLES):
            values = quantity.read(GridWindow(middle, middle + 1, 0, rows, 0, columns), columns)
            for name in quantity.names:
                digest.update(np.ascontiguousarray(values[name]).tobytes())
    return digest.hexdigest()


def _arrays(analysis: harmonic_analysis.TideAnalysis) -> dict[str, NDArray[Any]]:
    constants = analysis.constituents
    arrays: dict[str, NDArray[Any]] = {
        "names": np.array(constants.names),
        "record": np.array([analysis.start, analysis.end]),
    }
    for name in constants.variables:
        arrays[f"amplitude:{name}"] = constants.amplitude[name]
        arrays[f"phase:{name}"] = constants.phase[name]
        arrays[f"mean:{name}"] = constants.mean[name]
        arrays[f"share:{name}"] = analysis.tidal_share[name]
        arrays[f"variance:{name}"] = analysis.variance[name]
    return arrays


def _analysis(
    arrays: Mapping[str, NDArray[Any]], lat: FloatArray, lon: FloatArray
) -> harmonic_analysis.TideAnalysis:
    parts: dict[str, dict[str, FloatArray]] = {}
    for key, value in arrays.items():
        kind, _, name = key.partition(":")
        parts.setdefault(kind, {})[name] = value
    names = tuple(str(name) for name in arrays["names"])
    constants = Constituents(
        names, parts["amplitude"], parts["phase"], parts["mean"], lat, lon, "foreman"
    )
    start, end = (float(x) for x in arrays["record"])
    return harmonic_analysis.TideAnalysis(constants, parts["share"], parts["variance"], start, end)
