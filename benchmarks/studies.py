"""Studies and layered networks: building, indicators of segments, seasons, the study runner.

The sea is made: storms pass every 90 hours, and winters are rougher. Processor seconds are
measured, because other programs may be running; with ``--years N`` (default 1) the season has 730
departures a year.
"""

from __future__ import annotations

import argparse
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr

from thalweg.chart import Chart
from thalweg.core.limits import Limits
from thalweg.core.objective import FUEL_MASS
from thalweg.core.time import format_time, parse_time
from thalweg.core.units import HOUR
from thalweg.kernels import codes
from thalweg.kernels.pareto.edge_tables import sail_departures
from thalweg.network import Network, layered_network
from thalweg.sea import Sea, StationFields
from thalweg.search import FrontQuery, MultiSettingShipOnNetwork, pareto_front
from thalweg.search.pareto.front_problem import (
    FrontRequest,
    make_front_problem,
    new_edge_workspace,
)
from thalweg.ship import Ship
from thalweg.ship.consumption import consumption_table
from thalweg.studies import Study, run_study, study_run
from thalweg.studies.row_runner import run_rows

CHANNELS = (
    codes.WIND_EAST, codes.WIND_NORTH, codes.WAVE_HEIGHT_CHANNEL, codes.WAVE_EAST,
    codes.WAVE_NORTH, codes.WAVE_PERIOD,
)  # fmt: skip
START, FIRST, SECOND, GOAL = (
    (63.675, 9.298), (64.6047, 10.5371), (65.3480, 11.3946), (66.5653, 11.6697),
)  # fmt: skip
SHAPE = {"layers": 25, "fan": 5, "offset_nm": 2.4}
CASE = {
    "ship": "gunnerus-2019", "sea": ["sea.nc"], "network": "layered", "detail": "network",
    "voyage": {"start": list(START), "goal": list(GOAL), "offing_nm": 0.0, "layered": SHAPE},
}  # fmt: skip


def write_sea(path: Path, years: int, step: str = "3h") -> None:
    """Write the waves and winds of years on half a degree, from 1 January 2026 on."""
    times = pd.date_range("2026-01-01", f"{2026 + years}-01-10", freq=step)
    lat, lon = np.arange(62.5, 67.51, 0.5), np.arange(8.0, 14.01, 0.5)
    hour = np.arange(len(times)) * pd.Timedelta(step).total_seconds() / HOUR
    year = 1.6 + 1.0 * np.cos(2.0 * np.pi * hour / 8766.0)
    storm = 0.7 + 0.5 * np.sin(2.0 * np.pi * hour[:, None] / 90.0 + lat)
    exposed = 0.35 + 0.65 * np.clip((12.5 - lon) / 4.0, 0.0, 1.0)
    height = np.maximum(year[:, None, None] * storm[:, :, None] * exposed, 0.1)
    origin = np.radians(225.0 + 40.0 * np.sin(2.0 * np.pi * hour / 130.0))[:, None, None]
    origin = origin + 0.0 * height
    wind = 4.0 + 3.0 * height
    period = "sea_surface_wave_period_at_variance_spectral_density_maximum"
    fields = {
        "sea_surface_wave_significant_height": (height, "m"),
        "sea_surface_wave_from_direction": (np.degrees(origin) % 360.0, "degree"),
        period: (3.5 + 3.0 * np.sqrt(height), "s"),
        "eastward_wind": (-wind * np.sin(origin), "m s-1"),
        "northward_wind": (-wind * np.cos(origin), "m s-1"),
    }
    axes = ("time", "lat", "lon")
    data = {
        name: (axes, values.astype("f4"), {"standard_name": name, "units": unit})
        for name, (values, unit) in fields.items()
    }
    places = {
        "lat": ("lat", lat, {"units": "degrees_north"}),
        "lon": ("lon", lon, {"units": "degrees_east"}),
    }
    xr.Dataset(data, {"time": times, **places}).to_netcdf(path)


def seconds(function, runs: int = 1) -> tuple[float, object]:
    """Return the least processor time of some runs [s], and the result."""
    least, result = np.inf, None
    for _ in range(runs):
        begin = time.process_time()
        result = function()
        least = min(least, time.process_time() - begin)
    return least, result


def building() -> None:
    """S 30, H 20, small extent: 85,744 segments, of which the thesis kept 79,267."""
    chart = Chart.gshhg("i")
    taken, network = seconds(
        lambda: layered_network(chart, (START, GOAL), layers=30, fan=20, offset=4450.0), runs=4
    )
    print(
        f"layered network S 30 H 20: {taken:.3f} s, {len(network.graph.target):,} of 85,744 "
        "segments usable (exact land test)"
    )


def runner(folder: Path, count: int = 4000) -> None:
    """What the study runner adds to a voyage: rows that take no time themselves, 20 in a part."""
    speeds = np.linspace(1.0, 2.0, count).tolist()
    study = Study.from_dict({**CASE, "detail": "refined", "axes": {"speed_kn": speeds}}, folder)
    figures = {"refusal": None, "reason": None, "feasible": True, "time_h": 10.0, "fuel_t": 1.0}
    before, study_run.run_rows = (
        study_run.run_rows,
        lambda rows, folder: [{"id": row.id, **row.labels, **figures} for row in rows],
    )
    taken, _ = seconds(lambda: run_study(study, folder / "empty"))
    study_run.run_rows = before
    print(f"study runner: {1000 * taken / count:.2f} ms per voyage")


def driver(folder: Path) -> None:
    """Memory of a driver of 100,000 rows that take no time themselves."""
    axes = {"depart": {"from": "1926-01-01", "to": "2062-11-22", "step_h": 12}}
    study = Study.from_dict({**CASE, "axes": axes}, folder)
    study_run.run_rows = lambda rows, folder: [
        {"id": row.id, **row.labels, "refusal": None, "reason": None, "time_h": 10.0}
        for row in rows
    ]
    taken, state = seconds(lambda: run_study(study, folder / "many"))
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    print(f"driver of {state.total:,} rows: {taken:.1f} s, {memory:.0f} MB at most")


def case_3hf(folder: Path) -> tuple[Network, Ship, Sea]:
    """Return the network of three sections of the thesis in open water, its ship and weather."""
    network = layered_network(
        Chart.open_water(), (START, FIRST, SECOND, GOAL), layers=[1, 15, 20], fan=[5, 5, 3],
        offset=[13_350.0, 4450.0, 6230.0],
    )  # fmt: skip
    return network, Ship.load("gunnerus-2019"), Sea.open(folder / "sea.nc")


def frozen(network: Network, sea: Sea, depart: float, hours: float) -> StationFields:
    """Return the sea at the stations for a passage."""
    lat, lon = network.stations.lat, network.stations.lon
    return sea.freeze_stations(lat, lon, depart, depart + hours * HOUR, CHANNELS)


def segments(folder: Path) -> None:
    """Time, fuel, comfort and waves of every segment of 3HF at 101 updates."""
    network, ship, sea = case_3hf(folder)
    sea = sea.quasi_static(2.0)
    depart = parse_time("2026-03-01T00:00Z")
    updates = depart + 2.0 * HOUR * np.arange(101)
    tables = [consumption_table(ship, name) for name in ("fuel", "squared_dose")]
    top, edges = len(ship.speeds) - 1, np.arange(network.n_edges)
    limits = Limits(wave_height=ship.limits.wave_height, wind_speed=ship.limits.wind_speed)
    query = FrontRequest(0, network.meta.goal, depart, updates[-1], np.array([top]), FUEL_MASS,
                         np.ones(len(edges)), False)  # fmt: skip

    def all_indicators() -> list[np.ndarray]:
        fields = frozen(network, sea, depart, 230.0)
        found = []
        for table in tables:
            given = MultiSettingShipOnNetwork(network, fields, ship.tabulate(), table, limits)
            problem = make_front_problem(given, query)
            out = np.empty((len(edges) * len(updates), 2))
            sail_departures(
                problem.arrays, np.repeat(edges, 101), np.repeat(problem.tails, 101),
                np.zeros(len(out), np.int64), np.tile(updates, len(edges)), out,
                new_edge_workspace(),
            )  # fmt: skip
            found.append(out)
        return found

    all_indicators()
    taken, found = seconds(all_indicators, runs=3)
    known = np.mean([np.isfinite(out).all(axis=1).mean() for out in found])
    print(
        f"{len(edges):,} segments x 101 updates with time, fuel and comfort, the sea frozen: "
        f"{taken:.3f} s ({100 * known:.1f} % within the limits)"
    )


def months(folder: Path) -> None:
    """Twelve months by five models on 3HF, from the exact fronts of time with fuel and comfort.

    The models: least time, fuel and dose, and time with each of the two by equal weights, between
    the least and the largest value of the front.
    """
    network, ship, sea = case_3hf(folder)
    held = sea.quasi_static(8.0)
    tables = [consumption_table(ship, name) for name in ("fuel", "squared_dose")]
    top = len(ship.speeds) - 1

    def run() -> int:
        optima: set[tuple[object, ...]] = set()
        for k in range(12):
            depart = parse_time("2026-01-01T00:00Z") + 730.0 * HOUR * k
            fields = frozen(network, held, depart, 60.0)
            for table in tables:
                given = MultiSettingShipOnNetwork(network, fields, ship.tabulate(), table, Limits())
                query = FrontQuery(0, network.meta.goal, depart, depart + 40.0 * HOUR, [top],
                                   wait=False)  # fmt: skip
                front = pareto_front(given, query, bin_s=300.0, lower=False)
                sums = sum((x - x.min()) / max(np.ptp(x), 1e-9) for x in (front.time, front.cost))
                optima |= {(k, table is tables[0], "equal", int(np.argmin(sums)))}
                optima |= {(k, "least time"), (k, table is tables[0], "least of the other")}
        return len(optima)

    run()
    taken, optima = seconds(run)
    print(f"12 months, fronts of time with fuel and with comfort ({optima} optima): {taken:.2f} s")


def season(folder: Path, years: int) -> None:
    """Departures every 12 hours, with all figures, in this process."""
    last = format_time(parse_time(f"{2026 + years}-01-01T00:00Z") - 24.0 * HOUR)
    axes = {"depart": {"from": "2026-01-01", "to": last, "step_h": 12}}
    rows = Study.from_dict({**CASE, "axes": axes}, folder).rows()
    run_rows(rows[:1], str(folder))
    taken, found = seconds(lambda: run_rows(rows, str(folder)))
    refused = sum(row["refusal"] is not None for row in found)
    print(f"{len(rows):,} departures: {taken:.1f} s, {1000 * taken / len(rows):.1f} ms each, "
          f"{refused} refused")  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--years", type=int, default=1)
    parser.add_argument("--driver", metavar="DIR", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.driver is not None:
        driver(Path(arguments.driver))
        return
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        # first: a child process starts with the peak memory of its parent
        subprocess.run([sys.executable, __file__, "--driver", name], check=True)
        write_sea(folder / "sea.nc", arguments.years)
        building()
        runner(folder)
        segments(folder)
        months(folder)
        season(folder, arguments.years)


if __name__ == "__main__":
    main()
