"""Water levels of a station from a server on this computer, as Rijkswaterstaat answers."""

from __future__ import annotations

import importlib.util
import json
import math
from collections.abc import Callable
from typing import Any

import pytest
import xarray as xr

from tests.forecasts.loopback import Recorded, serving
from thalweg import Sea
from thalweg.core.bounding_box import BoundingBox
from thalweg.core.errors import CoverageError, DatasetError, InputError
from thalweg.core.time import format_time, parse_time
from thalweg.core.units import HOUR
from thalweg.forecasts import ForecastRequest, estimate_forecast, fetch_forecast
from thalweg.forecasts.download_client import DownloadClient, TransferError
from thalweg.forecasts.sources.rws_station import RwsStation
from thalweg.sea.standard_names import WATER_LEVEL

pytestmark = pytest.mark.skipif(
    importlib.util.find_spec("requests") is None, reason="the extra 'fetch' is not installed"
)

START = parse_time("2026-11-22T00:00Z")
NOW = START + 8 * HOUR  # measured to here, expected to four hours later, then astronomical
HOOK = BoundingBox(51.9, 52.1, 3.8, 4.3)
CATALOGUE = {
    "Succesvol": True,
    "AquoMetadataLijst": [
        {"AquoMetadata_MessageID": 1, "Grootheid": {"Code": "WATHTE"}},
        {"AquoMetadata_MessageID": 2, "Grootheid": {"Code": "WINDSHD"}},
    ],
    "AquoMetadataLocatieLijst": [
        {"AquoMetaData_MessageID": 1, "Locatie_MessageID": 10},
        {"AquoMetaData_MessageID": 1, "Locatie_MessageID": 11},
        {"AquoMetaData_MessageID": 2, "Locatie_MessageID": 12},
    ],
    "LocatieLijst": [
        {
            "Locatie_MessageID": 10,
            "Code": "made.hook",
            "Naam": "Made Hook",
            "Lat": 51.98,
            "Lon": 4.1,
        },
        {"Locatie_MessageID": 11, "Code": "made.far", "Naam": "Far", "Lat": 53.2, "Lon": 5.4},
        {"Locatie_MessageID": 12, "Code": "made.wind", "Naam": "Wind", "Lat": 52.0, "Lon": 4.05},
    ],
}


def tide(moment: float) -> float:
    """A made tide [m]."""
    return math.sin((moment - START) * 2.0 * math.pi / (12.42 * HOUR))


def local(moment: float) -> str:
    """A time as the service writes it, one hour ahead of UTC."""
    return format_time(moment + HOUR).replace("Z", ".000+01:00")


def series(
    process: str, begin: float, end: float, added: float, *, grouped: str = "", unit: str = "cm"
) -> dict[str, Any]:
    """Levels every ten minutes, raised by an amount [m] that tells the processes apart."""
    moments = [begin + 600.0 * k for k in range(int((end - begin) / 600.0) + 1)]
    return {
        "AquoMetadata": {
            "Grootheid": {"Code": "WATHTE"},
            "Groepering": {"Code": grouped},
            "Eenheid": {"Code": unit},
            "Hoedanigheid": {"Code": "NAP"},
            "ProcesType": process,
        },
        "MetingenLijst": [
            {
                "Tijdstip": local(moment),
                "Meetwaarde": {"Waarde_Numeriek": round(100.0 * (tide(moment) + added), 1)},
                "WaarnemingMetadata": {"Kwaliteitswaardecode": "00"},
            }
            for moment in moments
        ],
    }


def all_series() -> list[dict[str, Any]]:
    end = START + 24 * HOUR
    return [
        series("astronomisch", START, end, 0.5),
        series("verwachting", START, START + 12 * HOUR, 0.2),
        series("meting", START, NOW, 0.0),
        series("astronomisch", START, end, 7.0, grouped="GETETBRKD2"),
    ]


def station_answers(recorded: Recorded, rows: Callable[[], Any] = all_series) -> list[Any]:
    """Let the server answer as the service does; return the bodies as they come."""
    asked: list[Any] = []

    def answer(handler: Any) -> None:
        body = json.loads(handler.rfile.read(int(handler.headers["Content-Length"])))
        asked.append(body)
        found = rows()
        if handler.path.endswith("OphalenCatalogus"):
            found = CATALOGUE
        elif isinstance(found, list):
            found = {"Succesvol": True, "WaarnemingenLijst": found}
        data = b"" if found is None else json.dumps(found).encode()
        handler.send_response(200 if data else 204)
        handler.send_header("Content-Length", str(len(data)))
        handler.end_headers()
        handler.wfile.write(data)

    recorded.answer = answer  # type: ignore[method-assign]
    return asked


def request(hours: float = 18.0, box: BoundingBox = HOOK) -> ForecastRequest:
    return ForecastRequest(box, START, START + hours * HOUR, ("level",))


@pytest.fixture
def client(tmp_path):
    return DownloadClient(tmp_path / "cache", pause=lambda seconds: None)


def test_the_level_of_the_nearest_station_is_a_uniform_sea(tmp_path, client):
    recorded, out = Recorded(), tmp_path / "level.nc"
    asked = station_answers(recorded)
    with serving(recorded) as address:
        done = fetch_forecast(request(), RwsStation(address), out, client=client, now=NOW)
        fetch_forecast(request(), RwsStation(address), tmp_path / "b.nc", client=client, now=NOW)
    assert "Made Hook" in done.notes[0] and "whole box" in done.notes[0]
    assert len([body for body in asked if "Locatie" in body]) == 1  # the second is in the cache
    assert asked[1]["Locatie"] == {"Code": "made.hook"}
    assert asked[1]["Periode"]["Begindatumtijd"] == "2026-11-22T00:00:00.000+00:00"
    with xr.open_dataset(out) as found:
        assert found[WATER_LEVEL].shape == (18 * 6 + 1, 2, 2)
        words = found[WATER_LEVEL].attrs["comment"]
        assert "above NAP" in words and "measured to 2026-11-22T08:00:00Z" in words
        assert "expected to 2026-11-22T12:00:00Z" in words and "astronomical" in words
        assert "Rijkswaterstaat" in found.attrs["attribution"]
    sea = Sea.open(out)
    for hour, added in ((5.5, 0.0), (10.0, 0.2), (17.0, 0.5)):
        moment = START + hour * HOUR
        for lat, lon in ((51.95, 3.9), (52.09, 4.29)):
            level = sea.sample([WATER_LEVEL], moment, lat, lon)[WATER_LEVEL]
            assert float(level) == pytest.approx(tide(moment) + added, abs=1e-3)
    outside = sea.sample([WATER_LEVEL], START + HOUR, 52.5, 4.0)[WATER_LEVEL]
    assert math.isnan(float(outside))


def test_long_periods_are_requested_month_by_month(client):
    recorded = Recorded()
    station_answers(recorded)
    with serving(recorded) as address:
        plan = estimate_forecast(request(70 * 24.0), RwsStation(address), client=client, now=NOW)
    assert len(plan.parts) == 3 and len({part.body for part in plan.parts}) == 3


@pytest.mark.parametrize(
    ("box", "word"),
    [
        (BoundingBox(50.0, 54.0, 2.0, 6.0), "60 nm"),
        (BoundingBox(51.0, 51.2, 2.0, 2.3), "Made Hook"),
    ],
)
def test_a_box_that_is_large_or_has_no_station_is_refused(client, box, word):
    recorded = Recorded()
    station_answers(recorded)
    with serving(recorded) as address, pytest.raises(InputError) as refusal:
        estimate_forecast(request(box=box), RwsStation(address), client=client, now=NOW)
    assert word in str(refusal.value) and refusal.value.details["field"] == "box"


def test_hours_without_a_level_are_named(tmp_path, client):
    recorded = Recorded()
    station_answers(recorded, lambda: [series("meting", START, START + 5 * HOUR, 0.0)])
    with serving(recorded) as address, pytest.raises(CoverageError, match="at 13 of 19 times"):
        fetch_forecast(request(), RwsStation(address), tmp_path / "a.nc", client=client, now=NOW)
    assert list(tmp_path.glob("*.nc")) == []


@pytest.mark.parametrize(
    ("rows", "error", "word"),
    [
        (lambda: {"Succesvol": False, "Foutmelding": "te druk"}, DatasetError, "te druk"),
        (lambda: [series("meting", START, NOW, 0.0, unit="dm")], DatasetError, "'dm'"),
        (lambda: None, TransferError, "does not have Made Hook"),
        (lambda: [], CoverageError, "at 19 of 19"),
    ],
)
def test_what_the_service_says_instead_of_levels_is_an_error(tmp_path, client, rows, error, word):
    recorded = Recorded()
    station_answers(recorded, rows)
    with serving(recorded) as address, pytest.raises(error, match=word):
        fetch_forecast(request(), RwsStation(address), tmp_path / "a.nc", client=client, now=NOW)


def test_missing_values_are_not_levels(tmp_path, client):
    def rows() -> list[dict[str, Any]]:
        found = series("meting", START, START + 18 * HOUR, 0.0)
        for k, one in enumerate(found["MetingenLijst"]):
            if k % 6:
                one["WaarnemingMetadata"]["Kwaliteitswaardecode"] = "99"
                one["Meetwaarde"]["Waarde_Numeriek"] = 999999999.0
        return [found]

    recorded, out = Recorded(), tmp_path / "a.nc"
    station_answers(recorded, rows)
    with serving(recorded) as address:
        fetch_forecast(request(), RwsStation(address), out, client=client, now=NOW)
    with xr.open_dataset(out) as found:
        assert found["time"].size == 19 and float(abs(found[WATER_LEVEL]).max()) <= 1.0
