"""Ships: time, memory and error of performance tables, direct evaluation, kernel look-up.

Run ``python benchmarks/ship_tables.py [--quick]``; prints medians of CPU time. Targets: a table in
3 s and 64 MB with an error of 1 % (99th percentile), 10^6 conditions directly in 5 s, a look-up in
150 ns.
"""

from __future__ import annotations

import argparse
import statistics
import time
from functools import partial

import numpy as np

from thalweg.kernels.compilation.jit import jit
from thalweg.kernels.leg.table_lookup import table_value
from thalweg.ship import Conditions, Ship, library_names
from thalweg.ship.models.resistance_model import ResistanceModel
from thalweg.ship.models.tabulate_fuel import tabulate_rate_of_power
from thalweg.ship.models.tabulate_resistance import tabulate_balance

#: a full ship: calm water, shallow water, waves of every heading, wind, propeller chain
FULL = {
    "name": "full ship",
    "hull": {
        "length_waterline_m": 172.42,
        "length_between_perpendiculars_m": 169.0,
        "breadth_m": 32.0,
        "draught_m": 10.0,
        "block_coefficient": 0.785,
        "frontal_area_m2": 700.0,
        "lateral_area_m2": 1800.0,
    },
    "engine": {"power_kw": 9000, "type": "slow_speed_diesel"},
    "fuel": {"type": "hfo"},
    "limits": {"max_significant_wave_height_m": 8.0, "max_wind_speed_m_s": 28.0},
    "models": {
        "calm_water": "holtrop_1984",
        "shallow_water": "karpov",
        "waves": "snnm",
        "wind": "blendermann_1994",
        "wind_type": "tanker_loaded",
    },
}


@jit
def _many(table, points, setting, out):
    for i in range(points.shape[0]):
        p = points[i]
        value, ok = table_value(table, (p[0], p[1], p[2], p[3], p[4], p[5]), setting)
        out[i] = value if ok else np.nan


def _conditions(count: int) -> Conditions:
    draw = np.random.default_rng(0)
    return Conditions(
        wind_speed=draw.uniform(0, 28, count),
        wind_angle=draw.uniform(0, np.pi, count),
        wave_height=draw.uniform(0, 8, count),
        wave_angle=draw.uniform(0, np.pi, count),
        wave_period=draw.uniform(3, 20, count),
        depth=draw.uniform(11, 300, count),
    )


def _cpu(function, repeats: int) -> float:
    spent = []
    for _ in range(repeats):
        start = time.process_time()
        function()
        spent.append(time.process_time() - start)
    return statistics.median(spent)


def _build(ship: Ship) -> None:
    """Build the table without the cache on disk."""
    if isinstance(ship.model, ResistanceModel):
        tabulate_balance(ship.model, ship.loading.load_factor, 0.01)
    else:
        ship.tabulate()


def table_rows(repeats: int) -> None:
    print(f"{'ship':24} {'build s':>8} {'MB':>6} {'mean':>8} {'p99':>8} {'max':>8}")
    ships = {name: lambda name=name: Ship.load(name) for name in library_names()}
    ships["full ship"] = lambda: Ship.from_dict(FULL)
    for name, make in ships.items():
        seconds = _cpu(lambda make=make: _build(make()), repeats)
        table = make().tabulate()
        error = table.error
        print(
            f"{name:24} {seconds:8.2f} {table.nbytes / 1e6:6.1f} "
            f"{error.mean:8.4f} {error.p99:8.4f} {error.max:8.3f}"
        )


def fuel_rows() -> None:
    print("\nfuel tables: the full ship and JBC at ordered speeds")
    held = {key: value for key, value in Ship.load("jbc").data.items() if key != "powers_kw"}
    for name, data in {
        "full ship": {**FULL, "speeds_kn": [8, 10, 12, 13.5]},
        "jbc": {**held, "speeds_kn": [9, 11, 13, 14]},
    }.items():
        model = Ship.from_dict(data).model
        seconds = _cpu(
            lambda model=model: tabulate_rate_of_power(model, 1.0, 0.01, model.plant.fuel), 1
        )
        table, _ = tabulate_rate_of_power(model, 1.0, 0.01, model.plant.fuel)
        error = table.error
        print(
            f"{name:24} {seconds:8.2f} {table.nbytes / 1e6:6.1f} "
            f"{error.mean:8.4f} {error.p99:8.4f} {error.max:8.3f}"
        )


def direct_rows(count: int) -> None:
    print(f"\ndirect evaluation, {count} conditions, scaled to 10^6 [s CPU]")
    conditions = _conditions(count)
    cases = {
        "calm + wind": {"waves": "none", "shallow_water": "none"},
        "calm + wind + STAwave-1": {"waves": "stawave_1", "shallow_water": "none"},
        "calm + wind + STAwave-2": {"waves": "stawave_2", "shallow_water": "none"},
        "calm + wind + SNNM": {"waves": "snnm", "shallow_water": "none"},
        "calm + shallow + wind + SNNM": {},
        "the same, with a propeller": {"propulsion": "wageningen_b"},
    }
    screw = {"propulsion": Ship.load("jbc").data["propulsion"]}
    for name, models in cases.items():
        ship = Ship.from_dict({**FULL, **screw, "models": {**FULL["models"], **models}})
        scale = 1e6 / count
        power = _cpu(lambda ship=ship: ship.power_at_speed(conditions, 6.5), 3) * scale
        speed = _cpu(lambda ship=ship: ship.speed_through_water(conditions, 4), 1) * scale
        print(f"{name:30} power at a speed {power:6.2f}   speed at a power {speed:6.2f}")
    bulker = Ship.load("handysize-bulker")
    kwon = _cpu(lambda: bulker.speed_through_water(conditions, 11), 3) * scale
    print(f"{'table + Kwon':30} speed at a setting {kwon:6.2f}")


def lookup_rows(count: int) -> None:
    print("\nkernel look-up [ns]")
    c = _conditions(count)
    names = ("wind_speed", "wind_angle", "wave_height", "wave_angle", "wave_period", "depth")
    points, out = np.stack([c[name] for name in names], axis=1), np.zeros(count)
    for name, ship in {
        "handysize-bulker": Ship.load("handysize-bulker"),
        "kvlcc2": Ship.load("kvlcc2"),
        "yu-single-screw-169m": Ship.load("yu-single-screw-169m"),
        "full ship with depth": Ship.from_dict(FULL),
    }.items():
        arrays = ship.tabulate().kernel_arrays()
        _many(arrays, points, 2, out)
        run = partial(_many, arrays, points, 2, out)
        print(f"{name:24} {_cpu(run, 7) / count * 1e9:6.0f}")


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--quick", action="store_true")
    quick = parser.parse_args().quick
    table_rows(1 if quick else 3)
    fuel_rows()
    direct_rows(20_000 if quick else 100_000)
    lookup_rows(100_000 if quick else 400_000)


if __name__ == "__main__":
    main()
