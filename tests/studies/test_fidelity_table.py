"""The table of networks of a study against the finest, as in Prestegardshus (2020), ch. 4.1."""

from __future__ import annotations

import pandas as pd
import pytest

from thalweg.studies.fidelity_table import fidelity_table


def rows() -> pd.DataFrame:
    """Two departures on each of three networks; one has no route on the coarsest."""
    return pd.DataFrame(
        {"network": ["fine", "fine", "middle", "middle", "coarse"], "objective": ["time"] * 5,
         "time_h": [10.0, 12.0, 10.2, 12.2, 14.3], "distance_nm": [90.0, 90.0, 91.0, 91.0, 99.0],
         "fuel_t": [1.0, 1.2, 1.0, 1.3, 1.5], "segments": [900, 900, 90, 90, 9],
         "nodes": [90, 90, 30, 30, 5], "sick_percent": [None] * 5, "seconds": [2.0] * 5}
    )  # fmt: skip


def test_gaps_are_those_of_the_medians_to_the_network_with_most_segments():
    named = [{"name": name, "network": "layered"} for name in ("coarse", "middle", "fine")]
    table = fidelity_table(rows(), named).set_index("network")
    assert list(table.index) == ["coarse", "middle", "fine"]
    assert table["routes"].tolist() == [1, 2, 2]
    assert table["segments"].tolist() == [9.0, 90.0, 900.0]
    assert table["time_h"].tolist() == pytest.approx([14.3, 11.2, 11.0])
    assert table["gap_percent"].tolist() == pytest.approx([30.0, 100 / 55, 0.0])
    assert "sick_percent" not in table  # not known on any route


def test_without_networks_to_compare_there_is_no_table():
    assert fidelity_table(rows(), ["fine"]).empty
    assert fidelity_table(rows().drop(columns="network"), ["a", "b"]).empty
    nothing = fidelity_table(rows(), ["fine", "unknown"]).set_index("network")
    assert nothing.loc["unknown", "routes"] == 0 and pd.isna(nothing.loc["unknown", "gap_percent"])


def test_steps_and_samplings_are_compared_with_the_finest():
    steps = rows().assign(resolution_nm=[20, 20, 40, 40, 80])
    table = fidelity_table(steps, [80, 40, 20], "resolution_nm").set_index("resolution_nm")
    assert table["gap_percent"].tolist() == pytest.approx([30.0, 100 / 55, 0.0])
    names = ["nearest:12", "linear", "nearest:2"]
    weather = rows().assign(sampling=["linear"] * 2 + ["nearest:2"] * 2 + ["nearest:12"])
    table = fidelity_table(weather, names, "sampling").set_index("sampling")
    assert table.loc["linear", "gap_percent"] == 0.0
    assert table.loc["nearest:12", "gap_percent"] == pytest.approx(30.0)
