"""A voyage written to a file and read again is equal."""

import pytest

from thalweg import Voyage
from thalweg.core.errors import InputError

FULL = {
    "start": (52.0, 4.1),
    "goal": "New York",
    "via": [(50.0, -5.0), "Ponta Delgada"],
    "depart": "2026-01-01T06:00:00Z",
    "arrive_by": "2026-01-20T00:00:00Z",
    "objective": "distance",
    "wait": False,
    "speed_kn": 14.3,
    "min_ukc_m": 1.5,
    "seed": 7,
}


@pytest.mark.parametrize("name", ["voyage.yaml", "voyage.json"])
def test_round_trip(tmp_path, name):
    voyage = Voyage.from_dict(FULL)
    voyage.save(tmp_path / name)
    assert Voyage.load(tmp_path / name) == voyage


def test_window_round_trip(tmp_path):
    voyage = Voyage(start=(1, 2), goal=(3, 4), depart_window=("2026-01-01", "2026-01-02"))
    voyage.save(tmp_path / "v.yaml")
    assert Voyage.load(tmp_path / "v.yaml") == voyage
    assert voyage.latest_departure - voyage.earliest_departure == 86400.0


def test_unknown_key_has_near_match(tmp_path):
    (tmp_path / "v.yaml").write_text("start: [1, 2]\ngoal: [3, 4]\ndepartt: 2026-01-01\n")
    with pytest.raises(InputError, match="'depart'"):
        Voyage.load(tmp_path / "v.yaml")


@pytest.mark.parametrize("text", ["[1, 2", "just words", "- a\n- b", ""])
def test_files_that_are_no_voyage(tmp_path, text):
    (tmp_path / "v.yaml").write_text(text)
    with pytest.raises(InputError):
        Voyage.load(tmp_path / "v.yaml")


@pytest.mark.parametrize("data", [5, None, True])
def test_data_that_are_no_voyage(data):
    with pytest.raises(InputError, match=r"The voyage is .* start, goal and a departure"):
        Voyage.from_dict(data)


def test_missing_file():
    with pytest.raises(InputError, match="does not exist"):
        Voyage.load("nowhere.yaml")
