"""Conversion of times, and errors with a remedy."""

import ast
import json
import math
import tempfile
from collections import Counter
from datetime import UTC, datetime, timedelta, timezone
from pathlib import Path

import numpy as np
import pytest

import thalweg
from thalweg.chart.passages import PASSAGES
from thalweg.cli.exit_codes import print_error
from thalweg.core.cache_folder import cache_folder
from thalweg.core.errors import (
    InputError,
    NoRouteError,
    close_matches,
    names_in_words,
    reasons_text,
    refuse_other_file,
    unknown_name_error,
)
from thalweg.core.time import format_time, parse_time, to_datetime64


@pytest.mark.parametrize(
    "value",
    [
        "2026-01-01T06:00Z",
        "2026-01-01T06:00:00",
        "2026-01-01T07:00+01:00",
        datetime(2026, 1, 1, 6),
        datetime(2026, 1, 1, 6, tzinfo=UTC),
        datetime(2026, 1, 1, 8, tzinfo=timezone(timedelta(hours=2))),
        np.datetime64("2026-01-01T06:00"),
        1767247200,
    ],
)
def test_one_moment_many_spellings(value):
    assert parse_time(value) == 1767247200.0


@pytest.mark.parametrize(
    "value", ["tomorrow", "2026-13-01", float("nan"), np.datetime64("NaT"), 1767247200e3, True]
)
def test_what_is_not_a_time(value):
    with pytest.raises(InputError):
        parse_time(value)


@pytest.mark.parametrize("value", ["2026-02-30", "2026-02-30T06:00Z", "2026-01-01T25:00"])
def test_dates_and_hours_that_do_not_exist(value):
    with pytest.raises(InputError, match=r"is not a time: .*Give a date and time that exist"):
        parse_time(value)


@pytest.mark.parametrize("offset", ["+25:00", "-24:00", "+15:00", "-12:30"])
def test_offsets_that_no_time_zone_has(offset):
    """The first was answered with the words of Python on 'timedelta'."""
    with pytest.raises(InputError, match=r"Offsets from UTC are -12:00 to \+14:00") as caught:
        parse_time(f"2026-03-10T01:00{offset}")
    assert "timedelta" not in str(caught.value)


def test_times_go_out_as_they_came_in():
    assert format_time(parse_time("2026-02-28T23:59:59Z")) == "2026-02-28T23:59:59Z"
    assert to_datetime64(parse_time("2026-01-01T00:00Z")) == np.datetime64("2026-01-01T00:00")
    assert format_time(-1.0) == "1969-12-31T23:59:59Z"
    assert format_time(253402300799.0) == "9999-12-31T23:59:59Z"
    assert format_time(float("nan")) == "unknown"


def test_of_many_names_the_nearest_are_listed_first():
    names = [*(f"aa{k:02d}" for k in range(30)), "zone_water"]
    text = str(unknown_name_error("entry", "zone_of_water", names))
    assert "Known: zone_water, aa00" in text and " and 11 more." in text


def test_near_matches_ignore_case():
    assert close_matches("roterdam", ["Rotterdam", "Antwerpen"]) == ["Rotterdam"]


@pytest.mark.parametrize(
    ("asked", "meant"),
    [("Kanmon Kaikyo", "Kanmon (Shimonoseki)"), ("Malaca Strait", "Malacca: One Fathom Bank")],
)
def test_names_with_a_word_in_common_come_before_those_spelled_alike(asked, meant):
    known = [passage.name for passage in PASSAGES]
    error = unknown_name_error("passage", asked, known)
    assert meant in error.details["near"][:2]
    assert "Florida Straits" not in error.details["near"][:2]  # many names have the word
    assert "Did you mean 'Rotterdam'" in str(unknown_name_error("port", "roterdam", ["Rotterdam"]))


def test_an_error_has_its_three_parts_and_details():
    error = NoRouteError("No way.", "Nothing.", "Wait.", reasons={"land": 3}, nearest=(1.0, 2.0))
    assert str(error) == "No way. Nothing. Wait."
    assert error.as_dict()["details"] == {"reasons": {"land": 3}, "nearest": [1.0, 2.0]}


def test_details_of_errors_are_standard_json(capsys):
    error = InputError(
        "A", value=math.nan, limits=(0.0, math.inf), count=np.int64(3), row=np.array([1.5, np.nan])
    )
    details = {"value": None, "limits": [0.0, None], "count": 3, "row": [1.5, None]}
    assert error.as_dict()["details"] == details
    assert print_error(error, as_json=True) == 2
    assert json.loads(capsys.readouterr().out, parse_constant=pytest.fail)["details"] == details


#: texts that no program reads but our own: hashed, or between two processes of ours
_OWN_TEXTS = {
    ("ship/ship_tabulation.py", 1),
    ("ship/tables/table_cache.py", 1),
    ("sea/ensemble_layer.py", 1),
} | {
    ("sea/value_sources.py", 1),
    ("sea/tides/model_run_analysis.py", 1),
    ("sea/files/grib_worker.py", 1),
}


@pytest.mark.slow
def test_json_is_never_written_with_nan_or_infinity():
    root = Path(thalweg.__file__).parent
    lax: Counter[str] = Counter()
    for path in sorted(root.rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if not (isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute)):
                continue
            named = ast.unparse(node.func) in ("json.dumps", "json.dump")
            strict = any(
                k.arg == "allow_nan" and ast.unparse(k.value) == "False" for k in node.keywords
            )
            if named and not strict:
                lax[path.relative_to(root).as_posix()] += 1
    assert set(lax.items()) == _OWN_TEXTS


def test_without_a_home_folder_data_are_cached_in_the_temporary_folder(monkeypatch, tmp_path):
    def nowhere():
        raise RuntimeError("Could not determine home directory.")

    monkeypatch.delenv("THALWEG_CACHE", raising=False)
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    monkeypatch.setattr(Path, "home", nowhere)
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    folder = cache_folder("tables")
    assert folder.is_dir() and tmp_path in folder.parents


def test_a_cache_that_cannot_be_written_is_replaced_once(monkeypatch, tmp_path):
    (tmp_path / "file").write_text("in the way")
    monkeypatch.setenv("THALWEG_CACHE", str(tmp_path / "file"))
    assert cache_folder("tables").is_dir()
    assert cache_folder("tables") == cache_folder("tables") != cache_folder("coast")


def test_times_beyond_the_nanoseconds_are_not_wrapped():
    far = parse_time("2300-01-01T00:00Z")
    assert str(to_datetime64(far)) == "2300-01-01T00:00:00.000000"
    assert parse_time(to_datetime64(far)) == far
    assert to_datetime64(0.5).dtype == np.dtype("datetime64[ns]")
    assert np.isnat(to_datetime64(np.array([0.0, np.nan]))).tolist() == [False, True]
    with pytest.raises(InputError, match="1 to 9999"):
        to_datetime64(1e15)


def test_a_name_without_its_unit_means_the_one_with_it():
    assert close_matches("min_ukc", ["min_wait", "min_uke", "Min_UKC_m"])[0] == "Min_UKC_m"
    assert close_matches("speed", ["speeds", "sped", "speed_kn"])[0] == "speed_kn"


def test_reasons_in_words_name_what_closes_the_water():
    refused = {"no-go zone": 1207, "land": 12, "depth": 0}
    assert reasons_text(refused) == "no-go zone or closed shoal area: 1,207, land: 12"
    assert NoRouteError("No route.", reasons=refused).reasons_text == reasons_text(refused)


@pytest.mark.parametrize(("entries", "wanted", "words"), [
    (("load", "unload", "volume_m3", "ship"), "a ship", "describes a dredging project"),
    (("voyage", "ship", "axes"), "a ship", "describes a study"),
    (("hull", "name"), "a dredging project", "describes a ship"),
    (("hull", "name"), "a ship", None),
    (("voyage", "ship"), "a study", None),
    ((), "a study", None),
])  # fmt: skip
def test_a_file_of_another_kind_is_named(entries, wanted, words):
    data = dict.fromkeys(entries, 1)
    if words is None:
        refuse_other_file(data, wanted)
        return
    with pytest.raises(InputError, match=words) as caught:
        refuse_other_file(data, wanted)
    assert f"{wanted} is needed" in caught.value.asked


def test_names_are_listed_in_words():
    listed = [names_in_words(names) for names in (["A"], ["A", "B"], ("A", "B", "C"))]
    assert listed == ["A", "A and B", "A, B and C"]
