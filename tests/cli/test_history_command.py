"""``thalweg history`` and ``thalweg distances`` from tracks to tables."""

import json

import pytest

from thalweg.cli.main import main
from thalweg.core.geodesy import distance
from thalweg.operations.examples.synthetic_fleet import (
    SyntheticFleet,
    SyntheticRoute,
    synthetic_fleet,
)

A, B = (44.0, -25.0), (44.0, -21.0)


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    folder = tmp_path_factory.mktemp("history")
    routes = (SyntheticRoute((A, (44.5, -23.0), B)), SyntheticRoute((B, A)))
    table = synthetic_fleet(
        SyntheticFleet(routes, ships=4, interval_s=1800.0), start="2025-03-01", days=40
    )
    table.to_csv(folder / "tracks.csv", index=False)
    ports = "name,lat,lon\nAlpha,44.0,-25.0\nBravo,44.0,-21.0\n"
    (folder / "ports.csv").write_text(ports)
    done = main(
        [
            "history",
            "build",
            str(folder / "tracks.csv"),
            "--out",
            str(folder / "net.json"),
            "--ports",
            str(folder / "ports.csv"),
            "--quiet",
        ]
    )
    assert done == 0
    return folder


def test_the_network_answers_routes(files, capsys):
    code = main(["history", "route", str(files / "net.json"), "Alpha", "Bravo", "--json"])
    found = json.loads(capsys.readouterr().out)
    assert code == 0 and found["confidence"] == "high"
    legs = distance(*A, 44.5, -23.0) + distance(44.5, -23.0, *B)
    assert found["distance_nm"] == pytest.approx(float(legs) / 1852.0, rel=0.005)
    assert main(["history", "route", str(files / "net.json"), "Bravo", "Alpha"]) == 0
    assert "confidence high" in capsys.readouterr().out


def test_months_without_tracks_are_named(files, capsys):
    net, ports = str(files / "net.json"), str(files / "ports.csv")
    assert main(["history", "route", net, "Alpha", "Bravo", "--month", "12"]) == 0
    text = capsys.readouterr().out
    assert "note: No voyages were seen in December: the tracks have voyages in March and" in text
    words = ["distances", ports, "--network", f"history:{net}", "--month", "12", "--json"]
    assert main([*words, "--quiet"]) == 0
    assert "No voyages were seen in December" in json.loads(capsys.readouterr().out)["notes"][0]


def test_a_summary_is_printed_as_json(files, capsys, tmp_path):
    code = main(
        [
            "history",
            "build",
            str(files / "tracks.csv"),
            "--out",
            str(tmp_path / "n.json"),
            "--ports",
            str(files / "ports.csv"),
            "--json",
            "--quiet",
        ]
    )
    found = json.loads(capsys.readouterr().out)
    assert code == 0 and found["ports"] == 2 and found["ships"] == 4
    assert found["arcs"]["sailed"] >= 3 and found["arcs"]["globe"] == 0


def test_tables_of_distances_of_both_networks(files, capsys, tmp_path):
    ports, net = str(files / "ports.csv"), f"history:{files / 'net.json'}"
    assert main(["distances", ports, "--network", net, "--json", "--quiet"]) == 0
    usual = json.loads(capsys.readouterr().out)["distance_nm"]
    straight = float(distance(*A, *B)) / 1852.0
    assert usual[1][0] == pytest.approx(straight, rel=0.003) and usual[0][1] > 1.02 * usual[1][0]
    assert main(["distances", ports, "--network", net, "--out", str(tmp_path / "t.csv")]) == 0
    assert (tmp_path / "t.csv").read_text().startswith("nm,Alpha,Bravo\nAlpha,0.0,")


@pytest.mark.slow
def test_tables_of_shortest_ways_equal_single_distances(files, capsys):
    from thalweg.planning.sea_distance import sea_distance

    assert main(["distances", str(files / "ports.csv"), "--json", "--quiet"]) == 0
    found = json.loads(capsys.readouterr().out)["distance_nm"]
    assert found[0][1] == found[1][0] == pytest.approx(sea_distance(A, B).nm, abs=1e-5)


def test_shortest_ways_know_the_draught(files, capsys, monkeypatch):
    from thalweg.planning import distance_table

    asked = []

    class Found:
        length = 1852.0

    def ways(*ends, **options):
        asked.append(options["draught_m"])
        return Found()

    monkeypatch.setattr(distance_table, "sea_distance", ways)
    assert main(["distances", str(files / "ports.csv"), "--draught", "9.5", "--quiet"]) == 0
    assert asked == [9.5] and "Alpha,0.0,1.0" in capsys.readouterr().out


@pytest.mark.slow
def test_tracks_away_from_known_ports_are_refused_with_what_was_found(files, capsys, tmp_path):
    words = ["history", "build", str(files / "tracks.csv"), "--out", str(tmp_path / "n.json")]
    assert main([*words, "--quiet"]) == 2
    message = capsys.readouterr().err
    assert "4 ships with" in message and "at 0 ports" in message
    assert "within 5 nm of a port of the World Port Index" in message and "--ports FILE" in message


def test_a_voyage_that_passes_no_junction(files, capsys, tmp_path):
    (tmp_path / "t.csv").write_text(
        "vessel,time,lat,lon\na,2025-01-01T00:00Z,44.0,-25.0\na,2025-01-01T12:00Z,44.0,-21.0\n"
    )
    words = ["history", "build", str(tmp_path / "t.csv"), "--out", str(tmp_path / "n.json")]
    words += ["--ports", str(files / "ports.csv"), "--longest-gap", "24"]
    assert main([*words, "--json", "--quiet"]) == 0
    assert json.loads(capsys.readouterr().out)["arcs"]["sailed"] == 1


@pytest.mark.parametrize("words", [
    ["distances", "PORTS", "--month", "3"],
    ["distances", "PORTS", "--network", "mesh"],
    ["distances", "PORTS", "--network", "history:nothing.json"],
    ["distances", "nothing.csv"],
    ["history", "route", "PORTS", "Alpha", "Bravo"],
    ["history", "build", "nothing.csv", "--out", "x.json"],
    ["plan", "44,-25", "44,-21", "--ship", "handysize-bulker", "--calm", "--corridor-gain", "2"],
])  # fmt: skip
def test_wrong_requests_are_refused_in_words(files, capsys, tmp_path, monkeypatch, words):
    monkeypatch.chdir(tmp_path)
    words = [str(files / "ports.csv") if word == "PORTS" else word for word in words]
    assert main(words) == 2
    assert "Traceback" not in capsys.readouterr().err
