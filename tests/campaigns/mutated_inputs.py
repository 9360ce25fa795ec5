"""Mutated files and option values: no traceback, a documented exit code, no NaN in answers.

``python -m tests.campaigns.mutated_inputs --count 100000 --seed 1``. Each case runs a command in
this process: route files, zones, records of tides, sea files, ship files and option values.
"""

from __future__ import annotations

import contextlib
import io
import json
import sys
import tempfile
import time
import traceback
from collections import Counter
from importlib import resources
from pathlib import Path

import numpy as np
import xarray as xr

from tests.campaigns.plain_referee import arguments
from thalweg.cli.main import main as run_command

WORDS = (
    *(
        "",
        "nan",
        "inf",
        "-inf",
        "-1",
        "0",
        "1e308",
        "1e-308",
        "9" * 400,
        "true",
        "null",
        "[]",
        "{}",
    ),
    *(
        "2026-13-01",
        "0000-00-00",
        "9999-12-31T23:59:59Z",
        "\x00",
        "\udcff",
        "é" * 50,
        "../..",
        "%s",
    ),
    *(
        "1,2,3",
        "91,0",
        "0,181",
        "nan,nan",
        "-0",
        "1_000",
        "0x10",
        "1e5",
        " ",
        "\n",
        "'",
        '"',
        "=",
        "=1",
    ),
)
DOCUMENTED = {0, 2, 3, 4}


def _csv_route(rng: np.random.Generator) -> str:
    rows = [f"{rng.uniform(50.2, 50.8):.4f},{rng.uniform(1.2, 2.8):.4f}" for _ in range(4)]
    return "lat,lon\n" + "\n".join(rows) + "\n"


def _geojson_route(rng: np.random.Generator) -> str:
    line = [[float(rng.uniform(1.2, 2.8)), float(rng.uniform(50.2, 50.8))] for _ in range(4)]
    feature = {
        "type": "Feature",
        "properties": {},
        "geometry": {"type": "LineString", "coordinates": line},
    }
    return json.dumps({"type": "FeatureCollection", "features": [feature]})


def _gpx_route(rng: np.random.Generator) -> str:
    points = "".join(
        f'<rtept lat="{rng.uniform(50.2, 50.8):.4f}" lon="{rng.uniform(1.2, 2.8):.4f}"/>'
        for _ in range(4)
    )
    return f'<gpx version="1.1" xmlns="http://www.topografix.com/GPX/1/1"><rte>{points}</rte></gpx>'


def _gauge(rng: np.random.Generator) -> str:
    rows = [f"2026-01-{1 + h // 24:02d}T{h % 24:02d}:00Z,{rng.normal():.3f}" for h in range(96)]
    return "time,water_level\n" + "\n".join(rows) + "\n"


def _sea(folder: Path, rng: np.random.Generator) -> bytes:
    times = np.datetime64("2026-01-01T00:00", "ns") + np.arange(4) * np.timedelta64(6, "h")
    shape = (4, 5, 5)
    fields = {
        "uo": (("time", "lat", "lon"), rng.normal(0, 0.3, shape), {"units": "m/s"}),
        "vo": (("time", "lat", "lon"), rng.normal(0, 0.3, shape), {"units": "m/s"}),
    }
    axes = {"time": times, "lat": np.linspace(50, 51, 5), "lon": np.linspace(1, 3, 5)}
    path = folder / "base.nc"
    xr.Dataset(fields, axes).to_netcdf(path, engine="scipy", format="NETCDF3_CLASSIC")
    return path.read_bytes()


def mutated(text: bytes, rng: np.random.Generator) -> bytes:
    """Return a file with a few bytes, words or lines changed, removed or doubled."""
    data = bytearray(text)
    for _ in range(rng.integers(1, 3)):
        if not data:
            break
        at = int(rng.integers(0, len(data)))
        kind = rng.integers(0, 6)
        if kind == 0:
            data[at] = int(rng.integers(0, 256))
        elif kind == 1:
            del data[at : at + int(rng.integers(1, 40))]
        elif kind == 2:
            word = WORDS[rng.integers(0, len(WORDS))].encode("utf-8", "surrogateescape")
            data[at : at + int(rng.integers(0, 8))] = word
        elif kind == 3:
            part = data[at : at + int(rng.integers(1, 200))]
            data[at:at] = part
        elif kind == 4:
            del data[at:]
        else:
            data[at : at + 1] = bytes(rng.integers(0, 256, 4, dtype=np.uint8))
    return bytes(data)


def cases(folder: Path, rng: np.random.Generator):
    """Yield command lines, one after the other, for ever."""
    sea = _sea(folder, rng)
    ship = resources.files("thalweg.ship").joinpath("library/gunnerus.yaml").read_bytes()
    good = folder / "good.csv"
    good.write_text(_csv_route(rng))
    calm = ["--calm", "--coast", "none", "--depart", "2026-01-01", "--ship", "gunnerus", "--json"]
    makers = (
        ("route.csv", _csv_route), ("route.geojson", _geojson_route), ("route.gpx", _gpx_route),
    )  # fmt: skip
    options = ("--depart", "--ukc", "--load-factor", "--fuel-price", "--time-price", "--speed")
    while True:
        kind = rng.integers(0, 10)
        if kind < 5:
            name, make = makers[rng.integers(0, 3)]
            path = folder / name
            path.write_bytes(mutated(make(rng).encode(), rng))
            yield ["evaluate", str(path), *calm]
        elif kind == 5:
            path = folder / "zones.geojson"
            path.write_bytes(
                mutated(_geojson_route(rng).replace("LineString", "Polygon").encode(), rng)
            )
            yield ["evaluate", str(good), *calm, "--zones", str(path)]
        elif kind == 6:
            path = folder / "gauge.csv"
            path.write_bytes(mutated(_gauge(rng).encode(), rng))
            yield ["tides", "analyse", str(path), "--at", "51,3", "--json"]
        elif kind == 7:
            path = folder / "sea.nc"
            path.write_bytes(mutated(sea, rng))
            yield ["inspect", str(path), "--json"]
        elif kind == 8:
            path = folder / "ship.yaml"
            path.write_bytes(mutated(ship, rng))
            yield ["ship", str(path), "--json"]
        else:
            option = options[rng.integers(0, len(options))]
            word = WORDS[rng.integers(0, len(WORDS))]
            yield ["evaluate", str(good), *calm, f"{option}={word}"]


def outcome(command: list[str]) -> tuple[str, str]:
    """Return the exit code as text, and the fault or an empty text."""
    out, err = io.StringIO(), io.StringIO()
    try:
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = run_command(command)
    except SystemExit as end:
        code = end.code if isinstance(end.code, int) else 1
    except Exception:
        return "traceback", traceback.format_exc()
    if code not in DOCUMENTED:
        return str(code), f"exit code {code}: {err.getvalue()[-500:]}"
    if "Traceback" in err.getvalue():
        return "traceback", err.getvalue()
    if code == 0 and "--json" in command:
        try:
            json.loads(out.getvalue(), parse_constant=lambda word: 1 / 0)
        except (ValueError, ZeroDivisionError):
            return "json", f"no strict JSON: {out.getvalue()[:300]}"
    return str(code), ""


def main() -> int:
    """Run the campaign; return 1 if a fault was found."""
    chosen = arguments(100_000)
    rng = np.random.default_rng(chosen.seed)
    found: Counter[str] = Counter()
    faults: dict[str, str] = {}
    begin = time.process_time()
    with tempfile.TemporaryDirectory() as name:
        for number, command in zip(range(chosen.count), cases(Path(name), rng)):
            code, fault = outcome(command)
            found[code] += 1
            if fault:
                last = fault.strip().splitlines()[-1][:160]
                key = f"{command[0]}: {last}"
                if key not in faults:
                    faults[key] = f"case {number}: {command}\n{fault[-1500:]}"
                    print(faults[key], flush=True)
    print(f"{chosen.count} cases, seed {chosen.seed}: {dict(found)}; {len(faults)} kinds of fault; "
          f"{time.process_time() - begin:.0f} s CPU")  # fmt: skip
    return int(bool(faults))


if __name__ == "__main__":
    sys.exit(main())
