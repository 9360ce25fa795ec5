"""Requests that cannot work are refused before the chart and the network are made."""

from __future__ import annotations

import tracemalloc

import numpy as np
import pytest
import xarray as xr

from thalweg import Chart, Sea, Ship, Voyage
from thalweg.cli import option_values
from thalweg.cli.main import main
from thalweg.core.errors import InputError
from thalweg.core.limits import DEEPEST_DRAUGHT
from thalweg.network import lattice
from thalweg.network.regional_lattice import lattice_builder, lattice_size
from thalweg.planning.request.early_checks import check_request
from thalweg.planning.sea_distance import sea_distance


@pytest.fixture
def no_chart(monkeypatch):
    """Make the chart an error: nothing may load it."""

    def refuse(*_):
        raise AssertionError("the chart was loaded")

    monkeypatch.setattr(option_values, "open_chart", refuse)


def heights(tmp_path):
    times = np.datetime64("2026-01-01T00:00", "ns") + np.arange(3) * np.timedelta64(6, "h")
    data = xr.Dataset(
        {"swh": (("time", "lat", "lon"), np.full((3, 3, 3), 1.0), {"units": "m"})},
        {"time": times, "lat": [50.0, 51.0, 52.0], "lon": [1.0, 2.0, 3.0]},
    )
    data.to_netcdf(tmp_path / "height.nc")
    return str(tmp_path / "height.nc")


PLACES = ["plan", "50.5,1.2", "50.5,2.8", "--ship", "kvlcc2"]


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--sea", "{file}"], "--fill wind=0"),
        (["--calm", "--speed", "60"], "60 kn"),
        (["--calm", "--resolution", "1000"], "resolution"),
        (["--calm", "--objective", "fule"], "fuel"),
        (["--calm", "--depth", "absent.nc"], "no file absent.nc"),
        (["--calm", "--zones", "absent.json"], "no file absent.json"),
        (["--sea", "{file}", "--fill", "wind=0", "waves=head_seas", "--depart", "2027-01-01"],
         "outside the data"),
    ],
)  # fmt: skip
def test_cheap_faults_are_found_first(tmp_path, capsys, no_chart, options, words):
    path = heights(tmp_path)
    code = main([*PLACES, *(o.format(file=path) for o in options)])
    assert code not in (0, 1)
    assert words in capsys.readouterr().err


def test_a_lattice_that_does_not_fit_in_memory_is_refused_before_it_is_built(monkeypatch):
    for module in (lattice_builder, lattice_size):
        monkeypatch.setattr(module, "MAX_NODE_BUDGET", 100_000)
    water = Chart.open_water(40.0, 60.0, -20.0, 10.0)
    tracemalloc.start()
    with pytest.raises(InputError, match=r"would have over [\d,]+ nodes and take .* GB") as caught:
        lattice(water, (50.0, -5.0), (50.0, 0.0), spacing=330.0)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert "larger spacing" in caught.value.remedy
    assert peak < 400_000_000  # 11.8 GB once


def test_plans_distances_and_ship_files_refuse_the_same_draughts():
    """A draught of 40 m was planned from Rotterdam to Vlissingen with a note alone."""
    sea, limit = Sea.calm(), "at most 30"
    voyage = Voyage(start=(50.5, 1.2), goal=(50.5, 1.4), depart=0.0)
    deep = Ship.from_speed_function(lambda c: 5.0 + 0.0 * c.wave_height, draught_m=30.5)
    with pytest.raises(InputError, match=limit):
        check_request(voyage, deep, sea)
    with pytest.raises(InputError, match=limit):
        sea_distance("Rotterdam", "Vlissingen", draught_m=30.5)
    with pytest.raises(InputError, match=limit):
        Ship.simple(draught_m=30.5)
    check_request(voyage, Ship.simple(draught_m=DEEPEST_DRAUGHT), sea)
