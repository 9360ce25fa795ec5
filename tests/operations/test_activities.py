"""Work areas, and the activities of tracks in them."""

import itertools

import numpy as np
import pandas as pd
import pytest

from thalweg.core.errors import InputError
from thalweg.core.geodesy import densify
from thalweg.operations.tracks.activities import SegmentationRules, find_activities
from thalweg.operations.tracks.track_readers import read_tracks
from thalweg.operations.tracks.work_areas import WorkAreas


def box(west, south, east, north, **properties):
    ring = [[west, south], [east, south], [east, north], [west, north], [west, south]]
    return {
        "type": "Feature",
        "properties": properties,
        "geometry": {"type": "Polygon", "coordinates": [ring]},
    }


def collection(*features):
    return {"type": "FeatureCollection", "features": list(features)}


LOADING = box(3.9, 51.95, 4.1, 52.05, activity="dredging")
UNLOADING = box(4.9, 51.95, 5.1, 52.05, activity="pumping ashore")
AREAS = collection(LOADING, UNLOADING)
PIT, BEACH, MIDDLE, PORT = (52.0, 4.0), (52.0, 5.0), (52.0, 4.5), (52.4, 4.0)


def sail(*stops, speed=6.0, interval=60.0):
    """Return a table through places, staying (minutes) at each."""
    time, rows = 0.0, []
    for k, (place, minutes) in enumerate(stops):
        if k:
            before = stops[k - 1][0]
            lat, lon, _ = densify([before[0], place[0]], [before[1], place[1]], speed * interval)
            for la, lo in zip(lat[1:-1], lon[1:-1]):
                time += interval
                rows.append((time, la, lo))
        for _ in range(max(1, int(minutes * 60 / interval))):
            time += interval
            rows.append((time, *place))
    frame = pd.DataFrame(rows, columns=["time", "lat", "lon"])
    return frame.assign(time=pd.to_datetime(frame.time + 1.77e9, unit="s", utc=True))


def kinds(frame, areas=AREAS, **rules):
    log = read_tracks(frame)
    found = find_activities(log, WorkAreas.read(areas), rules=SegmentationRules(**rules))
    for a, b in itertools.pairwise(found):
        assert a.end == pytest.approx(b.start) and a.duration > 0.0
    assert found[0].start == log.time[0] and found[-1].end == log.time[-1]
    return [a.kind for a in found], found


def test_two_cycles():
    names, found = kinds(sail((PIT, 60), (BEACH, 60), (PIT, 60), (BEACH, 60), (PIT, 60)))
    cycle = ["loading", "sailing full", "unloading", "sailing empty"]
    assert names == [*cycle, *cycle, "loading"]
    assert [a.whole for a in found] == [False, *[True] * 7, False]
    assert [a.trip for a in found if a.kind.startswith("sail")] == [0, 1, 2, 3]
    between = 111_320 * np.cos(np.radians(52.0)) * 0.8  # from edge to edge of the areas
    assert found[1].duration == pytest.approx(between / 6.0, rel=0.02)


def test_a_wait_during_a_trip_is_not_sailing():
    names, found = kinds(sail((PIT, 60), (MIDDLE, 90), (BEACH, 60)))
    assert names == ["loading", "sailing full", "waiting", "sailing full", "unloading"]
    assert found[2].duration == pytest.approx(90 * 60, abs=180)
    assert {a.trip for a in found[1:4]} == {0}
    names, _ = kinds(sail((PIT, 60), (MIDDLE, 90), (BEACH, 60)), min_wait=7200.0)
    assert names == ["loading", "sailing full", "unloading"]


def test_an_anchorage_is_waiting_at_any_speed():
    areas = collection(LOADING, UNLOADING, box(4.4, 51.9, 4.6, 52.1, kind="Anchorage 4B"))
    names, _ = kinds(sail((PIT, 60), (BEACH, 60)), areas)
    assert names == ["loading", "sailing full", "waiting", "sailing full", "unloading"]


def test_trips_that_come_back_are_away_unless_they_are_short():
    names, _ = kinds(sail((PIT, 60), (PORT, 120), (PIT, 60), (BEACH, 60)))
    assert names == ["loading", "away", "loading", "sailing full", "unloading"]
    out = (52.0, 4.13)
    names, _ = kinds(sail((PIT, 60), (out, 1), (PIT, 60), (BEACH, 60)))
    assert names == ["loading", "sailing full", "unloading"]
    names, _ = kinds(sail((PIT, 60), (out, 1), (PIT, 60), (BEACH, 60)), short_trip=60.0)
    assert names[:3] == ["loading", "away", "loading"]


def test_activities_with_gaps_are_incomplete():
    frame = sail((PIT, 120), (BEACH, 120), (PIT, 60))
    on_the_way = frame[(frame.lon < 4.3) | (frame.lon > 4.7)]
    names, found = kinds(on_the_way)
    assert names[:4] == ["loading", "sailing full", "not seen", "sailing full"]
    assert not any(a.whole for a in found[:4])
    minute = (frame.time - frame.time.iloc[0]).dt.total_seconds() / 60
    at_work = frame[(minute < 30) | (minute > 90)]
    names, _ = kinds(at_work)
    assert names[0] == "loading" and "not seen" not in names


def test_work_with_a_gap_long_enough_for_a_trip_is_incomplete():
    """Loading, 11 hours without positions, loading again: the loading time is unknown."""
    frame = sail((BEACH, 60), (PIT, 900), (BEACH, 60))
    minute = (frame.time - frame.time.iloc[0]).dt.total_seconds() / 60
    names, found = kinds(frame[(minute < 400) | (minute > 1060)])
    assert names[2] == "loading" and found[2].duration > 15 * 3600.0
    assert not found[2].whole and found[1].whole and found[3].whole
    names, found = kinds(frame[(minute < 400) | (minute > 425)])  # 25 minutes: no trip is so short
    assert names[2] == "loading" and found[2].whole


def test_the_ends_of_a_track():
    names, found = kinds(sail((MIDDLE, 1), (BEACH, 60), (MIDDLE, 1)))
    assert names == ["sailing full", "unloading", "sailing empty"]
    assert [a.whole for a in found] == [False, True, False]


def test_areas_across_the_antimeridian():
    areas = collection(
        box(179.8, -17.0, 180.2, -16.8, activity="loading"),
        box(-179.0, -17.0, -178.8, -16.8, activity="unloading"),
    )
    places = WorkAreas.read(areas).at([-16.9] * 5, [179.9, -179.9, -179.7, -178.9, 181.1])
    assert places.tolist() == [0, 0, -1, 1, 1]


@pytest.mark.parametrize(
    ("features", "told"),
    [
        ([LOADING], "no area for unloading"),
        ([], "no area for loading and none for unloading"),
        ([LOADING, box(4.0, 52.0, 5.0, 52.2, activity="unloading", name="beach")], "overlap"),
        ([LOADING, UNLOADING, box(6, 52, 7, 53)], "Area 3 has no activity"),
        ([LOADING, box(6, 52, 7, 53, activity="unlaoding")], "unloading"),
        ([{"type": "Point", "coordinates": [1, 2]}], "not an area"),
    ],
)
def test_invalid_areas_are_refused(features, told):
    with pytest.raises(InputError, match=told):
        WorkAreas.read(collection(*features))


def test_areas_of_one_activity_may_overlap_and_neighbours_may_touch():
    touching = box(4.1, 51.95, 4.2, 52.05, activity="unloading")
    areas = WorkAreas.read(
        collection(LOADING, box(3.8, 51.9, 4.0, 52.1, activity="load"), touching)
    )
    assert areas.at([52.0, 52.0, 52.0], [3.85, 4.05, 4.15]).tolist() == [0, 0, 1]


def test_a_ship_that_never_comes_is_an_error():
    with pytest.raises(InputError, match="never in an area"):
        kinds(sail(((40.0, 4.0), 10), ((40.0, 5.0), 10)))
    with pytest.raises(InputError):
        SegmentationRules(slow=-1.0)
