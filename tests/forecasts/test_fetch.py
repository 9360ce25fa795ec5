"""Forecasts from a server on this computer: the values, faults of servers, resume, gaps."""

from __future__ import annotations

import importlib.util
import json
import zipfile
from dataclasses import replace
from urllib.parse import parse_qs, urlsplit

import numpy as np
import pytest
import xarray as xr

from tests.forecasts.loopback import Recorded, ecmwf_files, gfs_files, messages, serving, wind
from thalweg import Sea
from thalweg.cli.main import main
from thalweg.core.bounding_box import BoundingBox
from thalweg.core.errors import CoverageError, DatasetError, InputError
from thalweg.core.time import parse_time
from thalweg.core.units import HOUR
from thalweg.forecasts import ForecastRequest, estimate_forecast, fetch_forecast
from thalweg.forecasts.download_client import DownloadClient, DownloadPart, TransferError
from thalweg.forecasts.source_table import SOURCES, usual_quantities
from thalweg.forecasts.sources import era5
from thalweg.forecasts.sources.copernicus_marine import CopernicusMarine
from thalweg.forecasts.sources.ecmwf import EcmwfOpenData
from thalweg.forecasts.sources.era5 import Era5
from thalweg.forecasts.sources.gfs import LEAD_HOURS, Gfs, byte_ranges
from thalweg.forecasts.sources.matroos import Matroos
from thalweg.forecasts.sources.open_meteo import OpenMeteo
from thalweg.sea.standard_names import WAVE_HEIGHT, WAVE_PERIOD

pytestmark = pytest.mark.skipif(  # found, not imported: eccodes and pyproj do not share a process
    any(importlib.util.find_spec(name) is None for name in ("requests", "eccodes", "cfgrib")),
    reason="the extra 'fetch' is not installed",
)

RUN = parse_time("2026-11-22T00:00Z")
NOW = RUN + 8 * HOUR
PACIFIC = BoundingBox(-10.0, 11.0, 171.0, -169.0)


def request(**changes) -> ForecastRequest:
    base = ForecastRequest(PACIFIC, RUN + 1 * HOUR, RUN + 8 * HOUR, ("wind",))
    return replace(base, **changes)


@pytest.fixture
def client(tmp_path):
    pauses: list[float] = []
    made = DownloadClient(tmp_path / "cache", pause=pauses.append)
    made.pauses = pauses  # type: ignore[attr-defined]
    return made


@pytest.fixture(scope="module")
def gfs_run():
    recorded = Recorded()
    gfs_files(recorded, RUN, (0, 1, 4, 7, 8))
    return recorded.files


@pytest.fixture
def aws(gfs_run):
    recorded = Recorded()
    recorded.files = dict(gfs_run)
    with serving(recorded) as address:
        yield recorded, Gfs(server="aws", aws=address)


@pytest.mark.slow
def test_gfs_fields_of_a_box_across_the_antimeridian(tmp_path, aws, client):
    recorded, source = aws
    out = tmp_path / "wind.nc"
    done = fetch_forecast(
        request(quantities=("wind", "waves")), source, out, client=client, now=NOW
    )
    assert done.files == (out,) and done.run == RUN
    assert (done.first, done.last) == (RUN + HOUR, RUN + 8 * HOUR)
    with xr.open_dataset(out) as found:
        assert found.attrs["forecast_reference_time"] == "2026-11-22T00:00:00Z"
        assert "public domain" in found.attrs["license"]
        assert found["longitude"].values[[0, -1]].tolist() == [170.0, 192.0]
        assert found["latitude"].values[[0, -1]].tolist() == [-10.0, 12.0]
        lat, lon = np.meshgrid(found["latitude"], found["longitude"], indexing="ij")
        for name in ("u10", "swh", "perpw"):
            for k, hour in enumerate((1, 4, 7, 8)):
                expected = wind(RUN + hour * HOUR, lat, lon)
                assert np.allclose(found[name].values[k], expected, atol=2e-3)
    sample = Sea.open(out).sample(["eastward_wind"], RUN + 4 * HOUR, 4.0, -176.0)
    assert sample["eastward_wind"] == pytest.approx(wind(RUN + 4 * HOUR, 4.0, 184.0), abs=2e-3)
    # only the wanted bytes, and adjacent fields in one range: wind 2, waves 2 of each hour
    assert len(recorded.ranges) == 4 * 4


@pytest.mark.slow
def test_what_has_arrived_is_not_downloaded_again(tmp_path, aws, client):
    recorded, source = aws
    fetch_forecast(request(), source, tmp_path / "a.nc", client=client, now=NOW)
    before = len(recorded.ranges)
    fetch_forecast(request(), source, tmp_path / "b.nc", client=client, now=NOW)
    assert len(recorded.ranges) == before
    with xr.open_dataset(tmp_path / "a.nc") as a, xr.open_dataset(tmp_path / "b.nc") as b:
        xr.testing.assert_equal(a, b)


@pytest.mark.slow
def test_broken_downloads_go_on_where_they_stopped(tmp_path, aws, client):
    recorded, source = aws
    recorded.fault = lambda path, time: "half" if path.endswith("f004") and time == 1 else ""
    fetch_forecast(request(), source, tmp_path / "a.nc", client=client, now=NOW)
    path = next(path for path in recorded.asked if path.endswith("f004"))
    assert recorded.asked[path] == 3  # two ranges, one of them in two pieces
    starts = [int(text.removeprefix("bytes=").partition("-")[0]) for text in recorded.ranges]
    half = len(recorded.files[path]) // 2
    assert any(98 + 8192 <= start <= half for start in starts)  # the rest, not the whole again


@pytest.mark.slow
def test_busy_servers_are_asked_again_after_the_pause_they_want(tmp_path, aws, client):
    recorded, source = aws
    recorded.fault = lambda path, time: "429" if path.endswith("f007") and time < 3 else ""
    fetch_forecast(request(), source, tmp_path / "a.nc", client=client, now=NOW)
    assert client.pauses == [7.0, 7.0]


def test_attempts_are_bounded(tmp_path, aws, client):
    recorded, source = aws
    recorded.fault = lambda path, time: "503" if path.endswith("f007") else ""
    with pytest.raises(TransferError, match="status 503"):
        fetch_forecast(request(), source, tmp_path / "a.nc", client=client, now=NOW)
    assert len(client.pauses) == 4 and not (tmp_path / "a.nc").exists()


def test_a_file_that_went_away_is_named(tmp_path, aws, client):
    recorded, source = aws
    recorded.files = {k: v for k, v in recorded.files.items() if not k.endswith("f004")}
    with pytest.raises(TransferError, match="atmosphere at 2026-11-22T04:00:00Z"):
        fetch_forecast(request(), source, tmp_path / "a.nc", client=client, now=NOW)


def test_the_run_before_is_taken_while_the_latest_is_not_complete(aws, client):
    _, source = aws
    late = request(start=RUN + 7 * HOUR, end=RUN + 8 * HOUR)
    plan = estimate_forecast(late, source, client=client, now=NOW)  # the run of 06 UTC is missing
    assert plan.run == RUN
    assert plan.times == (RUN + 7 * HOUR, RUN + 8 * HOUR)


@pytest.mark.slow
def test_the_estimate_is_the_size_of_the_download(tmp_path, aws, client):
    _, source = aws
    plan = estimate_forecast(request(), source, client=client, now=NOW)
    done = fetch_forecast(request(), source, tmp_path / "a.nc", client=client, now=NOW)
    assert plan.bytes == done.bytes
    with pytest.raises(InputError, match="The download is about"):
        fetch_forecast(
            request(), source, tmp_path / "b.nc", client=client, now=NOW, most_bytes=10.0
        )


def test_nomads_is_asked_for_the_box(client):
    recorded = Recorded()
    with serving(recorded) as address:
        source = Gfs(nomads=address)
        folder = "/pub/data/nccf/com/gfs/prod/gfs.20261122/00/atmos"
        names = [f"{folder}/gfs.t00z.pgrb2.0p25.f{hour:03d}.idx" for hour in range(10)]
        recorded.files = dict.fromkeys(names, b"x")
        plan = estimate_forecast(request(), source, client=client, now=NOW)
    text = plan.parts[0].url
    assert (
        "filter_gfs_0p25.pl" in text
        and "var_UGRD=on" in text
        and "lev_10_m_above_ground=on" in text
    )
    assert "leftlon=170.75" in text and "rightlon=191.25" in text and "toplat=11.25" in text
    assert len(plan.parts) == len(plan.times)


@pytest.mark.slow
def test_ecmwf_members(tmp_path, client):
    recorded = Recorded()
    ecmwf_files(recorded, RUN, (0, 3, 6, 9), members=3)
    with serving(recorded) as address:
        source = EcmwfOpenData(root=address)
        out = tmp_path / "members.nc"
        fetch_forecast(request(members=3), source, out, client=client, now=NOW)
    with xr.open_dataset(out) as found:
        values = found["u10"].transpose("number", "time", "latitude", "longitude")
        assert values.shape[:2] == (3, 4)
        expected = wind(RUN + 6 * HOUR, float(found["latitude"][2]), float(found["longitude"][3]))
        got = values.values[:, 2, 2, 3]
        assert np.allclose(got, expected + np.array([1.0, 2.0, 3.0]), atol=2e-3)
    assert Sea.open(out).members == 3


@pytest.mark.slow
def test_ecmwf_single_forecast(tmp_path, client):
    recorded = Recorded()
    ecmwf_files(recorded, RUN, (0, 3, 6, 9))
    with serving(recorded) as address:
        done = fetch_forecast(
            request(), EcmwfOpenData(root=address), tmp_path / "a.nc", client=client, now=NOW
        )
        recorded.files = {k: v.replace(b"10v", b"XXX") for k, v in recorded.files.items()}
        with pytest.raises(InputError, match="does not list 10v"):
            estimate_forecast(request(), EcmwfOpenData(root=address), client=client, now=NOW)
    assert done.variables == ("u10", "v10")


def open_meteo_answers(recorded: Recorded, *, gap: bool = False) -> None:
    """Let the server compute the answers of Open-Meteo."""

    def answer(handler) -> None:
        query = parse_qs(urlsplit(handler.path).query)
        places = zip(
            map(float, query["latitude"][0].split(",")),
            map(float, query["longitude"][0].split(",")),
        )
        times = [RUN + k * HOUR for k in range(48)]
        answers = []
        for lat, _ in places:
            hourly: dict = {"time": times}
            units = {"time": "unixtime"}
            for name in query["hourly"][0].split(","):
                hourly[name] = [90.0 if "direction" in name else 3.6 + lat for _ in times]
                if gap:
                    hourly[name][3] = None
                units[name] = "°" if "direction" in name else {
                    "wind_speed_10m": "m/s", "ocean_current_velocity": "km/h", "wave_height": "m",
                    "wave_peak_period": "s"}[name]  # fmt: skip
            answers.append({"hourly": hourly, "hourly_units": units})
        body = json.dumps(answers).encode()
        handler.send_response(200)
        handler.send_header("Content-Length", str(len(body)))
        handler.end_headers()
        handler.wfile.write(body)

    recorded.answer = answer  # type: ignore[method-assign]


def test_open_meteo_directions_and_units(tmp_path, client):
    recorded = Recorded()
    open_meteo_answers(recorded)
    wanted = request(quantities=("wind", "current", "waves"), box=BoundingBox(0.0, 1.0, 4.0, 6.0))
    with serving(recorded) as address:
        source = OpenMeteo(weather=f"{address}/w", marine=f"{address}/m")
        fetch_forecast(wanted, source, tmp_path / "a.nc", client=client, now=NOW)
    with xr.open_dataset(tmp_path / "a.nc") as found:
        lat = found["latitude"].values[:, None] + 0.0 * found["longitude"].values
        assert np.allclose(found["eastward_wind"].values[0], -(3.6 + lat))  # it comes from the east
        current = found["eastward_sea_water_velocity"].values[0]
        assert np.allclose(current, (3.6 + lat) / 3.6)  # it goes to the east
        height = found["sea_surface_wave_significant_height"].values[1]
        assert np.allclose(height, 3.6 + lat)
    assert {WAVE_HEIGHT, WAVE_PERIOD} <= set(Sea.open(tmp_path / "a.nc").variables)


def test_a_gap_in_a_delivery_is_named_and_nothing_written(tmp_path, client):
    recorded = Recorded()
    open_meteo_answers(recorded, gap=True)
    wanted = request(box=BoundingBox(0.0, 1.0, 4.0, 6.0), start=RUN, end=RUN + 6 * HOUR)
    with serving(recorded) as address:
        source = OpenMeteo(weather=f"{address}/w", marine=f"{address}/m")
        with pytest.raises(CoverageError, match=r"eastward_wind at 1 of .*T03:00:00Z"):
            fetch_forecast(wanted, source, tmp_path / "a.nc", client=client, now=NOW)
    assert list(tmp_path.glob("*.nc")) == []


def matroos_answers(recorded: Recorded, *, said: bytes = b"", hours: int = 49) -> list[str]:
    """Let the server compute fields on the grid of each request; return the paths as they come."""
    asked: list[str] = []

    def answer(handler) -> None:
        address = urlsplit(handler.path)
        query = {name: values[0] for name, values in parse_qs(address.query).items()}
        asked.append(handler.path)
        if address.path.endswith("get_anal_times.php"):
            body = b"202611220000\n202611220600\n"
        else:
            body = said or matroos_file(query, hours)
        handler.send_response(200)
        handler.send_header("Content-Length", str(len(body)))
        handler.end_headers()
        handler.wfile.write(body)

    recorded.answer = answer  # type: ignore[method-assign]
    return asked


def matroos_file(query: dict[str, str], hours: int) -> bytes:
    """Return fields as the server interpolates them: minutes since 1970, 999 on dry cells."""
    first, last = (
        parse_time(f"{text[:4]}-{text[4:6]}-{text[6:8]}T{text[8:10]}:00Z")
        for text in (query["from"], query["to"])
    )
    times = np.arange(first, min(last, RUN + 3600 * hours) + 1, 3600.0)
    lat = np.linspace(float(query["ymin"]), float(query["ymax"]), int(query["yn"]))
    lon = np.linspace(float(query["xmin"]), float(query["xmax"]), int(query["xn"]))
    field = 0.01 * lat[:, None] + 0.001 * lon + (times - RUN)[:, None, None] * 1e-6
    field[:, 0, 0] = 999.0
    data = {name: (("time", "y", "x"), field) for name in query["color"].split(",")}
    coords = {"time": times / 60.0, "y": lat, "x": lon}
    return xr.Dataset(data, coords).to_netcdf(engine="scipy", format="NETCDF3_64BIT")


NORTH_SEA = BoundingBox(51.0, 52.0, 2.0, 4.0)


def test_matroos_fields_in_pieces_that_the_server_can_give(tmp_path, client, monkeypatch):
    monkeypatch.setattr("thalweg.forecasts.sources.matroos._MOST_VALUES", 10_000)
    recorded, out = Recorded(), tmp_path / "a.nc"
    asked = matroos_answers(recorded)
    wanted = request(quantities=("current", "waves"), box=NORTH_SEA, step=3 * HOUR)
    with serving(recorded) as address:
        done = fetch_forecast(wanted, Matroos(address), out, client=client, now=NOW)
    assert done.run == RUN and (done.first, done.last) == (RUN + HOUR, RUN + 8 * HOUR)
    assert "mean sea level" in done.notes[0] and "1.1 times" in done.notes[1]
    fields = [path for path in asked if "get_matroos" in path]
    assert len(fields) == 2 * 3 and all("anal=202611220000" in path for path in fields)
    with xr.open_dataset(out) as found:
        assert found["time"].size == 4  # hours 1, 4, 7 and 8
        assert "Rijkswaterstaat" in found.attrs["attribution"]
        east = found["eastward_sea_water_velocity"]
        place = {"latitude": 51.5, "longitude": 3.0}
        value = float(east.sel(place, method="nearest")[1])
        assert value == pytest.approx(0.515 + 0.003 + 4 * 0.0036, abs=1e-5)
        assert bool(east[:, 0, 0].isnull().all())  # dry, not still water
    sea = Sea.open(out)
    assert {WAVE_HEIGHT, WAVE_PERIOD} <= set(sea.variables)
    level = sea.sample(["sea_surface_height_above_geopotential_datum"], RUN + 4 * HOUR, 51.5, 3.0)
    assert next(iter(level.values())) == pytest.approx(0.5324, abs=1e-4)


def test_what_matroos_says_instead_of_fields_is_an_error_and_not_kept(tmp_path, client):
    recorded = Recorded()
    matroos_answers(recorded, said=b"<pre>ERROR: no data available</pre>")
    wanted = request(quantities=("current",), box=NORTH_SEA)
    with serving(recorded) as address:
        with pytest.raises(DatasetError, match="no data available"):
            fetch_forecast(wanted, Matroos(address), tmp_path / "a.nc", client=client, now=NOW)
        asked = matroos_answers(recorded)
        fetch_forecast(wanted, Matroos(address), tmp_path / "a.nc", client=client, now=NOW)
    assert any("get_matroos" in path for path in asked)  # the cache has not kept the refusal


def test_hours_that_matroos_leaves_out_are_named(tmp_path, client):
    recorded = Recorded()
    matroos_answers(recorded, hours=5)
    wanted = request(quantities=("current",), box=NORTH_SEA, step=HOUR)
    with serving(recorded) as address, pytest.raises(CoverageError, match="at 3 of 8 times"):
        fetch_forecast(wanted, Matroos(address), tmp_path / "a.nc", client=client, now=NOW)
    assert not (tmp_path / "a.nc").exists()


def test_matroos_refuses_boxes_and_periods_outside_its_models(client):
    recorded = Recorded()
    matroos_answers(recorded)
    with serving(recorded) as address:
        source = Matroos(address)
        with pytest.raises(InputError, match="covers 43 to 64 N"):
            estimate_forecast(request(quantities=("current",)), source, client=client, now=NOW)
        long = request(quantities=("waves",), box=NORTH_SEA, end=RUN + 60 * HOUR)
        with pytest.raises(InputError, match="covers 2026-11-22T00:00:00Z"):
            estimate_forecast(long, source, client=client, now=NOW)


@pytest.mark.slow
def test_era5_month_by_month(tmp_path, monkeypatch):
    monkeypatch.setenv("THALWEG_CACHE", str(tmp_path / "cache"))
    asked = []

    class Client:
        def retrieve(self, dataset, wanted, target):
            asked.append(wanted)
            stamps = [
                parse_time(f"{wanted['year']}-{wanted['month']}-{day}T{time}Z")
                for day in wanted["day"]
                for time in wanted["time"]
            ]
            fields = messages([(n, stamp, 0, 0) for stamp in stamps for n in ("10u", "10v")])
            with open(target, "wb") as file:
                file.write(b"".join(fields))

    start = parse_time("2020-01-31T18:00Z")
    wanted = request(start=start, end=start + 12 * HOUR, step=6 * HOUR)
    out = tmp_path / "era5.nc"
    fetch_forecast(wanted, Era5(Client), out, client=DownloadClient(), now=NOW)
    assert [one["month"] for one in asked] == ["01", "01", "02", "02"]  # both sides of 180 degrees
    assert asked[0]["area"][1] == 170.5 and asked[1]["area"][1] == -180.5
    with xr.open_dataset(out) as found:
        assert found.sizes["time"] == 3
        stamps = found["time"].values.astype("datetime64[s]").astype(float)
        assert stamps.tolist() == [start, start + 6 * HOUR, start + 12 * HOUR]
    count = len(asked)
    fetch_forecast(wanted, Era5(Client), out, client=DownloadClient(), now=NOW)
    assert len(asked) == count


@pytest.mark.parametrize("stamp", [0.0, 0.5])  # start of the hour, as documented; middle, as before
def test_copernicus_marine_on_both_sides_of_the_antimeridian(tmp_path, client, stamp):
    def open_dataset(**wanted):
        assert wanted["start_datetime"] == "2026-11-22T00:00:00Z"
        lat = np.arange(-12.0, 14.0, 0.5)
        lon = np.arange(-180.0, 180.0, 0.5)
        time = RUN + HOUR * (np.arange(24) + stamp)
        shape = len(time), 1, len(lat), len(lon)
        field = np.broadcast_to(lon[None, None, None, :], shape).copy()
        stamps = (time * 1e9).astype("int64").astype("datetime64[ns]")
        axes = {"time": stamps, "depth": [0.494], "latitude": lat, "longitude": lon}
        names = {name: (tuple(axes), field) for name in wanted["variables"]}
        whole = xr.Dataset(names, axes)
        return whole.sel(
            longitude=slice(wanted["minimum_longitude"], wanted["maximum_longitude"]),
            latitude=slice(wanted["minimum_latitude"], wanted["maximum_latitude"]),
        )

    source = CopernicusMarine(open_dataset)
    fetch_forecast(request(quantities=("current",), step=HOUR), source, tmp_path / "c.nc",
                   client=client, now=NOW)  # fmt: skip
    with xr.open_dataset(tmp_path / "c.nc") as found:
        lon = found["longitude"].values
        assert lon[0] <= 171.0 and lon[-1] >= 191.0 and np.allclose(np.diff(lon), 0.5)
        assert np.allclose(found["uo"].values[0, 0], np.where(lon < 180.0, lon, lon - 360.0))
        first = found["time"].values[0].astype("datetime64[s]")
        assert str(first) == "2026-11-22T00:30:00"  # the middle of the hour


def test_an_archive_of_era5_is_unpacked(tmp_path):
    path = tmp_path / "a.grib"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("wind.grib", b"GRIB1")
        archive.writestr("waves.grib", b"GRIB2")
    era5._unpack(path)
    era5._unpack(path)  # what is none stays
    assert path.read_bytes() == b"GRIB1GRIB2"


def test_sources_have_usual_quantities():
    for name, source in SOURCES.items():
        assert set(usual_quantities(name)) <= set(source.quantities)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"end": RUN}, "The end is after the start"),
        ({"step": 0.5 * HOUR}, "whole number of hours"),
        ({"quantities": ("snow",)}, "snow"),
        ({"members": -1}, "members"),
    ],
)
def test_wrong_requests(changes, words):
    with pytest.raises(InputError, match=words):
        request(**changes)


def test_steps_of_a_run():
    wanted = request(start=RUN + 118 * HOUR, end=RUN + 127 * HOUR, step=HOUR)
    assert wanted.steps(RUN, LEAD_HOURS) == [118, 119, 120, 123, 126, 129]
    wanted = request(start=RUN + 4 * HOUR, end=RUN + 20 * HOUR, step=6 * HOUR)
    assert wanted.steps(RUN, LEAD_HOURS) == [4, 10, 16, 20]
    with pytest.raises(InputError, match="covers"):
        request(end=RUN + 390 * HOUR).steps(RUN, LEAD_HOURS)


def test_ranges_of_an_index():
    index = "1:0:d=1:A:x:f:\n2:100:d=1:B:x:f:\n3:250:d=1:C:y:f:\n4:300:d=1:D:z:f:"
    assert byte_ranges(index, ["B:x", "C:y"]) == ((100, 200),)
    assert byte_ranges(index, ["D:z", "A:x"]) == ((0, 100), (300, -1))
    with pytest.raises(InputError, match="E:x"):
        byte_ranges(index, ["E:x"])


def test_a_server_without_ranges_is_asked_for_the_whole_file_again(client):
    recorded = Recorded()
    recorded.files = {"/filter": bytes(range(256)) * 400}
    recorded.fault = lambda path, time: "half" if time == 1 else "whole"
    with serving(recorded) as address:
        path = client.file(DownloadPart(f"{address}/filter"))
    assert path.read_bytes() == recorded.files["/filter"]


def test_no_network_is_said_at_once(client):
    part = DownloadPart("http://127.0.0.1:9/x")
    with pytest.raises(TransferError, match="cannot be reached") as caught:
        client.file(part)
    assert client.pauses == [] and "--sea" in str(caught.value)


def test_the_cache_forgets_the_oldest(tmp_path, client):
    import os

    client.folder.mkdir()
    for k in range(4):
        path = client.folder / str(k)
        path.write_bytes(b"x" * 100)
        os.utime(path, (k, k))
    client.prune(250)
    assert sorted(path.name for path in client.folder.iterdir()) == ["2", "3"]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["nosuch", "--box", "0,1,2,3", "--from", "2026-01-01", "--to", "2026-01-02"], "not known"),
        (["gfs"], "--box and --from and --to not given"),
        (["gfs", "--box", "0,1,2", "--from", "2026-01-01", "--to", "2026-01-02"], "four numbers"),
        (
            ["open-meteo", "--box", "0,1,2,3", "--from", "2026-01-01", "--to", "2026-01-02",
             "--quantities", "ice", "--estimate"],
            "has no ice",
        ),
    ],
)  # fmt: skip
def test_the_command_line_refuses(capsys, words, message):
    assert main(["fetch", *words]) == 2
    assert message in capsys.readouterr().err


def test_the_command_line_lists_the_sources(capsys):
    assert main(["fetch", "--json"]) == 0
    names = [row["source"] for row in json.loads(capsys.readouterr().out)]
    assert names == ["gfs", "ecmwf", "open-meteo", "matroos", "rws", "copernicus", "era5"]
