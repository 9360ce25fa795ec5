"""Files of history networks: JSON with a version of its schema."""

from __future__ import annotations

import json
from os import PathLike
from typing import Any, Final

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.file_reading import cause_of
from thalweg.core.file_writing import replacing_file
from thalweg.core.given_numbers import rounded_or_none
from thalweg.core.types import FloatArray
from thalweg.network.history.arc_lines import ArcLines
from thalweg.network.history.arc_statistics import SHARES, ArcEvidence
from thalweg.network.history.history_arcs import ARC_KINDS, HistoryArcs, HistoryNodes
from thalweg.network.history.history_network import HistoryNetwork
from thalweg.network.history.stretch_ends import ends_at_nodes
from thalweg.network.history.voyage_tracks import HistoryPort
from thalweg.network.history.whole_voyages import VoyagePairs

FORMAT: Final = "thalweg history network"
VERSION: Final = 1
_PLACES: Final = 6  # decimals of degrees
_METRES, _SHARES_OF_ONE = 1, 4  # decimals of lengths and times, and of shares


def write_history(network: HistoryNetwork, path: str | PathLike[str]) -> None:
    """Write a history network as JSON.

    Parameters
    ----------
    network : HistoryNetwork
    path : path
        File; it is written completely or not at all.

    Raises
    ------
    OSError
        If the file cannot be written.
    """
    nodes, arcs = network.nodes, network.arcs
    data = {
        "format": FORMAT,
        "version": VERSION,
        "radius_m": network.radius,
        "least_voyages": network.least,
        "summary": network.summary,
        "junctions": [
            {"lat": lat, "lon": lon, "name": name}
            for lat, lon, name in zip(
                _rounded(nodes.lat[: nodes.first_port], _PLACES),
                _rounded(nodes.lon[: nodes.first_port], _PLACES),
                nodes.names,
            )
        ],
        "ports": [
            {"name": port.name, "locode": port.locode, "lat": round(port.lat, _PLACES),
             "lon": round(port.lon, _PLACES), "approach_m": round(port.approach_m, _METRES)}
            for port in nodes.ports
        ],
        "arcs": [_arc_to_dict(arcs, arc) for arc in range(len(arcs))],
        "canal_voyages": [
            {"from": tail, "to": head, "voyages": count, "months": months,
             "duration_s": _rounded(time, _METRES)}
            for tail, head, count, months, time in zip(
                network.pairs.tail.tolist(), network.pairs.head.tolist(),
                network.pairs.count.tolist(), network.pairs.months.tolist(),
                network.pairs.duration,
            )
        ],
    }  # fmt: skip
    text = json.dumps(data, allow_nan=False, ensure_ascii=False, separators=(",", ":"))
    with replacing_file(path) as file:
        file.write(text.encode("utf-8"))


def read_history(path: str | PathLike[str]) -> HistoryNetwork:
    """Read a history network.

    Parameters
    ----------
    path : path
        File by `write_history`.

    Returns
    -------
    HistoryNetwork

    Raises
    ------
    InputError
        If the file cannot be read, is of another kind or of a newer version, or is damaged.
    """
    try:
        with open(path, encoding="utf-8") as file:
            data = json.load(file)
    except (OSError, ValueError) as error:
        raise InputError(
            f"The history network {str(path)!r} cannot be read: {cause_of(error)}.",
            "It is a JSON file, made by thalweg history build.",
            "Check the path, or build the network.",
            file=str(path),
        ) from error
    kind = data.get("format") if isinstance(data, dict) else None
    if kind != FORMAT or not isinstance(data.get("version"), int) or data["version"] > VERSION:
        raise InputError(
            f"The file {str(path)!r} is no history network that this version can read.",
            f'It has "format": "{FORMAT}" and a "version" of at most {VERSION}.',
            "Build the network with thalweg history build.",
            file=str(path),
        )
    try:
        network = _network_of(data)
        _check(network)
    except (KeyError, TypeError, ValueError, IndexError) as error:
        raise InputError(
            f"The history network {str(path)!r} is damaged: {type(error).__name__} {error}.",
            "Nodes and arcs must be complete.",
            "Build the network again.",
            file=str(path),
        ) from error
    return network


def _arc_to_dict(arcs: HistoryArcs, arc: int) -> dict[str, Any]:
    lat, lon = arcs.lines.of(arc)
    evidence = arcs.evidence
    entry: dict[str, Any] = {
        "from": int(arcs.tail[arc]),
        "to": int(arcs.head[arc]),
        "kind": ARC_KINDS[arcs.kind[arc]],
        "line": [list(p) for p in zip(_rounded(lat, _PLACES), _rounded(lon, _PLACES))],
        "eca_share": _rounded(arcs.eca_share[arc : arc + 1], _SHARES_OF_ONE)[0],
        "repaired_share": round(float(arcs.repaired[arc]), _SHARES_OF_ONE),
        "approach_m": _rounded(arcs.approach[arc], _METRES),
    }
    if evidence.count[arc]:
        entry |= {
            "voyages": int(evidence.count[arc]),
            "length_m": _rounded(evidence.length[arc], _METRES),
            "duration_s": _rounded(evidence.duration[arc], _METRES),
            "months": evidence.months[arc].tolist(),
            "open_in": evidence.open_in[arc].astype(int).tolist(),
            "draught_m": _rounded(evidence.draught[arc], 2),
            "draughts_known": int(evidence.draughts_known[arc]),
            "ship_length_m": _rounded(evidence.ship_length[arc], _METRES),
            "tube_m": [_rounded(pair, _METRES) for pair in arcs.tube[arc]],
        }
    return entry


def _network_of(data: dict[str, Any]) -> HistoryNetwork:
    ports = tuple(
        HistoryPort(p["name"], p["locode"], float(p["lat"]), float(p["lon"]),
                    float(p["approach_m"]), ((float(p["lat"]), float(p["lon"])),))
        for p in data["ports"]
    )  # fmt: skip
    junctions, rows = data["junctions"], data["arcs"]
    nodes = HistoryNodes(
        np.array([p["lat"] for p in junctions] + [port.lat for port in ports], float),
        np.array([p["lon"] for p in junctions] + [port.lon for port in ports], float),
        (*(str(p["name"]) for p in junctions), *([""] * len(ports))),
        ports,
    )
    unknown, year = [None] * 3, [0] * 12
    evidence = ArcEvidence(
        np.array([row.get("voyages", 0) for row in rows], np.int64),
        _table(rows, "length_m", unknown),
        _table(rows, "duration_s", unknown),
        np.array([row.get("months", year) for row in rows], np.int64).reshape(-1, 12),
        np.array([row.get("open_in", [1] * 12) for row in rows], bool).reshape(-1, 12),
        _table(rows, "draught_m", unknown),
        _table(rows, "ship_length_m", unknown),
        np.array([row.get("draughts_known", 0) for row in rows], np.int64),
    )
    flat = [[0.0, 0.0]] * len(SHARES)
    tail, head = (np.array([row[end] for row in rows], np.int64) for end in ("from", "to"))
    approach = ends_at_nodes(tail, head, nodes.approach)  # in files that lack those of arcs
    given = np.array([row.get("approach_m", [np.nan] * 2) for row in rows], float).reshape(-1, 2)
    arcs = HistoryArcs(
        tail,
        head,
        np.array([ARC_KINDS.index(row["kind"]) for row in rows], np.int64),
        ArcLines.of_lists([row["line"] for row in rows]),
        evidence,
        np.array([row.get("tube_m", flat) for row in rows], float).reshape(-1, len(SHARES), 2),
        np.array([row["eca_share"] for row in rows], float),
        np.array([row["repaired_share"] for row in rows], float),
        np.where(np.isnan(given), approach, given),
    )
    return HistoryNetwork(
        nodes, arcs, float(data["radius_m"]), int(data["least_voyages"]), dict(data["summary"]),
        _pairs_of(data.get("canal_voyages", [])),
    )  # fmt: skip


def _pairs_of(rows: list[dict[str, Any]]) -> VoyagePairs:
    tail, head, count = (
        np.array([row[name] for row in rows], np.int64) for name in ("from", "to", "voyages")
    )
    months = np.array([row["months"] for row in rows], np.int64).reshape(-1, 12)
    return VoyagePairs(tail, head, count, _table(rows, "duration_s", [None] * 3), months)


def _check(network: HistoryNetwork) -> None:
    """Raise `ValueError` if arrays do not fit together."""
    nodes, arcs = network.nodes, network.arcs
    ends = np.concatenate([arcs.tail, arcs.head])
    if len(ends) and not (ends.min() >= 0 and ends.max() < len(nodes)):
        raise ValueError("an arc joins a node that does not exist")
    if (np.diff(arcs.lines.ptr) < 2).any():
        raise ValueError("a line has fewer than two positions")
    places = np.concatenate([nodes.lat, nodes.lon, arcs.lines.lat, arcs.lines.lon])
    if not np.isfinite(places).all():
        raise ValueError("a position is not a number")


def _table(rows: list[dict[str, Any]], name: str, absent: list[Any]) -> FloatArray:
    return np.array([row.get(name, absent) for row in rows], float).reshape(-1, 3)


def _rounded(values: FloatArray, decimals: int) -> list[float | None]:
    """Return numbers for JSON; None where unknown."""
    return [rounded_or_none(x, decimals) for x in values.tolist()]
