"""GRIB 1 and 2: written by eccodes in a separate process, decoded in another."""

from __future__ import annotations

import importlib.util
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from tests.sea.small_datasets import value
from thalweg.core.errors import DatasetError
from thalweg.core.time import parse_time
from thalweg.sea import Sea
from thalweg.sea.files import grib_worker
from thalweg.sea.files.grib import check_messages

pytestmark = pytest.mark.skipif(
    importlib.util.find_spec("eccodes") is None or importlib.util.find_spec("cfgrib") is None,
    reason="the extra 'grib' is not installed",
)

HS = "sea_surface_wave_significant_height"
WRITER = """
import sys
import numpy as np
import eccodes as ec

path, edition, mode = sys.argv[1], int(sys.argv[2]), sys.argv[3]
names = {"wind": ["10u", "10v"], "waves": ["swh", "mwd", "pp1d"]}[mode]
lat, lon = np.linspace(52.0, 50.0, 5), np.linspace(358.0, 362.0, 9)
with open(path, "wb") as stream:
    for hour in range(4):
        for k, name in enumerate(names):
            h = ec.codes_grib_new_from_samples(f"regular_ll_sfc_grib{edition}")
            ec.codes_set(h, "Ni", 9); ec.codes_set(h, "Nj", 5)
            ec.codes_set(h, "latitudeOfFirstGridPointInDegrees", 52.0)
            ec.codes_set(h, "latitudeOfLastGridPointInDegrees", 50.0)
            ec.codes_set(h, "longitudeOfFirstGridPointInDegrees", 358.0)
            ec.codes_set(h, "longitudeOfLastGridPointInDegrees", 2.0)
            ec.codes_set(h, "iDirectionIncrementInDegrees", 0.5)
            ec.codes_set(h, "jDirectionIncrementInDegrees", 0.5)
            ec.codes_set(h, "dataDate", 20260101)
            ec.codes_set(h, "dataTime", 0)
            ec.codes_set(h, "stepRange", str(hour))
            ec.codes_set(h, "shortName", name)
            ec.codes_set(h, "bitsPerValue", 24)
            y, x = np.meshgrid(lat, lon, indexing="ij")
            values = 1.0 + k + 0.1 * hour + 0.2 * (y - 50.0) + 0.3 * (x - 358.0)
            if name == "mwd":
                values = 0.0 * values + 90.0
            ec.codes_set(h, "missingValue", 9999.0)
            if name == "swh":
                values[0, 0] = 9999.0
                ec.codes_set(h, "bitmapPresent", 1)
            ec.codes_set_values(h, values.ravel())
            ec.codes_write(h, stream)
            ec.codes_release(h)
"""


def grib(tmp_path: Path, edition: int, mode: str) -> Path:
    """Write a GRIB file of one forecast run of four hours."""
    path = tmp_path / f"{mode}{edition}.grib"
    script = tmp_path / "writer.py"
    script.write_text(WRITER)
    done = subprocess.run(
        [sys.executable, str(script), str(path), str(edition), mode], capture_output=True, text=True
    )
    if not path.exists() or path.stat().st_size == 0:
        pytest.skip(f"eccodes cannot write here: {done.stderr[-200:]}")
    script.unlink()
    return path


@pytest.mark.slow
@pytest.mark.parametrize("edition", [1, 2])
def test_wind_of_both_editions(tmp_path, edition) -> None:
    path = grib(tmp_path, edition, "wind")
    sea = Sea.open(path)
    time = parse_time("2026-01-01T01:30Z")
    got = sea.sample(["eastward_wind", "northward_wind"], time, 50.7, [-1.25, 0.75])
    expected = 1.0 + 0.15 + 0.2 * 0.7 + 0.3 * np.array([0.75, 2.75])
    assert got["eastward_wind"] == pytest.approx(expected, abs=1e-4)
    assert got["northward_wind"] == pytest.approx(expected + 1.0, abs=1e-4)
    assert sorted(p.name for p in tmp_path.iterdir()) == [path.name]


@pytest.mark.slow
def test_waves_with_missing_values(tmp_path) -> None:
    sea = Sea.open(grib(tmp_path, 1, "waves"))
    time = parse_time("2026-01-01T02:00Z")
    got = sea.sample([HS, "sea_surface_wave_to_direction"], time, [51.0, 51.9], [0.0, -1.9])
    assert got[HS][0] == pytest.approx(1.0 + 0.2 + 0.2 + 0.6, abs=1e-4)
    assert np.isnan(got[HS][1])
    assert got["sea_surface_wave_to_direction"][0] == pytest.approx(270.0)


@pytest.mark.slow
@pytest.mark.parametrize("share", [0.45, 0.97])
def test_truncated(tmp_path, share) -> None:
    path = grib(tmp_path, 2, "wind")
    assert check_messages(path) == 8
    cut = tmp_path / "cut.grib"
    cut.write_bytes(path.read_bytes()[: int(path.stat().st_size * share)])
    with pytest.raises(DatasetError, match="truncated or damaged"):
        Sea.open(cut)


@pytest.mark.slow
def test_corrupt_inside_a_message_does_not_end_the_process(tmp_path) -> None:
    path = grib(tmp_path, 2, "wind")
    data = bytearray(path.read_bytes())
    for k in range(20, 60):
        data[k] = 255
    bad = tmp_path / "bad.grib"
    bad.write_bytes(bytes(data))
    with pytest.raises(DatasetError, match=r"bad\.grib"):
        Sea.open(bad)


@pytest.mark.slow
@pytest.mark.parametrize(
    "order", ["import cfgrib, pyproj", "import pyproj, cfgrib", "import pyproj"]
)
def test_every_import_order_beside_pyproj(tmp_path, order) -> None:
    path = grib(tmp_path, 2, "wind")
    code = (
        f"{order}\n"
        "from thalweg.sea import Sea\n"
        "from thalweg.core.geodesy import distance\n"
        "import sys, os\n"
        f"sea = Sea.open({str(path)!r})\n"
        "got = sea.sample(['eastward_wind'], 1767225600.0, 51.0, 0.0)['eastward_wind']\n"
        "sys.stdout.write(f'{float(got):.3f} {float(distance(0, 0, 0, 1)):.0f}')\n"
        "sys.stdout.flush()\n"
        "os._exit(0)\n"  # at exit the libraries themselves may crash when a user imported both
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.stdout == "1.800 111319", done.stderr[-500:]


@pytest.mark.slow
def test_plain_use_exits_cleanly(tmp_path) -> None:
    path = grib(tmp_path, 1, "wind")
    code = f"from thalweg.sea import Sea\nSea.open({str(path)!r}).describe()\n"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr[-500:]


@pytest.mark.slow
def test_temporary_arrays_are_removed_with_the_sea(tmp_path, monkeypatch) -> None:
    monkeypatch.setenv("TMPDIR", str(tmp_path / "scratch"))
    (tmp_path / "scratch").mkdir()
    import tempfile

    monkeypatch.setattr(tempfile, "tempdir", None)
    path = grib(tmp_path, 2, "wind")
    sea = Sea.open(path)
    assert value(sea, "eastward_wind", parse_time("2026-01-01"), 51.0, 0.0) == pytest.approx(
        1.8, abs=1e-4
    )
    assert len(list((tmp_path / "scratch").glob("thalweg-grib-*"))) == 1
    del sea
    import gc

    gc.collect()
    assert list((tmp_path / "scratch").glob("thalweg-grib-*")) == []


@pytest.mark.parametrize("tail", [b"GRIB hello", b"GRIB\0\0\0\1", b"GRIB" + bytes(20)])
def test_a_header_without_a_message(tmp_path, tail) -> None:
    path = tmp_path / "head.grb"
    path.write_bytes(tail)
    with pytest.raises(DatasetError, match="truncated or damaged"):
        Sea.open(path)


def test_runs_with_steps_become_one_axis_of_valid_times_in_order() -> None:
    """Two runs of a forecast, the later one first in the file, as ``(time, step)``."""
    hour = np.timedelta64(3600, "s").astype("timedelta64[ns]")
    time = np.array(["2026-01-01T12", "2026-01-01T00"], "datetime64[ns]")
    step = np.array([0, 6]) * hour
    data = xr.Dataset(
        {"swh": (("time", "step", "y"), np.array([[[12.0], [18.0]], [[0.0], [6.0]]]))},
        {
            "time": time,
            "step": step,
            "valid_time": (("time", "step"), time[:, None] + step[None, :]),
        },
    )
    found = grib_worker.with_valid_time(data)
    assert found["swh"].dims == ("valid_time", "y")
    assert found["swh"].values[:, 0].tolist() == [0.0, 6.0, 12.0, 18.0]
    hours = (found["valid_time"].values - time[1]) / hour
    assert hours.tolist() == [0.0, 6.0, 12.0, 18.0]
