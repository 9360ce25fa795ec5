"""Records of water level in NOOS, DIA and CSV files, recognised by their contents."""

import gzip

import numpy as np
import pytest

from tests.conftest import data_file
from thalweg.core.errors import DatasetError, InputError
from thalweg.core.time import parse_time
from thalweg.sea import standard_names as nm
from thalweg.sea.tides.tide_records import is_text_record, read_record

NOOS = """#------------------------------------------------------
# Timeseries retrieved from the MATROOS series database
# Created at Wed May  1 19:48:38 CEST 2019
#------------------------------------------------------
# Location    : vlissingen
# Position    : (3.597577,51.443861)
# Source      : observed
# Unit        : waterlevel
# Analyse time: 000000000000
# Timezone    : GMT
#------------------------------------------------------
201801010000   2.5000
201801010010   2.4600
201801010020      nan
201801010040   2.3000
"""

DIA = """[IDT;*DIF*;A;CENT;20190213]
[W3H]
PAR;WATHTBRKD;Waterhoogte berekend;J
CPM;10;Oppervlaktewater
EHD;I;cm
HDH;NAP;T.o.v. Normaal Amsterdams Peil
LOC;VLISSGN;Vlissingen;P;RD;3048000;38522000
TYP;TE
[RKS]
TYD;20190101;0000;20190101;0050;10;min
PLT;NVT;-999999999;3048000;38522000
[TPS]
STA;20190101;0000;20190101;0050;O
[WRD]
102/0:90/0:78/0:
999999999/99:52/0:-39/0:
"""

BARE = "113225.0000000  1237\n113225.0416667  1290\n113225.0833333  -130\n"


def _file(tmp_path, text, name="record.txt"):
    path = tmp_path / name
    path.write_text(text)
    return path


def test_a_noos_series(tmp_path):
    record = read_record(_file(tmp_path, NOOS))
    start = parse_time("2018-01-01T00:00Z")
    assert record.times.tolist() == [start, start + 600.0, start + 1200.0, start + 2400.0]
    assert np.array_equal(record.series[nm.WATER_LEVEL], [2.5, 2.46, np.nan, 2.3], equal_nan=True)
    assert record.position == (51.443861, 3.597577)
    assert record.description == "NOOS series, vlissingen, observed"


def test_a_noos_series_in_middle_european_time(tmp_path):
    record = read_record(_file(tmp_path, NOOS.replace("GMT", "MET")))
    assert record.times[0] == parse_time("2017-12-31T23:00Z")


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("GMT", "PST", "time zone 'PST'"),
        (": waterlevel", ": wave_height_hm0", "not a water level"),
        ("201801010020", "# Location : hansweert\n201801010020", "several series"),
        ("2.4600", "2.4600 3", "line 13"),
        ("201801010010", "201813010010", "invalid date"),
        ("2.4600", "high", "not a number"),
        ("2.4600", "999.0", "missing values not marked"),
    ],
)
def test_a_noos_series_that_cannot_be_read(tmp_path, old, new, words):
    with pytest.raises(DatasetError, match=words) as caught:
        read_record(_file(tmp_path, NOOS.replace(old, new)))
    assert "record.txt" in str(caught.value)


def test_a_dia_series_is_in_middle_european_time_throughout_the_year(tmp_path):
    path = tmp_path / "v.dia.gz"
    path.write_bytes(gzip.compress(DIA.replace("20190101", "20190701").encode()))
    assert is_text_record(path)
    record = read_record(path)
    start = parse_time("2019-06-30T23:00Z")
    assert record.times.tolist() == [start + 600.0 * k for k in range(6)]
    assert record.series[nm.WATER_LEVEL] == pytest.approx(
        [1.02, 0.90, 0.78, np.nan, 0.52, -0.39], nan_ok=True
    )
    assert record.position == pytest.approx((51.4423, 3.5961), abs=1e-4)  # RD 30480, 385220 m


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("WATHTBRKD;Waterhoogte", "GETETBRKD2;Getijextreem", "not a water level"),
        (";10;min", "", "not equal steps"),
        (";10;min", ";0;min", "not a series"),
        ("52/0:", "", "states 6 values and has 5"),
        ("I;cm", "I;bar", "levels in 'bar'"),
        ("52/0:", "52:", "not numbers"),
        ("[WRD]", "[WRD]\n1/0:\n[W3H]\n[WRD]", "holds 2 series"),
    ],
)
def test_a_dia_series_that_cannot_be_read(tmp_path, old, new, words):
    with pytest.raises(DatasetError, match=words):
        read_record(_file(tmp_path, DIA.replace(old, new)))


def test_a_dia_series_without_a_known_position(tmp_path):
    assert read_record(_file(tmp_path, DIA.replace(";RD;", ";XY;"))).position is None


def test_columns_without_a_header_need_unit_and_first_day(tmp_path):
    path = _file(tmp_path, BARE, "gauge.asc")
    record = read_record(path, unit="mm", days_since="1700-01-01")
    start = parse_time("2010-01-01T00:00Z")
    assert record.times.tolist() == [start, start + 3600.0, start + 7200.0]
    assert record.series[nm.WATER_LEVEL] == pytest.approx([1.237, 1.290, -0.130])
    assert record.position is None
    for given in ({}, {"unit": "mm"}, {"days_since": "1700-01-01"}):
        with pytest.raises(InputError, match="2010-01-01 since 1700-01-01"):
            read_record(path, **given)
    with pytest.raises(InputError, match="Units are"):
        read_record(path, unit="inch", days_since="1700-01-01")
    with pytest.raises(DatasetError, match="reaches 1290 m"):
        read_record(path, unit="m", days_since="1700-01-01")
    with pytest.raises(InputError, match="states its own unit"):
        read_record(_file(tmp_path, NOOS), unit="cm")


def test_csv_is_recognised_by_its_header_not_its_name(tmp_path):
    text = "time;water_level\n".replace(";", ",") + "2026-01-01T00:00+01:00,1.5\n2026-01-01,\n"
    record = read_record(_file(tmp_path, text, "gauge.dat"))
    assert record.times.tolist() == [
        parse_time("2025-12-31T23:00Z"), parse_time("2026-01-01T00:00Z"),
    ]  # fmt: skip
    assert np.array_equal(record.series[nm.WATER_LEVEL], [1.5, np.nan], equal_nan=True)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("STAT  A WATHTE NAP cm 1\nCOMP    1      .041069     8.340  221.50  SA\n", "predict"),
        ('{"format": "thalweg-constituents-1"}', "predict"),
        ("a,b\n1,2\n", "columns a, b"),
        (",".join(f"c{k}" for k in range(40)) + "\n", "and 32 more"),
        ("\n", "cannot be read"),
    ],
)
def test_text_that_is_not_a_record(tmp_path, text, words):
    with pytest.raises(DatasetError, match=words):
        read_record(_file(tmp_path, text))


def test_a_record_that_cannot_be_decompressed(tmp_path):
    path = tmp_path / "cut.noos.gz"
    path.write_bytes(gzip.compress(NOOS.encode())[:-20])
    with pytest.raises(DatasetError, match="cannot be read"):
        read_record(path)


@pytest.mark.parametrize(
    ("name", "is_one"),
    [
        ("tide/rws_vlissingen_waterlevel_20180101_20180401.noos", True),
        ("tide/rws_vlissingen_prediction_2019_hatyan.dia.txt.gz", True),
        ("tide/utide_HNL2010_hourly.asc", True),
        ("tide/adh_sandiego_waterlevel_ugrid_30min.nc", False),
        ("metocean/metno_mywavewam_northsea_20191106_09_hourly.grb", False),
        ("tide", False),
    ],
)
def test_records_are_distinguished_from_model_runs(name, is_one):
    assert is_text_record(data_file(name)) == is_one


@pytest.mark.slow
def test_the_official_files_are_read_completely():
    noos = read_record(data_file("tide/rws_vlissingen_waterlevel_20180101_20180401.noos"))
    assert noos.times.size == 12752  # lines; 209 of the 10-min steps are not given
    assert noos.times[[0, -1]].tolist() == [parse_time("2018-01-01"), parse_time("2018-04-01")]
    dia = read_record(data_file("tide/rws_vlissingen_prediction_2019_hatyan.dia.txt.gz"))
    assert dia.times.size == 365 * 144
    assert dia.times[[0, -1]].tolist() == [
        parse_time("2018-12-31T23:00Z"), parse_time("2019-12-31T22:50Z"),
    ]  # fmt: skip
    assert dia.series[nm.WATER_LEVEL][:4].tolist() == [1.02, 0.90, 0.78, 0.66]
