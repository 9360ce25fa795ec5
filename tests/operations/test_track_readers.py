"""Reading and cleaning tracks: formats of columns and times, with a note on every change."""

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from thalweg.core.errors import InputError
from thalweg.core.geodesy import direct
from thalweg.core.time import parse_time
from thalweg.core.units import KNOT
from thalweg.operations.tracks.track_cleaning import CleaningRules
from thalweg.operations.tracks.track_readers import read_tracks

START = parse_time("2026-03-01T00:00Z")


def straight(count=20, step=60.0, speed=5.0):
    """Sail east along 52 N."""
    lat, lon = direct(52.0, 4.0, np.radians(90.0), speed * step * np.arange(count))
    time = pd.to_datetime(START + step * np.arange(count), unit="s", utc=True)
    return pd.DataFrame({"time": time, "lat": lat, "lon": lon})


def write(tmp_path, text):
    path = tmp_path / "track.csv"
    path.write_text(text)
    return path


@pytest.mark.parametrize(
    "text",
    [
        "MMSI,BaseDateTime,LAT,LON,SOG,COG,Draft\n"
        "244,2026-03-01T00:00:00,52.0,4.0,10.0,90.0,5\n244,2026-03-01T00:01:00,52.0,4.004,10,90,5\n",
        "# Timestamp,MMSI,Latitude,Longitude,SOG,COG,Draught\n"
        "01/03/2026 00:00:00,244,52.0,4.0,10.0,90.0,5\n"
        "13/03/2026 00:01:00,244,52.0,4.004,10,90,5\n",
        "time;lat;lon;speed [m/s];course;draught (m)\n"
        "1772323200;52,0;4,0;5,14444;90;5,0\n1772323260;52,0;4,004;5,14444;90;5,0\n",
        "Date,Time,Lat,Lng,sog_kn,course_deg,draft_dm\n"
        "2026-03-01,00:00:00,52.0,4.0,10.0,90,50\n2026-03-01,00:01:00,52.0,4.004,10.0,90,50\n",
        "date_time_utc\tlatitude_deg\tlongitude_deg\tSpeed (km/h)\tCOG\tdraught\n"
        "2026-03-01 00:00\t52.0\t4.0\t18.52\t90\t5\n2026-03-01 00:01\t52.0\t4.004\t18.52\t90\t5\n",
        "\ufefftimestamp,lat,lon,speed_over_ground_knots,cog,draught\n"
        "1772323200000,52.0,4.0,10,90,5\n1772323260000,52.0,4.004,10,90,5\n",
        "timestamp,lat,lon,sog,cog,draught\n"
        "2026-03-01T01:00:00+01:00,52.0,4.0,10,90,5\n2026-03-01T00:01:00Z,52.0,4.004,10,90,5\n",
    ],
    ids=["us", "danish", "semicolons", "date+time", "tabs", "ms+bom", "zones"],
)
def test_dialects(tmp_path, text):
    log = read_tracks(write(tmp_path, text))
    assert len(log) == 2
    assert log.time[0] == START
    assert (log.lat[1], log.lon[1]) == (52.0, 4.004)
    assert log.values["speed"] == pytest.approx(10 * KNOT, rel=1e-4)
    assert log.values["course"] == pytest.approx(np.pi / 2)
    assert log.values["draught"] == pytest.approx(5.0)


def test_given_columns_have_priority_and_assumed_units_are_reported(tmp_path):
    text = "t,y,x,speed,power\n2026-03-01,52,4,10,3000\n2026-03-01T00:01,52,4.004,10,3000\n"
    log = read_tracks(write(tmp_path, text), columns={"time": "t", "lat": "y", "lon": "x"})
    assert log.values["power"] == pytest.approx(3e6)
    assert any("'speed' is taken to be in kn" in note for note in log.notes)
    assert any("'power' is taken to be in kw" in note for note in log.notes)


def test_values_that_ais_calls_absent_are_unknown():
    frame = straight(3).assign(SOG=[5.0, 102.3, 5.0], COG=[90.0, 360.0, 90.0])
    log = read_tracks(frame)
    assert np.isnan(log.values["speed"]).tolist() == [False, True, False]
    assert np.isnan(log.values["course"]).tolist() == [False, True, False]
    assert log.speeds()[1] == pytest.approx(5.0, rel=1e-6)  # from the positions


def test_speeds_in_the_wrong_unit_are_doubted():
    frame = straight(30)
    in_metres = read_tracks(frame.assign(speed=5.0))  # read as knots
    assert any("0.51 times" in note for note in in_metres.notes)
    for right in (frame.assign(speed_m_s=5.0), frame.assign(sog=5.0 / KNOT), frame):
        assert not any("times those" in note for note in read_tracks(right).notes)


def test_rows_are_sorted_and_duplicates_removed_with_notes():
    frame = straight(10)
    shuffled = frame.sample(frac=1.0, random_state=3)
    double = pd.concat([shuffled, frame.iloc[[4]], frame.iloc[[5]].assign(lat=52.001)])
    log = read_tracks(double)
    assert len(log) == 10 and (np.diff(log.time) == 60.0).all()
    assert log.lat == pytest.approx(frame.lat.to_numpy())
    assert log.removed == {
        "that repeat a time and position": 1,
        "that give a time another position": 1,
    }
    told = " ".join(log.notes)
    assert "sorted" in told and "1 that repeat a time and position" in told


def test_positions_off_the_globe_and_times_unread_are_left_out():
    frame = straight(6).astype({"time": str})
    frame.loc[1, "lat"], frame.loc[2, "lon"], frame.loc[3, "time"] = 91.0, 181.0, "soon"
    frame.loc[4, "lat"] = np.nan
    log = read_tracks(frame)
    assert len(log) == 2
    assert log.removed == {"without a readable time": 1, "without a position on the globe": 3}


def test_outliers_are_removed_and_lasting_jumps_split_the_track():
    frame = straight(30)
    frame.loc[7, "lat"] += 1.0
    frame.loc[[12, 13], "lon"] += 2.0
    log = read_tracks(frame)
    assert log.removed == {"out of reach at the highest speed": 3}
    assert len(log) == 27 and not log.broken.any()
    away = straight(30)
    away.loc[15:, "lat"] += 1.0
    log = read_tracks(away)
    assert not log.removed and np.flatnonzero(log.broken).tolist() == [14]
    assert "1 jumps faster than 40 kn" in " ".join(log.notes)


def test_a_first_position_elsewhere_is_dropped():
    frame = straight(30)
    frame.loc[0, "lat"] = 0.0
    log = read_tracks(frame)
    assert len(log) == 29 and log.lat.min() > 51.0


def test_gaps_are_marked_and_reported():
    frame = straight(40).drop(index=range(10, 25))
    log = read_tracks(frame, cleaning=CleaningRules(longest_gap=600.0))
    assert np.flatnonzero(log.broken).tolist() == [9]
    assert "1 gaps of more than 10 min, 0.3 h in all" in " ".join(log.notes)
    assert not read_tracks(frame).broken.any()


def test_one_ship_of_several_must_be_chosen():
    both = pd.concat([straight(5).assign(mmsi=1), straight(7).assign(mmsi=2)])
    with pytest.raises(InputError, match="2 named ships") as caught:
        read_tracks(both)
    assert caught.value.details["vessels"] == ["1", "2"]
    log = read_tracks(both, vessel=2)
    assert len(log) == 7 and log.vessel == "2"
    with pytest.raises(InputError, match="'3' was requested"):
        read_tracks(both, vessel="3")
    assert read_tracks(straight(5).assign(mmsi=1)).vessel == "1"


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "cannot be read"),
        ("a,b,c\n1,2,3\n", "time or lat or lon"),
        ("time,lat\n2026-01-01,1\n", "has no column for lon"),
        ("time,lat,lon\n2026-01-01,1,2\n", "Only 1 of the positions"),
        ("time,lat,lon\n", "Only 0 of the positions"),
        ("time,lat,lon\n03/04/2026 01:00,52,4\n04/04/2026 01:00,52,4.1\n", "can be read as"),
        ("time,lat,lon\nsoon,52,4\nlater,52,4.1\n", "cannot be read"),
        ("time,lat,lon\n12.5,52,4\n13.5,52,4.1\n", "cannot be read as times"),
        ("time,lat,lon\n2026-01-01,520,4\n2026-01-02,520,4.1\n", "2 without a position"),
    ],
)
def test_files_without_tracks_are_refused(tmp_path, text, told):
    with pytest.raises(InputError, match=told):
        read_tracks(write(tmp_path, text))


def test_ambiguous_dates_are_read_when_the_format_is_given(tmp_path):
    text = "time,lat,lon\n03/04/2026 01:00,52,4\n04/04/2026 01:00,52,4.1\n"
    log = read_tracks(write(tmp_path, text), time_format="%d/%m/%Y %H:%M")
    assert log.time[0] == parse_time("2026-04-03T01:00Z")


def test_wrong_requests(tmp_path):
    with pytest.raises(InputError, match="cannot be read"):
        read_tracks(tmp_path / "none.csv")
    with pytest.raises(InputError, match="are wrong"):
        read_tracks(straight(), columns={"latt": "lat"})
    with pytest.raises(InputError, match="are wrong"):
        read_tracks(straight(), columns={"lat": "latt"})
    for rules in ({"longest_gap": 0.0}, {"fastest": np.nan}, {"max_outliers": -1}):
        with pytest.raises(InputError):
            CleaningRules(**rules)


@pytest.mark.slow
@given(
    bad=st.sets(st.integers(1, 58), max_size=8),
    order=st.randoms(use_true_random=False),
    far=st.floats(0.5, 60.0),
)
def test_scattered_outliers_never_survive(bad, order, far):
    """Single outliers, in any order of rows, leave the clean track and their number."""
    bad = {b for b in bad if not {b - 1, b + 1} & bad}
    frame = straight(60)
    clean = frame.drop(index=sorted(bad))
    frame.loc[sorted(bad), "lat"] -= far
    rows = list(range(60))
    order.shuffle(rows)
    log = read_tracks(frame.iloc[rows])
    assert log.lat == pytest.approx(clean.lat.to_numpy())
    assert log.removed.get("out of reach at the highest speed", 0) == len(bad)


def test_a_long_stretch_out_of_reach_is_left_out():
    """A receiver that was wrong for half an hour: no part of the track."""
    frame = straight(120)
    clean = frame.drop(index=range(40, 70))
    frame.loc[range(40, 70), "lat"] -= 20.0
    log = read_tracks(frame)
    assert log.lat == pytest.approx(clean.lat.to_numpy())
    assert log.removed == {"out of reach at the highest speed": 30}


def test_positions_at_0_n_0_e_are_left_out():
    frame = straight(60)
    frame.loc[[0, 1, 2, 59], ["lat", "lon"]] = 0.0
    log = read_tracks(frame)
    assert len(log.time) == 56
    assert log.removed == {"at 0 N 0 E, which receivers write without a fix": 4}
