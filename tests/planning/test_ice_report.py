"""Notes on ice: by the months of sea areas, or by the data."""

from types import SimpleNamespace

import numpy as np
import pytest

from thalweg import Sea
from thalweg.chart.ice_areas import ICE_AREAS
from thalweg.chart.passages import PASSAGES
from thalweg.core.time import parse_time
from thalweg.planning.report.ice_report import (
    ice_notes_of_way,
    ice_warnings,
    way_left_out_notes,
)
from thalweg.planning.report.note_order import count_of_dangers

LULEA_TO_SEA = ([65.3, 64.0, 62.0, 59.0], [22.6, 22.0, 19.5, 20.0])


def route(lat, lon, day):
    depart = parse_time(day)
    time = depart + 3600.0 * np.arange(len(lat))
    samples = {"lat": np.array(lat), "lon": np.array(lon), "time": time}
    return SimpleNamespace(samples=samples, depart=depart)


def test_a_route_through_the_gulf_of_bothnia_in_winter_names_water_and_months():
    first, second = ice_warnings(route(*LULEA_TO_SEA, "2026-02-01"), Sea.calm())
    assert first.startswith("The route reaches the Bothnian Bay in February, from 65 18.0N")
    assert "from December to May" in first and "read the ice charts" in first
    assert second.startswith("The route reaches the Bothnian Sea in February")
    assert count_of_dangers([first, second]) == 2
    assert ice_warnings(route(*LULEA_TO_SEA, "2026-07-01"), Sea.calm()) == []
    (only,) = ice_warnings(route(*LULEA_TO_SEA, "2026-12-10"), Sea.calm())
    assert "Bothnian Bay" in only


def test_ice_of_the_data_counts_where_it_is_known():
    winter = route(*LULEA_TO_SEA, "2026-02-01")
    open_water = Sea.from_functions({"sea_ice_area_fraction": lambda t, lat, lon: 0.0 * lat})
    assert ice_warnings(winter, open_water) == []
    north = Sea.from_functions(
        {"sea_ice_area_fraction": lambda t, lat, lon: np.where(lat > 63.5, 0.7, np.nan)}
    )
    by_data, by_season = ice_warnings(winter, north)
    assert by_data.startswith("The route reaches ice that covers 70 % of the water by the data")
    assert "Bothnian Sea" in by_season


def test_high_latitudes_are_noted_in_all_months():
    (note,) = ice_warnings(route([71.0, 75.0], [20.0, 20.0], "2026-08-01"), Sea.calm())
    assert note.startswith("The route reaches 75 00.0N 020 00.0E, and sea ice is not modelled")


@pytest.mark.parametrize(
    ("name", "lat", "lon", "month"),
    [
        ("Gulf of Finland", 60.0, 25.0, 2),
        ("Gulf of Riga", 57.7, 23.5, 2),
        ("St Lawrence River", 48.8, -68.0, 1),
        ("Gulf of St Lawrence", 48.0, -61.5, 3),
        ("Hudson Bay and Strait", 60.0, -85.0, 6),
        ("White Sea", 65.2, 38.0, 4),
        ("Tatar Strait", 50.0, 141.0, 2),
        ("Bohai", 39.0, 119.5, 1),
        ("Kara Sea", 73.0, 70.0, 11),
        ("south-eastern Barents Sea", 69.5, 52.0, 3),
        ("East Greenland", 70.5, -20.5, 5),
        ("Sea of Azov", 46.0, 36.5, 1),
        ("Southern Ocean inside the limit of icebergs", -54.0, 3.0, 2),
        ("Southern Ocean inside the limit of icebergs", -54.5, -36.5, 12),
        ("Southern Ocean inside the limit of icebergs", -62.0, 179.0, 1),
    ],
)
def test_places_with_ice(name, lat, lon, month):
    found = [area for area in ICE_AREAS if area.contains(lat, lon) and month in area.months]
    assert [area.name for area in found] == [name]


@pytest.mark.parametrize(
    ("lat", "lon"),
    [(55.0, 18.0), (59.0, 20.5), (57.7, 11.0), (70.5, 31.0), (43.0, 135.0), (44.0, -66.5),
     (38.0, 123.5), (47.0, -45.0), (64.0, -53.5), (54.0, -170.0), (44.0, 35.0), (66.5, -25.0),
     (-57.0, -67.0), (-51.7, -57.5), (-45.0, 20.0), (-47.0, 170.0), (-58.0, -150.0)],
)  # fmt: skip
def test_places_without_usual_ice(lat, lon):
    assert not any(area.contains(lat, lon) for area in ICE_AREAS)


def test_passages_with_ice_are_inside_areas():
    for name in ("Belle Isle", "Hudson Strait", "La Perouse (Soya)", "Kara Gate", "Vilkitsky",
                 "Sannikov", "Dmitry Laptev", "Long"):  # fmt: skip
        (passage,) = [one for one in PASSAGES if one.name == name]
        assert any(np.any(area.contains(*passage.positions)) for area in ICE_AREAS), name
        assert "ice" not in passage.note


@pytest.mark.parametrize(
    ("lat", "lon", "months"),
    [
        (-60.0, 85.0, (7, 8, 9, 10, 11)),
        (-57.0, 0.0, (7, 8, 9, 10, 11)),
        (-61.0, -40.0, (1, 5, 6, 7, 8, 9, 10, 11, 12)),
        (-72.0, -40.0, tuple(range(1, 13))),
        (-60.0, -120.0, ()),
        (-61.9, -179.9, ()),
    ],
)
def test_antarctic_pack_ice_reaches_north_until_november(lat, lon, months):
    found = set()
    for area in ICE_AREAS:
        if area.name == "Antarctic pack ice" and area.contains(lat, lon):
            found |= set(area.months)
    assert tuple(sorted(found)) == months


@pytest.mark.parametrize(
    ("lat", "lon", "inside"),
    [
        (-37.0, 80.0, True),  # Durban - Fremantle
        (-34.0, 80.0, False),
        (-34.5, 0.0, True),
        (-33.5, 0.0, False),
        (-34.0, -140.0, True),
        (-42.0, 150.0, False),  # off Tasmania the boundary goes south
        (-30.0, -60.0, False),
    ],
)
def test_the_winter_load_line_applies_in_the_southern_winter_zone(lat, lon, inside):
    found = ice_warnings(route([lat, lat], [lon, lon + 0.5], "2026-07-01"), Sea.calm())
    assert any("winter load line" in note for note in found) == inside
    summer = ice_warnings(route([lat, lat], [lon, lon + 0.5], "2026-01-01"), Sea.calm())
    assert not any("winter load line" in note for note in summer)


def test_a_route_far_south_in_august_notes_pack_ice_icebergs_and_the_winter_load_line():
    south = ([-34.0, -53.0, -60.0, -57.0, -41.5], [18.0, 50.0, 85.0, 120.0, 175.0])
    pack, icebergs, load_line = ice_warnings(route(*south, "2026-08-20"), Sea.calm())
    assert pack.startswith(
        "The route reaches the Antarctic pack ice in August, from 60 00.0S 085 00.0E. "
        "Ice is usual there from July to November (approximate, after NSIDC median ice edges"
    )
    assert icebergs.startswith(
        "The route reaches the Southern Ocean inside the limit of icebergs in August, from 53 00.0S"
    )
    assert "Icebergs are usual there in all months" in icebergs
    assert "16 April to 15 October" in load_line and "winter load line" in load_line
    (icebergs,) = ice_warnings(route(*south, "2026-12-20"), Sea.calm())
    assert "limit of icebergs in December" in icebergs
    assert count_of_dangers([pack, icebergs]) == 2


def test_ways_without_a_date_name_areas_and_months_of_ice():
    (note,) = ice_notes_of_way([(-53.0, 50.0), (-60.0, 85.0), (-57.0, 120.0)])
    assert note == (
        "Ice is usual on the way in: Antarctic pack ice from July to November; "
        "Southern Ocean inside the limit of icebergs in all months."
    )
    assert ice_notes_of_way([(-34.0, 18.0), (-40.0, 80.0), (-41.0, 174.0)]) == ()


@pytest.mark.parametrize(
    ("start", "goal", "miles", "noted"),
    [
        ((69.0, 33.0), (35.4, 139.7), 12659.0, True),  # Murmansk, Yokohama by Suez
        ((69.7, 30.0), (49.3, -123.1), 9438.0, True),  # Kirkenes, Vancouver by Panama
        ((69.0, 33.0), (69.7, 170.3), 2374.0, False),  # Pevek: through the ice
        ((51.9, 4.1), (35.4, 139.7), 11200.0, False),  # Rotterdam: as ships go
        ((69.0, 33.0), (51.9, 4.1), 1700.0, False),
    ],
)
def test_a_way_that_ice_makes_much_longer_is_noted(start, goal, miles, noted):
    notes = way_left_out_notes(start, goal, 1852.0 * miles)
    assert bool(notes) is noted
    assert all("Northern Sea Route" in note for note in notes)
