"""A server on this computer that gives forecast files as the public ones do."""

from __future__ import annotations

import datetime
import json
import subprocess
import sys
import threading
from collections import Counter
from collections.abc import Callable
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from urllib.parse import urlsplit


def wind(moment: float, lat, lon):
    """A wind [m/s] whose value states its place and time."""
    return 0.1 * lat + 0.01 * (lon % 360.0) + 1e-5 * (moment % 864000.0)


WRITER = """
import datetime, json, sys
import numpy as np
import eccodes as ec

LAT, LON = np.arange(90.0, -90.1, -2.0), np.arange(0.0, 360.0, 2.0)
lat, lon = np.meshgrid(LAT, LON, indexing="ij")
for name, run, hour, number in json.load(sys.stdin):
    stamp = datetime.datetime.fromtimestamp(run, datetime.timezone.utc)
    h = ec.codes_grib_new_from_samples("regular_ll_sfc_grib2")
    keys = {
        "Ni": len(LON), "Nj": len(LAT), "iDirectionIncrementInDegrees": 2.0,
        "jDirectionIncrementInDegrees": 2.0, "latitudeOfFirstGridPointInDegrees": 90.0,
        "longitudeOfFirstGridPointInDegrees": 0.0, "latitudeOfLastGridPointInDegrees": -90.0,
        "longitudeOfLastGridPointInDegrees": 358.0, "dataDate": int(f"{stamp:%Y%m%d}"),
        "dataTime": stamp.hour * 100, "bitsPerValue": 24,
    }
    if number:
        keys |= {"productDefinitionTemplateNumber": 1, "number": number,
                 "numberOfForecastsInEnsemble": 50}
    keys |= {"stepRange": str(hour), "shortName": name}
    for key, value in keys.items():
        ec.codes_set(h, key, value)
    moment = run + 3600.0 * hour
    values = 0.1 * lat + 0.01 * (lon % 360.0) + 1e-5 * (moment % 864000.0) + number
    ec.codes_set_values(h, values.ravel())
    data = ec.codes_get_message(h)
    sys.stdout.buffer.write(len(data).to_bytes(8, "big") + data)
    ec.codes_release(h)
sys.stdout.buffer.flush()
"""


def messages(wanted: list[tuple[str, float, int, int]]) -> list[bytes]:
    """Return GRIB 2 messages of global fields of 2 degrees: short name, run, hour, member.

    A process of its own writes them: eccodes and pyproj do not share one.
    """
    done = subprocess.run(
        [sys.executable, "-c", WRITER], input=json.dumps(wanted).encode(), capture_output=True
    )
    data, found = done.stdout, []
    while data:
        length = int.from_bytes(data[:8], "big")
        found.append(data[8 : 8 + length])
        data = data[8 + length :]
    assert len(found) == len(wanted), done.stderr.decode()[-500:]
    return found


class Recorded:
    """Answers by path, with faults for chosen paths."""

    def __init__(self) -> None:
        self.files: dict[str, bytes] = {}
        self.asked: Counter[str] = Counter()
        self.ranges: list[str] = []
        self.fault: Callable[[str, int], str] = lambda path, time: ""

    def answer(self, handler: BaseHTTPRequestHandler) -> None:
        path = urlsplit(handler.path).path
        self.asked[path] += 1
        fault = self.fault(path, self.asked[path])
        if fault.isdigit():
            handler.send_response(int(fault))
            handler.send_header("Retry-After", "7")
            handler.end_headers()
            return
        data = self.files.get(handler.path, self.files.get(path))
        if data is None:
            handler.send_response(404)
            handler.end_headers()
            return
        wanted = handler.headers.get("Range")
        first, last = 0, len(data) - 1
        if wanted and fault != "whole":
            self.ranges.append(wanted)
            left, _, right = wanted.removeprefix("bytes=").partition("-")
            first, last = int(left), min(int(right) if right else last, last)
        body = data[first : last + 1]
        partial = wanted and fault != "whole"
        handler.send_response(206 if partial else 200)
        handler.send_header("Content-Length", str(len(body)))
        if partial:
            handler.send_header("Content-Range", f"bytes {first}-{last}/{len(data)}")
        handler.end_headers()
        handler.wfile.write(body[: len(body) // 2] if fault == "half" else body)
        if fault == "half":
            handler.close_connection = True


@contextmanager
def serving(recorded: Recorded):
    """Yield the address of a server on the loopback interface."""

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            recorded.answer(self)

        def do_POST(self) -> None:
            recorded.answer(self)

        def log_message(self, *args) -> None:
            pass

    server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    thread = threading.Thread(target=server.serve_forever, args=(0.02,), daemon=True)
    thread.start()
    try:
        yield f"http://127.0.0.1:{server.server_address[1]}"
    finally:
        server.shutdown()
        server.server_close()


def gfs_files(recorded: Recorded, run: float, hours) -> None:
    """Add the files of one run as AWS has them; fields that are not wanted lie between."""
    from thalweg.forecasts.sources.gfs import _place

    short = ("10u", "10v", "swh", "perpw", "dirpw")
    made = iter(messages([(name, run, hour, 0) for hour in hours for name in short]))
    other = b"GRIB" + b"x" * 90 + b"7777"
    for hour in hours:
        u10, v10, height, period, direction = (next(made) for _ in short)
        atmosphere = [
            ("PRES:surface", other), ("UGRD:10 m above ground", u10), ("TMP:2 m", other),
            ("VGRD:10 m above ground", v10), ("RH:1 mb", other),
        ]  # fmt: skip
        waves = [
            ("WIND:surface", other), ("HTSGW:surface", height), ("WVHGT:surface", other),
            ("PERPW:surface", period), ("DIRPW:surface", direction),
        ]  # fmt: skip
        for kind, content in (("atmosphere", atmosphere), ("waves", waves)):
            lines, place = [], 0
            for number, (name, block) in enumerate(content, start=1):
                lines.append(f"{number}:{place}:d=2026112200:{name}:{hour} hour fcst:")
                place += len(block)
            folder, file = _place(run, hour, kind)
            recorded.files[f"{folder}/{file}"] = b"".join(block for _, block in content)
            recorded.files[f"{folder}/{file}.idx"] = "\n".join(lines).encode()


def ecmwf_files(recorded: Recorded, run: float, hours, members: int = 0) -> None:
    """Add the files of one run of ECMWF open data."""
    stamp = datetime.datetime.fromtimestamp(run, datetime.UTC)
    stream, suffix = ("enfo", "ef") if members else ("oper", "fc")
    numbers = range(1, members + 1) if members else (0,)
    names = ("10u", "10v")
    wanted = [(name, run, hour, number) for hour in hours for name in names for number in numbers]
    made = iter(messages(wanted))
    for hour in hours:
        entries, data = [], b""
        for name in names:
            for number in numbers:
                block = next(made)
                entry = {"param": name, "levtype": "sfc", "_offset": len(data)}
                entry |= {"_length": len(block)} | ({"number": str(number)} if members else {})
                entries.append(json.dumps(entry))
                data += block
        folder = f"/{stamp:%Y%m%d}/{stamp:%H}z/ifs/0p25/{stream}"
        name = f"{folder}/{stamp:%Y%m%d%H}0000-{hour}h-{stream}-{suffix}"
        recorded.files[f"{name}.grib2"] = data
        recorded.files[f"{name}.index"] = "\n".join(entries).encode()
