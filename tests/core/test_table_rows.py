"""Tables of the program."""

from __future__ import annotations

from pathlib import Path

import pytest

import thalweg
from thalweg.core.file_reading import table_rows

ROOT = Path(thalweg.__file__).parent
TABLES = sorted(path for path in ROOT.rglob("data/*.csv*") if path.name != "danielle_1998.csv")


@pytest.mark.parametrize("path", TABLES, ids=lambda path: path.name)
def test_every_table_is_read_and_no_row_is_longer_than_its_header(path):
    folders = path.parent.parent.relative_to(ROOT.parent).parts
    rows = table_rows(".".join(folders), path.name)
    assert rows and all(None not in row for row in rows)


def test_a_table_is_text_by_column():
    assert table_rows("thalweg.chart", "port_draughts.csv")[0].keys() == {
        "unlocode",
        "max_draught_m",
        "source",
    }


def test_a_missing_table_is_an_error():
    with pytest.raises(FileNotFoundError):
        table_rows("thalweg.chart", "no_such_table.csv")
