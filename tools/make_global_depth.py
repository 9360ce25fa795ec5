"""Make the depth layer of the package, ``src/thalweg/chart/data/depth_6min.npz``, from ETOPO1.

    python tools/make_global_depth.py GRID.nc

GRID.nc holds the bed version of ETOPO1 (NOAA, public domain; doi:10.7289/V5C8276M) at every tenth
of a degree: ``elevation`` [m] on ``lat`` from -90 to 90 and ``lon`` from -180 to 179.9. Coding, one
byte a point: 0 for land, otherwise one more than the depth in whole metres, at most 254. Low land
between the tropics that lies in the sea of the coastline GSHHG h (``pip install "thalweg[hires]"``)
is reef: water of no depth.
"""

import sys
from pathlib import Path

import numpy as np
import xarray as xr

from thalweg.chart import Chart

DRYING = 2  # points up to this height [m] count as water of no depth: flats that dry
DEEPEST = 254  # [m]
REEF_LATITUDE = 30.0  # [deg]
REEF_HEIGHT = 30  # [m]; higher points are islands that ETOPO1 has at another place
#: Least and greatest distance of reefs from land [nautical miles]; farther off are errors.
REEF_OFF_LAND = 1.5, 10.0
OUT = Path(__file__).parents[1] / "src/thalweg/chart/data/depth_6min.npz"


def main() -> None:
    """Write the layer."""
    with xr.open_dataset(sys.argv[1]) as data:
        elevation = data["elevation"].transpose("lat", "lon").values.astype(np.int32)
        lat, lon = data["lat"].values, data["lon"].values
    assert elevation.shape == (1801, 3600)
    assert np.allclose(lat[[0, -1]], (-90.0, 90.0)) and np.allclose(lon[[0, -1]], (-180.0, 179.9))
    depth = np.clip(-elevation, 0, DEEPEST)
    code = np.where(elevation > DRYING, 0, depth + 1).astype(np.uint8)
    code[reefs(elevation, code, lat, lon)] = 1
    np.savez_compressed(OUT, code=code, south=-90.0, west=-180.0, spacing=0.1)
    print(f"{OUT}: {OUT.stat().st_size / 1e6:.2f} MB")


def reefs(
    elevation: np.ndarray, code: np.ndarray, lat: np.ndarray, lon: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the indices of points of land that are reefs in the sea of the coastline."""
    water = code > 0
    beside_water = np.zeros_like(water)
    for axis, step in ((0, 1), (0, -1), (1, 1), (1, -1)):
        beside_water |= np.roll(water, step, axis)
    low = ~water & (elevation <= REEF_HEIGHT) & (np.abs(lat) <= REEF_LATITUDE)[:, None]
    row, column = np.nonzero(low & beside_water)
    coastline = Chart.gshhg("h").coastline
    off = coastline.shore_distance(lat[row], lon[column], cap=1.1 * REEF_OFF_LAND[1] * 1852.0)
    miles = np.asarray(off) / 1852.0
    found = (miles >= REEF_OFF_LAND[0]) & (miles <= REEF_OFF_LAND[1])
    return row[found], column[found]


if __name__ == "__main__":
    main()
