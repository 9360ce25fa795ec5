"""The detail 'network' of studies: many departures on one network, as exact as the referee says."""

from __future__ import annotations

from importlib import resources

import numpy as np
import pandas as pd
import pytest
import xarray as xr
import yaml

pytest.importorskip("pyarrow", reason="the extra 'studies' is not installed")

from thalweg.chart import Chart
from thalweg.core.errors import InputError
from thalweg.core.time import parse_time
from thalweg.planning import Voyage
from thalweg.planning.departures.departure_series import DepartureSeries
from thalweg.sea import Sea
from thalweg.ship import Ship
from thalweg.studies import Study, run_study, summarise_study
from thalweg.studies.row_runner import run_rows
from thalweg.studies.study_parts import read_parts

WAVES = "sea_surface_wave_significant_height"
SHAPE = {"layers": 7, "fan": 5, "offset_nm": 4.0}


def weather_file(path, *, months=(1, 2, 3), calm=2, missing=()):
    """Write waves and wind of some months: 2.5 m from ahead, but 0.5 m in the calm month."""
    time = pd.date_range(f"2026-{months[0]:02d}-01", f"2026-{months[-1] + 1:02d}-03", freq="6h")
    height = np.where(time.month == calm, 0.5, 2.5) + 0.2 * np.sin(np.arange(len(time)))
    height[np.isin(time.month, missing)] = np.nan
    shape = (len(time), 2, 2)

    def field(values, units, name):
        full = np.broadcast_to(np.reshape(values, (-1, 1, 1)), shape).astype("f4")
        return ("time", "lat", "lon"), full, {"standard_name": name, "units": units}

    period = "sea_surface_wave_period_at_variance_spectral_density_maximum"
    still = np.zeros(len(time))
    xr.Dataset(
        {
            "hs": field(height, "m", WAVES),
            "tp": field(4.0 + height, "s", period),
            "dir": field(still + 80.0, "degree", "sea_surface_wave_from_direction"),
            "u": field(-4.0 * height, "m s-1", "eastward_wind"),
            "v": field(still, "m s-1", "northward_wind"),
        },
        {
            "time": time,
            "lat": ("lat", [62.0, 68.0], {"units": "degrees_north"}),
            "lon": ("lon", [-2.0, 8.0], {"units": "degrees_east"}),
        },
    ).to_netcdf(path)
    return path


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    made = tmp_path_factory.mktemp("network_detail")
    weather_file(made / "three_months.nc")
    return made


def study(folder, **changes) -> Study:
    data = {
        "ship": "gunnerus-2019", "sea": ["three_months.nc"], "coast": "none", "detail": "network",
        "voyage": {"start": [65.0, 0.0], "goal": [65.0, 2.0], "offing_nm": 0.0, "layered": SHAPE},
        "axes": {"depart": {"from": "2026-01-05", "to": "2026-03-28", "step_h": 240}},
    }  # fmt: skip
    data |= changes
    return Study.from_dict(data, folder)


def test_an_ordered_speed_between_the_settings_of_a_ship_is_sailed():
    ship, day = Ship.load("handysize-bulker"), parse_time("2026-01-01T00:00Z")
    chart = Chart.open_water(44.0, 48.0, -30.0, -10.0)
    knots = np.asarray(ship.speeds) * 3600.0 / 1852.0
    assert np.abs(knots - 13.0).min() > 1.0  # the nearest settings are 10.8 and 14.1 kn
    voyage = Voyage(
        start=(46.0, -24.0), goal=(46.0, -18.0), depart=day, speed_kn=13.0, fuel_price_usd=700.0
    )
    series = DepartureSeries.prepare(
        voyage, ship=ship, sea=Sea.calm(), chart=chart, resolution=40_000.0
    )
    (found,) = series.figures([day])
    assert found["distance_nm"] / found["time_h"] == pytest.approx(13.0, abs=0.02)
    assert series.context.ship.fuel_terms.prices()["fuel_per_t"]["value"] == pytest.approx(700.0)


def without_seconds(rows):
    return [{k: v for k, v in row.items() if k != "seconds"} for row in rows]


def series(folder, **changes) -> DepartureSeries:
    voyage = Voyage(
        **{"start": (65.0, 0.0), "goal": (65.0, 2.0), "depart": "2026-01-05T00:00Z",
           "offing_nm": 0.0, "layered": SHAPE} | changes
    )  # fmt: skip
    return DepartureSeries.prepare(
        voyage,
        ship=Ship.load("gunnerus-2019"),
        sea=Sea.open(folder / "three_months.nc"),
        chart=Chart.open_water(),
        network="layered",
    )


@pytest.mark.slow
def test_figures_are_those_of_the_referee(folder):
    """Time and fuel within 0.1 %, the sick within 1 % of them, for each leg of two sections."""
    prepared = series(folder, via=[(65.05, 1.0)])
    for depart in map(parse_time, ("2026-01-05T00:00Z", "2026-02-10T06:00Z")):
        (figures,) = prepared.figures([depart])
        route = prepared.refereed(depart)
        assert figures["time_h"] == pytest.approx(route.time_h, rel=1e-3)
        assert figures["distance_nm"] == pytest.approx(route.distance_nm, rel=1e-6)
        assert figures["fuel_t"] == pytest.approx(route.fuel_t, rel=1e-3)
        sick = route.indicators["places"]["mess"]["sick_percent"]
        assert figures["sick_percent"] == pytest.approx(sick, rel=1e-2)
        assert figures["inshore_nm"] == route.indicators["inshore_nm"]
        assert 0.3 < figures["max_significant_wave_height_m"] < 2.8


def test_a_season_is_the_same_in_any_order_and_has_its_calm_month(folder, tmp_path):
    rows = study(folder).rows()
    together = run_rows(rows, str(folder))
    assert without_seconds(run_rows(rows[::-1], str(folder))[::-1]) == without_seconds(together)
    assert without_seconds(run_rows(rows[4:5], str(folder))) == without_seconds([together[4]])
    run_study(study(folder), tmp_path / "out", chunk=1)
    summary = summarise_study(tmp_path / "out")
    assert summary.best["month"].tolist() == [2]
    best = summary.best_months.set_index("figure")["month"].to_dict()
    assert best == {"time_h": 2, "fuel_t": 2, "sick_percent": 2}
    rows = read_parts(tmp_path / "out").set_index("depart")["sick_percent"]
    february = rows.index.str.startswith("2026-02")
    assert rows[february].max() < 0.2 * rows[~february].min()


@pytest.mark.slow
def test_routes_are_no_better_than_the_refined_ones(folder):
    row = study(folder, axes={"depart": ["2026-01-05T00:00Z"]}).rows()[0]
    refined = study(folder, axes={"depart": ["2026-01-05T00:00Z"]}, detail="refined").rows()[0]
    coarse, fine = (run_rows([one], str(folder))[0] for one in (row, refined))
    assert coarse["refusal"] is None is fine["refusal"]
    assert fine["time_h"] <= coarse["time_h"] * (1.0 + 1e-3)
    assert coarse["time_h"] <= fine["time_h"] * 1.02
    assert row.id != refined.id


def test_weather_blind_is_the_fastest_path_in_calm_weather(folder):
    wide = study(folder, compare=["weather_blind"])
    for row in run_rows(wide.rows()[:3], str(folder)):
        assert row["blind_feasible"] and row["blind_time_h"] >= row["time_h"] - 1e-6
        assert row["blind_distance_nm"] <= row["distance_nm"] * (1.0 + 1e-6)


def test_a_missing_month_is_rows_that_say_so(folder):
    weather_file(folder / "gap.nc", missing=(2,))
    departs = ["2026-01-05T00:00Z", "2026-02-10T00:00Z", "2026-06-10T00:00Z"]
    rows = run_rows(study(folder, sea=["gap.nc"], axes={"depart": departs}).rows(), str(folder))
    assert [row["refusal"] for row in rows] == [None, "NoRouteError", "OutsidePeriodError"]
    assert "are unknown. The data have gaps" in rows[1]["reason"]
    assert all(row.get("time_h") is None for row in rows[1:])


@pytest.mark.slow
def test_a_missing_member_is_rows_that_say_so(folder):
    """One member has no data, and the last one does not exist."""
    weather_file(folder / "one.nc")
    weather_file(folder / "two.nc", missing=(1, 2, 3, 4))
    with xr.open_dataset(folder / "one.nc") as one, xr.open_dataset(folder / "two.nc") as two:
        xr.concat([one, two], pd.Index([0, 1], name="number")).to_netcdf(folder / "both.nc")
    axes = {"depart": ["2026-01-05T00:00Z"], "member": [0, 1, 2]}
    rows = run_rows(study(folder, sea=["both.nc"], axes=axes).rows(), str(folder))
    assert [row["refusal"] for row in rows] == [None, "OutsideAreaError", "InputError"]
    assert "perhaps with gaps" in rows[1]["reason"] and "member" in rows[2]["reason"]
    assert rows[0]["time_h"] > 0.0 and all(row.get("time_h") is None for row in rows[1:])


@pytest.mark.slow
def test_limits_close_departures_in_words(folder):
    library = resources.files("thalweg.ship.library").joinpath("gunnerus-2019.yaml")
    ship = yaml.safe_load(library.read_text("utf-8")) | {
        "limits": {"max_significant_wave_height_m": 1.5}
    }
    (folder / "careful.yaml").write_text(yaml.safe_dump(ship))
    departs = ["2026-01-05T00:00Z", "2026-02-10T00:00Z"]
    rows = run_rows(
        study(folder, ship="careful.yaml", axes={"depart": departs}).rows(), str(folder)
    )
    assert [row["refusal"] for row in rows] == ["NoRouteError", None]
    assert "wave height" in rows[0]["reason"], rows[0]["reason"]


@pytest.mark.parametrize(
    "changes", [{"objective": "fuel"}, {"depart": None, "arrive": "2026-01-06T00:00Z"}]
)
def test_what_the_detail_is_not_for(folder, changes):
    with pytest.raises(InputError, match="detail 'network'"):
        series(folder, **changes)


def test_unknown_details_are_refused(folder):
    with pytest.raises(InputError, match="detail"):
        study(folder, detail="rough")


def test_workers_open_a_zarr_sea_themselves(folder):
    """The same rows as from NetCDF, from chunks of ten days."""
    pytest.importorskip("zarr", reason="zarr is not installed")
    with xr.open_dataset(folder / "three_months.nc") as data:
        plain = data.load().drop_encoding()
    plain.chunk({"time": 40}).to_zarr(folder / "three_months.zarr", mode="w", consolidated=False)
    axes = {"depart": ["2026-01-05T00:00Z", "2026-02-10T00:00Z"]}
    from_netcdf, from_zarr = (
        run_rows(study(folder, sea=[name], axes=axes).rows(), str(folder))
        for name in ("three_months.nc", "three_months.zarr")
    )
    for a, b in zip(from_netcdf, from_zarr):
        assert a["refusal"] is None is b["refusal"]
        assert (a["time_h"], a["fuel_t"]) == (b["time_h"], b["fuel_t"])
