"""Six plans with all their numbers, to show that a change of the code changes none of them.

    python benchmarks/golden_plans.py --write before.json           # all waypoints
    python benchmarks/golden_plans.py --write golden.json --brief   # hashes and sums of waypoints
    python benchmarks/golden_plans.py --check before.json [--tolerance 1e-9 lat=1e-6 ...]

Without ``--tolerance`` numbers must be the same to the byte. A tolerance is the largest difference
of a quantity over its largest number in the plan; ``NAME=NUMBER`` is one for the quantities whose
name ends so. A quantity that a file has and the code no longer gives is a difference, and so is
another number of routes or waypoints; quantities that are new in the code are not. Texts, versions,
fingerprints, bounds and timings are not compared. In a brief file a tolerance is for the sums of
waypoints.
Numbers are valid for one machine and one set of libraries. All cases state positions, not ports.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import math
import platform
import subprocess
import sys
import tempfile
import time
from collections import defaultdict
from collections.abc import Callable, Iterator
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

import thalweg
from thalweg import Chart, Sea, Ship, Voyage, evaluate, plan
from thalweg.operations.dredging import Project
from thalweg.operations.dredging.project_inputs import open_project_inputs
from thalweg.operations.dredging.run_project import run_project
from thalweg.route import evaluate_members

EAST, NORTH = "eastward_sea_water_velocity", "northward_sea_water_velocity"
KNOT = 1852.0 / 3600.0
#: Not compared: texts, bounds, and times rounded to the second (hours since the departure are).
LEFT_OUT = frozenset(
    {"provenance", "notes", "voyage", "objective", "objective_unit", "lower_bound_kind"}
    | {"criterion", "assumptions", "depart", "arrive", "time", "start", "end"}
    | {"sail_full", "sail_empty"}
    | {"lower_bound", "lower_bound_certain", "certain", "gap"}  # depend on the time for the proof
)
FACTS = ("nodes", "edges", "spacing_m", "directions", "settled")
#: Columns of the waypoints of a front, of which there are many.
FEW = (
    *("lat", "lon", "hours", "waiting_h", "ordered_speed_kn", "speed_through_water_kn"),
    *("speed_over_ground_kn", "fuel_t"),
)
ARRAYS = ("waypoints",)  # given as hashes and sums in a brief file


# -- the six plans ---------------------------------------------------------------------------------


def demo() -> Any:
    """``thalweg demo``: Halifax to Bishop Rock in the storm, as a process of its own."""
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "thalweg", "demo", "--json", "--out", folder]
        printed = subprocess.run(command, check=True, capture_output=True, text=True).stdout
        written = json.loads((Path(folder) / "plan.json").read_text(encoding="utf-8"))
    data = json.loads(printed)
    assert data == written, "plan.json is not what --json prints"
    found = numbers_of(data)
    for route, rows in zip(found["routes"], data["routes"]):
        route["waypoints"] = columns(rows["waypoints"])
    return found


def tidal_bar() -> Any:
    """The hopper dredger of docs/tutorials/tidal_bar.md: loaded she waits, light she does not."""
    period, low_water = 12.42 * 3600.0, 1767236400.0

    def depth(time_s, lat, lon):
        return np.where((lon > 3.55) & (lon < 3.60), 7.0, 15.0) + 0.0 * lat

    def level(time_s, lat, lon):
        return -1.5 * np.cos(2 * np.pi * (time_s - low_water) / period) + 0.0 * lat

    sea = Sea.from_functions(
        {
            "sea_floor_depth_below_geoid": depth,
            "sea_surface_height_above_geopotential_datum": level,
        }
    )
    chart = Chart.open_water(51.6, 51.9, 3.40, 3.75)
    window = ("2026-01-01T00:00Z", "2026-01-01T12:00Z")
    ends = {"start": (51.71, 3.45), "goal": (51.77, 3.70), "min_ukc_m": 1.0}
    found = {}
    for name, load, when in (
        ("full", 1.0, {"depart": "2026-01-01T03:00Z"}),
        ("light", 0.3, {"depart": "2026-01-01T03:00Z"}),
        ("best departure", 1.0, {"depart_window": window}),
    ):
        ship = Ship.load("hopper-dredger").with_load_factor(load)
        answer = plan(Voyage(offing_nm=0.0, **ends, **when), ship=ship, sea=sea, chart=chart)
        found[name] = numbers_of_plan(answer)
        if name != "full":
            continue
        with tempfile.TemporaryDirectory() as folder:
            answer.write(folder)
            track = Path(folder) / "route.csv"
            again = evaluate(track, ship=ship, sea=sea, chart=chart, min_ukc=1.0)
        found[name]["read again"] = numbers_of_route(again)
    return found


def floro_santander() -> Any:
    """Florø to Santander around the control area (Seuren 2020), in at most 4.28 days."""
    data = Ship.load("handysize-bulker").data
    models = {"calm_water": "table", "speed_loss": "none"}
    ship = Ship.from_dict({**data, "models": models, "limits": {}})
    voyage = Voyage(
        offing_nm=0.0,
        start=(61.604, 5.03),
        goal=(43.47, -3.7645),
        depart="2026-01-01T00:00Z",
        arrive_by="2026-01-05T06:43Z",
        objective="front",
        fuel_price_usd=300.0,
        eca_price_factor=1.5593,
    )
    chart = Chart.gshhg("i").with_eca("north-sea")
    return numbers_of_plan(plan(voyage, ship=ship, sea=Sea.calm(), chart=chart))


def jet_and_eddies() -> Any:
    """A meandering jet, two eddies and a tide: 500 x 500 nm, scaled down by 100, on the equator."""
    nautical_mile, hour, departure = 18.52, 36.0, 1_767_225_600.0  # scaled down: metres and seconds
    per_lon, per_lat = 111319.49079327358, 110574.27582159436  # metres per degree

    def position(x, y):
        return y * nautical_mile / per_lat, x * nautical_mile / per_lon

    def current(t, x, y):
        wave = 2.0 * math.pi * (x / 320.0 - t / 260.0)
        middle = 250.0 + 45.0 * np.sin(wave)
        slope = 45.0 * (2.0 * math.pi / 320.0) * np.cos(wave)
        length = np.sqrt(1.0 + slope**2)
        jet = 2.6 * np.exp(-(((y - middle) / 28.0) ** 2) / 2.0)
        u, v = jet / length, jet * slope / length
        for k in (0, 1):
            sign = 1 - 2 * k
            cx, cy = 160.0 + 180.0 * k + 0.6 * t * sign, 330.0 - 170.0 * k
            e = np.exp(-((x - cx) ** 2 + (y - cy) ** 2) / (2.0 * 55.0**2))
            u, v = u - 0.045 * sign * (y - cy) * e, v + 0.045 * sign * (x - cx) * e
        tide = 0.5 * np.cos(2.0 * math.pi * t / 12.42)
        return u + 0.6 * tide, v + 0.8 * tide

    def component(index):
        def value(time_s, lat, lon):
            x, y = np.asarray(lon) * per_lon, np.asarray(lat) * per_lat
            t = (np.asarray(time_s) - departure) / hour
            return KNOT * current(t, x / nautical_mile, y / nautical_mile)[index]

        return value

    table = {
        "engines": [1] * 6 + [2] * 6,
        "power_percent": [75, 80, 85, 90, 95, 100] * 2,
        "speed_kn": [8.8, 9.5, 9.9, 10.3, 10.6, 10.8, 14.1, 14.3, 14.5, 14.8, 15.0, 15.2],
        "fuel_t_per_day": [14.3, 15.5, 16.4, 17.6, 18.9, 20.1, 28.9, 30.3, 32.0, 34.4, 36.8, 39.0],
    }
    models = {"calm_water": "table", "speed_loss": "none"}
    ship = Ship.from_dict(
        {"name": "table 5.3", "hull": {"draught_m": 9.5}, "table": table, "models": models}
    )
    (south, west), (north, east) = position(0.0, 0.0), position(500.0, 500.0)
    voyage = Voyage(
        offing_nm=0.0,
        start=position(100.0, 200.0),
        goal=position(400.0, 300.0),
        depart=departure,
        arrive_by=departure + 32.0 * hour,
        objective="front",
    )
    sea = Sea.from_functions({EAST: component(0), NORTH: component(1)})
    chart = Chart.open_water(south, north, west, east)
    return numbers_of_plan(plan(voyage, ship=ship, sea=sea, chart=chart))


def project() -> Any:
    """The example of ``thalweg project``, shortened, with overflow while loading."""
    project_file = Project.from_dict(
        {
            "name": "Nourishment behind the bank",
            "ship": {
                "name": "Trailing suction hopper dredger (van Halem 2019)",
                "hull": {"length_waterline_m": 80, "breadth_m": 20},
                "loading": {
                    "draught_full_m": 6.5,
                    "draught_empty_m": 3.5,
                    "speeds_full_kn": [10.0],
                    "speeds_empty_kn": [12.0],
                    "weight_full_t": 10000,
                    "weight_empty_t": 4000,
                    "capacity_m3": 4000,
                },
                "engine": {
                    "reference_speed_kn": 10.0,
                    "reference_power_kw": 2400,
                    "sfoc_g_per_kwh": 200,
                    "hotel_load_kw": 150,
                },
                "fuel": {"type": "MDO"},
                "costs": {"per_week": 700000, "per_second_per_cubed_speed": 0.008},
                "models": {"squat": "van_halem_2019"},
            },
            "sea": "synthetic-estuary",
            "load": [51.7449, 3.579],
            "unload": [51.6596, 3.6514],
            "volume_m3": 42_000,
            "hopper_m3": 4000,
            "loading": {"minutes": [0, 30, 50], "share": [0, 0.8, 1], "power_kw": 1500},
            "unloading": {"rate_m3_s": 1.5, "power_kw": 2000},
            "load_factors": 11,
            "start": "2026-05-01T00:00Z",
            "days": 5,
            "min_ukc_m": 1.0,
            "base_case": {
                "load_factor": "best",
                "route": [
                    *([51.7449, 3.579], [51.6964, 3.437], [51.673, 3.437]),
                    *([51.6613, 3.4631], [51.6569, 3.55], [51.6596, 3.6514]),
                ],
            },
        }
    )
    ship, sea, chart = open_project_inputs(project_file)
    result = run_project(project_file, ship=ship, sea=sea, chart=chart)
    data = result.as_dict()
    network = {key: data["provenance"]["network"][key] for key in ("nodes", "edges")}
    found = {"runs": numbers_of(data["runs"]), "gains": data["gains"], "network": network}
    for run in result.runs:
        found["runs"][run.name]["legs"] = [
            {
                "way": way,
                "depart_h": (leg.route.depart - result.optimised.cycles[0].start) / 3600.0,
                "waiting_s": leg.waiting,
                "clearance_m": known(leg.clearance),
                **numbers_of_route(leg.route, FEW),
            }
            for cycle in run.cycles
            for way, leg in (("out", cycle.out), ("back", cycle.back))
        ]
    return found


def ensemble() -> Any:
    """Five forecasts of one low (docs/howto/ensembles.md): a front by the worst tenth."""
    departure, wave = 1_767_225_600.0, "sea_surface_wave"

    def forecast(number):
        speed, track, strength = 0.25 + 0.06 * number, 43.4 + 0.5 * number, 1.25 - 0.1 * number

        def low(time_s, lat, lon):
            """Return the distances east and north of the low [deg], and its strength there."""
            x = lon + 24.0 - speed * (time_s - departure) / 3600.0
            y = lat - track
            return x, y, strength * np.exp(-((x / 5.0) ** 2 + (y / 3.0) ** 2) / 2.0)

        def east(time_s, lat, lon):
            _, y, share = low(time_s, lat, lon)
            return 5.0 - 7.0 * y * share

        def north(time_s, lat, lon):
            x, _, share = low(time_s, lat, lon)
            return 1.0 + 5.0 * x * share

        return Sea.from_functions(
            {
                "eastward_wind": east,
                "northward_wind": north,
                f"{wave}_significant_height": lambda t, y, x: 1.5 + 6.0 * low(t, y, x)[2],
                f"{wave}_to_direction": lambda t, y, x: 70.0 + 2.0 * (y - 45.0),
                f"{wave}_period_at_variance_spectral_density_maximum": lambda t, y, x: (
                    7.0 + 4.0 * low(t, y, x)[2]
                ),
            },
            time_step=3600.0,
        )

    sea = Sea.ensemble(*(forecast(number) for number in range(5)))
    data = Ship.load("handysize-bulker").data
    every_third = {name: values[1::3] for name, values in data["table"].items()}
    ship = Ship.from_dict({**data, "table": every_third})
    chart = Chart.open_water(40.0, 50.0, -28.0, -10.0)
    voyage = Voyage(
        offing_nm=0.0,
        start=(45.0, -26.0),
        goal=(45.5, -13.0),
        depart=departure,
        arrive_by=departure + 48.0 * 3600.0,
        objective="front",
        ensemble="cvar",
    )
    answer = plan(voyage, ship=ship, sea=sea, chart=chart, resolution=30_000.0)
    through = [voyage.start, (43.4, -20.0), voyage.goal]  # exceeds a limit in some members
    spread = evaluate_members(through, ship=ship, sea=sea, chart=chart, depart=departure)
    return {
        **numbers_of_plan(answer),
        "one route in all members": {
            **numbers_of(spread.as_dict()),
            "routes": [numbers_of_route(route, FEW) for route in spread.routes],
        },
    }


PLANS: dict[str, Callable[[], Any]] = {
    "demo": demo,
    "tidal-bar": tidal_bar,
    "floro-santander": floro_santander,
    "jet-and-eddies": jet_and_eddies,
    "project": project,
    "ensemble": ensemble,
}


# -- from answers to plain numbers -----------------------------------------------------------------


def numbers_of_plan(answer: Any) -> dict[str, Any]:
    """Return all numbers of a plan."""
    data = answer.to_dict()
    found = numbers_of(data)
    few = FEW if len(answer.routes) > 1 else None
    for row, route in zip(found["routes"], answer.routes):
        row["waypoints"] = waypoints(route, few)
    return found


def numbers_of_route(route: Any, few: tuple[str, ...] | None = None) -> dict[str, Any]:
    """Return all numbers of a route."""
    return {**numbers_of(route.as_dict()), "waypoints": waypoints(route, few)}


def numbers_of(data: Any) -> Any:
    """Return plain data without what is not compared; reasons of rejections become a list."""
    if isinstance(data, list):
        return [numbers_of(part) for part in data]
    if not isinstance(data, dict):
        return data
    found = {key: numbers_of(part) for key, part in data.items() if key not in LEFT_OUT}
    if "rejections" in data:
        found["rejections"] = [list(pair) for pair in sorted(data["rejections"].items())]
    if "networks" in data.get("provenance", {}):
        searched = data["provenance"]["networks"]
        found["networks"] = [{key: one.get(key) for key in FACTS} for one in searched]
        found["table_error"] = data["provenance"]["ship"]["table_error"]
    return found


def waypoints(route: Any, few: tuple[str, ...] | None) -> dict[str, list[Any]]:
    """Return the columns of a route's waypoints, with hours since the departure."""
    frame = route.to_frame()
    hours = (frame["time"] - frame["time"].iloc[0]) / np.timedelta64(1, "h")
    frame = frame.drop(columns="time").assign(hours=hours)
    return columns(frame[list(few) if few else list(frame)].to_dict("records"))


def columns(rows: list[dict[str, Any]]) -> dict[str, list[Any]]:
    """Return rows as columns; None where a number is unknown."""
    names = [name for name in (rows[0] if rows else {}) if name not in LEFT_OUT]
    return {name: [known(row[name]) for row in rows] for name in names}


def known(value: Any) -> Any:
    return None if isinstance(value, float) and not math.isfinite(value) else value


def brief(data: Any) -> Any:
    """Return plain data with every table of columns replaced by its hash and its sums."""
    if isinstance(data, list):
        return [brief(part) for part in data]
    if not isinstance(data, dict):
        return data
    return {key: summary(part) if key in ARRAYS else brief(part) for key, part in data.items()}


def summary(table: dict[str, list[Any]]) -> dict[str, Any]:
    text = json.dumps(table, sort_keys=True)
    return {
        "rows": max((len(column) for column in table.values()), default=0),
        "sha256": hashlib.sha256(text.encode()).hexdigest()[:16],
        "sums": {
            name: math.fsum(v or 0.0 for v in column)
            for name, column in table.items()
            if not any(isinstance(v, str) for v in column)
        },
    }


# -- comparing -------------------------------------------------------------------------------------


def leaves(data: Any, where: str = "", quantity: str = "") -> Iterator[tuple[str, str, Any]]:
    """Yield the place, the quantity (the place without numbers of rows) and the value of each.

    The length of every list is a value, too: new entries of an empty list are differences.
    """
    if isinstance(data, dict):
        for key, part in data.items():
            yield from leaves(part, f"{where}.{key}".strip("."), f"{quantity}.{key}".strip("."))
    elif isinstance(data, list):
        yield f"{where}.count", f"{quantity}.count", len(data)
        for index, part in enumerate(data):
            yield from leaves(part, f"{where}[{index}]", quantity)
    else:
        yield where, quantity, data


def difference(name: str, old: Any, new: Any) -> float:
    """Return the difference of two values: inf where they are not both numbers."""
    if old == new and type(old) is type(new):
        return 0.0
    both = (old, new)
    if not all(isinstance(v, (int, float)) and not isinstance(v, bool) for v in both):
        return math.inf
    apart = abs(old - new)
    turned = name == "lon" or name.endswith("_deg")  # 359.9 degrees and 0.1 are neighbours
    return min(apart, abs(360.0 - apart)) if turned else apart


def compare(before: Any, after: Any, tolerances: dict[str, float]) -> tuple[list[str], bool]:
    """Return a line for all quantities and one for each that differs, and whether all agree."""
    old, values = defaultdict(dict), {}
    for where, quantity, value in leaves(before):
        if LEFT_OUT.isdisjoint(quantity.split(".")):
            old[quantity][where] = value
    for where, quantity, value in leaves(after):
        values[where] = value
        if quantity in old:
            old[quantity].setdefault(where, "nothing")
    lines, well, same, count = [], True, 0, 0
    for quantity, places in old.items():
        name = quantity.rsplit(".", 1)[-1]
        pairs = {where: (value, values.get(where, "nothing")) for where, value in places.items()}
        apart = {where: difference(name, *pair) for where, pair in pairs.items()}
        count += len(pairs)
        if all(a == 0.0 for a in apart.values()):
            same += 1
            continue
        if name == "sha256" and any(tolerances.values()):
            continue  # the sums beside it are compared
        sizes = [abs(v) for v in places.values() if isinstance(v, (int, float))]
        scale = max(sizes, default=0.0) or 1.0
        worst = max(apart, key=lambda where: apart[where])
        allowed = tolerance_of(quantity, tolerances)
        good = apart[worst] / scale <= allowed
        well &= good
        others = sum(a > 0.0 for a in apart.values())
        lines.append(
            f"  {quantity:<56}{others:>6} of {len(pairs):<6} {apart[worst] / scale:9.2e}  "
            f"{'within' if good else 'BEYOND'}  {worst}: {pairs[worst][0]!r} -> {pairs[worst][1]!r}"
        )
    if not lines and same == len(old):
        return [f"  identical to the byte: {count} values of {same} quantities"], True
    head = f"  {same} of {len(old)} quantities identical to the byte ({count} values); the others"
    return [f"{head}: how many differ, by how much of the largest, where most", *lines], well


def tolerance_of(quantity: str, tolerances: dict[str, float]) -> float:
    """Return what a quantity may differ by: the longest name that fits counts."""
    fits = [name for name in tolerances if name and (f".{quantity}").endswith(f".{name}")]
    return tolerances[max(fits, key=len, default="")]


def parsed(texts: list[str]) -> dict[str, float]:
    """Return tolerances by name; the empty name is all others'."""
    pairs = [text.rpartition("=") for text in texts]
    return {"": 0.0, **{name: float(number) for name, _, number in pairs}}


# -- the command -----------------------------------------------------------------------------------


def computed(name: str) -> Any:
    """Compute a plan, and print how long it took."""
    import resource

    def spent() -> float:
        usages = [resource.getrusage(w) for w in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
        return sum(usage.ru_utime + usage.ru_stime for usage in usages)

    wall, work = time.perf_counter(), spent()
    found = PLANS[name]()
    wall, work = time.perf_counter() - wall, spent() - work
    print(f"{name}: {wall:.1f} s, {work:.1f} s of processor time", flush=True)
    return json.loads(json.dumps(found))  # as it comes out of a file


def made_with() -> dict[str, str]:
    """Return what else the last digits depend on; printed, not compared."""
    libraries = ("numpy", "scipy", "numba", "shapely", "pyproj")
    return {"python": platform.python_version(), "machine": platform.machine()} | {
        name: version(name) for name in libraries
    }


def write(path: Path, names: list[str], *, short: bool) -> int:
    plans = {name: computed(name) for name in names}
    data = {"brief": short, "made_with": made_with()}
    data["plans"] = brief(plans) if short else plans
    path.write_text(laid_out(data) + "\n", encoding="utf-8")
    print(f"wrote {path} ({path.stat().st_size / 1e6:.2f} MB)")
    return 0


def laid_out(data: Any, depth: int = 0) -> str:
    """Return JSON with a line for each entry, and lists of plain values on one line."""
    flat = json.dumps(data, allow_nan=False)
    if not isinstance(data, (dict, list)) or len(flat) < 96 or depth == 8:
        return flat
    if isinstance(data, list) and not any(isinstance(part, (dict, list)) for part in data):
        return flat
    pairs = data.items() if isinstance(data, dict) else ((None, part) for part in data)
    inner = [
        ("" if key is None else json.dumps(key) + ": ") + laid_out(part, depth + 1)
        for key, part in pairs
    ]
    lines = ",\n".join(" " * (depth + 1) + line for line in inner)
    left, right = "{}" if isinstance(data, dict) else "[]"
    return f"{left}\n{lines}\n{' ' * depth}{right}"


def check(path: Path, names: list[str], tolerances: dict[str, float]) -> int:
    data = json.loads(path.read_text(encoding="utf-8"))
    now = made_with()
    for name, was in data["made_with"].items():
        if was != now.get(name):
            print(f"note: the file was made with {name} {was}, this is {now.get(name)}")
    beyond = []
    for name in names:
        if name not in data["plans"]:
            print(f"{name}: not in the file")
            beyond.append(name)
            continue
        found = computed(name)
        lines, well = compare(
            data["plans"][name], brief(found) if data["brief"] else found, tolerances
        )
        print("\n".join(lines), flush=True)
        beyond += [] if well else [name]
    print(f"beyond the tolerance: {', '.join(beyond)}" if beyond else "all values agree")
    return 1 if beyond else 0


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("--write", type=Path, metavar="FILE", help="compute the plans and keep them")
    what.add_argument("--check", type=Path, metavar="FILE", help="compute and compare")
    parser.add_argument("--brief", action="store_true", help="write hashes and sums of waypoints")
    parser.add_argument("--only", action="append", choices=list(PLANS), help="may be given again")
    parser.add_argument("--tolerance", nargs="+", default=[], metavar="[NAME=]NUMBER")
    options = parser.parse_args()
    names = options.only or list(PLANS)
    print(f"thalweg of {Path(thalweg.__file__).parent}")
    if options.write:
        return write(options.write, names, short=options.brief)
    return check(options.check, names, parsed(options.tolerance))


if __name__ == "__main__":
    sys.exit(main())
