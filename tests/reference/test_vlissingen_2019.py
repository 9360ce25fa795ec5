"""Vlissingen: 94 constituents of Rijkswaterstaat against its own prediction for 2019.

Rijkswaterstaat publishes the constituents of Vlissingen (analysis of 2009-2012) and the prediction
it made of them, every 10 minutes of 2019, in whole centimetres. Predicting from the constituents
gives 0.61 cm RMSE (largest difference 2.9 cm). What is left is known:

* The official prediction uses the nodal corrections of the middle of the year throughout; with
  those (``nodal_time``) 0.30 cm is left, and nothing over 0.73 cm.
* 0.29 cm is what rounding to whole centimetres alone gives (1 cm / sqrt 12).
* With Schureman's nodal factors in full, not in the shares that Rijkswaterstaat gives them, it is
  1.1 cm.

These are differences between two predictions; the real water differs from both by the weather.
"""

import gzip
import re
from dataclasses import replace

import numpy as np
import pytest

from tests.conftest import data_file
from thalweg.core.time import parse_time
from thalweg.sea import standard_names as nm
from thalweg.sea.tides import schureman
from thalweg.sea.tides.constituent_files import read_constituents

COMPONENTS = "tide/rws_vlissingen_components_hatyan.txt"


@pytest.fixture(scope="module")
def official():
    path = data_file("tide/rws_vlissingen_prediction_2019_hatyan.dia.txt.gz")
    body = gzip.decompress(path.read_bytes()).decode().split("[WRD]")[1]
    values = [v.split("/")[0] for v in re.sub(r"\s", "", body).split(":") if v]
    level = np.array(values, float) / 100.0
    start = parse_time("2019-01-01T00:00+01:00")
    return start + 600.0 * np.arange(level.size), level


@pytest.fixture(scope="module")
def vlissingen():
    return read_constituents(data_file(COMPONENTS))


def _rmse(difference):
    return float(np.sqrt(np.mean(difference**2)))


def test_file_is_read_completely(vlissingen):
    assert len(vlissingen.names) == 94
    assert vlissingen.convention == "rws"
    assert vlissingen.mean[nm.WATER_LEVEL] == pytest.approx([0.01])
    m2 = vlissingen.names.index("M2")
    assert vlissingen.amplitude[nm.WATER_LEVEL][m2] == pytest.approx(1.74666)
    assert vlissingen.phase[nm.WATER_LEVEL][m2] == pytest.approx(59.47 - 28.984104, abs=1e-4)


def test_names_give_the_printed_speeds():
    rows = [r.split() for r in data_file(COMPONENTS).read_text().splitlines() if r[:4] == "COMP"]
    for _, _, speed, _, _, name in rows:
        assert schureman.frequency(name) * 360.0 == pytest.approx(float(speed), abs=2e-6), name


@pytest.mark.slow
def test_prediction_of_2019(official, vlissingen):
    times, level = official
    assert level.size == 365 * 144
    difference = vlissingen.predict(nm.WATER_LEVEL, times)[0] - level
    assert _rmse(difference) < 0.0065
    assert np.abs(difference).max() < 0.03
    assert abs(difference.mean()) < 1e-4


@pytest.mark.slow
def test_what_remains_is_mid_year_nodal_corrections_and_rounding(official, vlissingen):
    times, level = official
    middle = parse_time("2019-07-02T12:00+01:00")
    fixed = vlissingen.predict(nm.WATER_LEVEL, times, nodal_time=middle)[0]
    assert _rmse(fixed - level) < 0.0031
    assert np.abs(fixed - level).max() < 0.0075
    rounded = np.round(fixed, 2) - fixed
    assert _rmse(rounded) == pytest.approx(0.01 / np.sqrt(12.0), rel=0.02)
    full = replace(vlissingen, convention="schureman").predict(nm.WATER_LEVEL, times)[0]
    assert 0.010 < _rmse(full - level) < 0.012


@pytest.mark.slow
def test_observed_levels_follow_the_tide(vlissingen):
    """Clock times of the constants are MET, those of the observations UTC."""
    lines = data_file("tide/rws_vlissingen_waterlevel_20180101_20180401.noos").read_text()
    rows = [r.split() for r in lines.splitlines() if r and r[0] != "#"]
    times = np.array(
        [parse_time(f"{t[:4]}-{t[4:6]}-{t[6:8]}T{t[8:10]}:{t[10:12]}Z") for t, _ in rows]
    )
    level = np.array([float(v) for _, v in rows])
    left = {}
    for minutes in (-60, -20, -10, 0, 10, 20, 60):
        tide = vlissingen.predict(nm.WATER_LEVEL, times + 60.0 * minutes)[0]
        left[minutes] = float((level - tide).var())
    assert min(left, key=left.__getitem__) == 0
    assert 1.0 - left[0] / level.var() > 0.94  # three winter months: surges of 0.32 m
