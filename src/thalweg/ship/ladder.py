"""Speeds of a resistance-based ship over whole grids of conditions, for its tables.

At every rung, a speed, the resistance that a setting can just overcome is known; the ship goes as
fast as the last rung at which weather asks for no more than that. Over a grid of conditions this
takes a few additions a rung, because wind, waves and depth each act on their own axes.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from thalweg.ship.powering import FASTEST, Balance, ResistanceModel
from thalweg.ship.solve import bracketed_root
from thalweg.ship.weather_parts import LONGEST_PERIOD, SHORTEST_PERIOD, Waves

FloatArray = NDArray[np.float64]
_RUNGS = 33


@dataclass(frozen=True, eq=False)
class WaveTable:
    """Wave force per square of wave height, on a grid of speed, period and angle.

    Attributes
    ----------
    speeds, periods, angles : ndarray
        Grid points [m/s], [s], [rad].
    values : ndarray
        [N/m2].
    """

    speeds: FloatArray
    periods: FloatArray
    angles: FloatArray
    values: FloatArray

    @classmethod
    def of(cls, waves: Waves, speeds: FloatArray) -> WaveTable:
        """Tabulate the force of a wave method at an odd number of even speeds [m/s].

        Every second speed is the mean of its neighbours.
        """
        periods, angles = _grid(waves, float(speeds[len(speeds) // 2]))
        v, t, a = np.meshgrid(speeds[::2], periods, angles, indexing="ij", sparse=True)
        coarse = waves.force(v, np.ones(()), t, a)
        values = np.empty((len(speeds), *coarse.shape[1:]))
        values[::2], values[1::2] = coarse, 0.5 * (coarse[:-1] + coarse[1:])
        return cls(speeds, periods, angles, values)

    @classmethod
    def at_all(cls, waves: Waves, speeds: FloatArray) -> WaveTable:
        """Tabulate the force of a wave method at any speeds [m/s]."""
        periods, angles = _grid(waves, float(speeds[len(speeds) // 2]))
        v, t, a = np.meshgrid(speeds, periods, angles, indexing="ij", sparse=True)
        shape = np.broadcast_shapes(v.shape, t.shape, a.shape)
        values = np.broadcast_to(waves.force(v, np.ones(()), t, a), shape)
        return cls(speeds, periods, angles, np.array(values))

    def at_speed(self, rung: int, period: FloatArray, angle: FloatArray) -> FloatArray:
        """Return the interpolated force per square of wave height at one of the speeds [N/m2]."""
        j, g = _cell(self.periods, np.clip(period, SHORTEST_PERIOD, LONGEST_PERIOD))
        k, h = _cell(self.angles, angle)
        v = np.broadcast_to(self.values[rung], (len(self.periods), len(self.angles)))
        near = v[j, k] + h * (v[j, k + 1] - v[j, k])
        far = v[j + 1, k] + h * (v[j + 1, k + 1] - v[j + 1, k])
        return near + g * (far - near)


def _grid(waves: Waves, speed: float) -> tuple[FloatArray, FloatArray]:
    """Periods [s] and angles [rad] between which the force is interpolated."""
    timed = "wave_period" in waves.reads
    periods = np.geomspace(SHORTEST_PERIOD, LONGEST_PERIOD, 48 if timed else 2)
    return periods, _angles(waves, speed)


def _angles(waves: Waves, speed: float) -> FloatArray:
    """Angles every 3.75 degrees, and both sides of every jump that the method makes over them."""
    fine = np.linspace(0.0, np.pi, 2881)
    force = waves.force(np.asarray(speed), np.ones(()), np.asarray(6.0), fine)
    step = np.abs(np.diff(force))
    jumps = np.flatnonzero((step > 0.01 * np.nanmax(np.abs(force))) & (step > 20 * np.median(step)))
    return np.unique(np.concatenate([np.linspace(0.0, np.pi, 49), fine[jumps], fine[jumps + 1]]))


def _cell(nodes: FloatArray, x: FloatArray) -> tuple[NDArray[np.intp], FloatArray]:
    known = np.where(np.isnan(x), nodes[0], x)
    cell = np.clip(np.searchsorted(nodes, known, side="right") - 1, 0, len(nodes) - 2)
    return cell, np.clip((x - nodes[cell]) / (nodes[cell + 1] - nodes[cell]), 0.0, 1.0)


@dataclass(frozen=True, eq=False)
class Ladder:
    """Rungs of speed with the resistance each setting can overcome there.

    Attributes
    ----------
    balance : Balance
    speeds : ndarray
        The rungs [m/s], ascending from 0.
    able : ndarray
        Resistance that can be overcome [N], shape ``(rungs, powers)``.
    calm : ndarray
        Calm-water speed of every setting [m/s].
    held : bool
        Settings are speeds to hold, with one power behind them, instead of powers.
    waves : WaveTable, optional
    """

    balance: Balance
    speeds: FloatArray
    able: FloatArray
    calm: FloatArray
    held: bool
    waves: WaveTable | None = None

    @classmethod
    def of(cls, model: ResistanceModel, load_factor: float) -> Ladder:
        """Build the ladder of a ship at a load factor."""
        balance, calm = model.balance(load_factor), model.speeds(load_factor)
        speeds = np.linspace(0.0, FASTEST * calm.max(), _RUNGS)
        held = model.orders.kind == "speed"
        powers = np.array([model.plant.largest_power] if held else model.orders.values)
        waves = None if balance.waves is None else WaveTable.of(balance.waves, speeds)
        return cls(balance, speeds, _able(balance, speeds, powers), calm, held, waves)

    def __call__(self, where: Mapping[str, FloatArray]) -> FloatArray:
        """Speeds [m/s] in conditions by name, arrays that broadcast; shape ``(*shape, settings)``.

        Conditions that are not given are calm and deep.
        """
        shape = np.broadcast_shapes(*(np.shape(values) for values in where.values()))
        size = (*shape, self.able.shape[1])
        rungs, part, lack, before = (np.zeros(size, np.float32) for _ in range(4))
        able = self.able.astype(np.float32)
        alive = np.ones(size, bool)
        for rung, speed in enumerate(self.speeds):
            force = resistance_on_grid(self.balance, self.waves, rung, float(speed), where)
            asked = np.asarray(force, np.float32)[..., None]
            np.subtract(asked, able[rung], out=lack)
            short = lack < 0.0
            if rung > 0:
                _climb(before, lack, short, part)
                part *= alive
                rungs += part
            alive &= short
            before, lack = lack, before
        found = rungs.astype(float) * (self.speeds[1] - self.speeds[0])
        found[np.isnan(before)] = np.nan
        if self.held:
            return np.minimum(np.where(alive, np.inf, found), self.calm)
        return np.minimum(found, FASTEST * self.calm)


def resistance_on_grid(
    balance: Balance,
    waves: WaveTable | None,
    rung: int,
    speed: float,
    where: Mapping[str, FloatArray],
) -> FloatArray:
    """Resistance [N] at a speed [m/s], the ``rung``-th of the wave table, in conditions by name."""
    own = np.asarray(speed)
    total = balance.calm.total(own, np.asarray(where.get("depth", np.inf), float))
    if waves is not None and "wave_height" in where:
        period = np.asarray(where.get("wave_period", 10.0), float)
        force = waves.at_speed(rung, period, np.asarray(where["wave_angle"], float))
        total = total + np.asarray(where["wave_height"], float) ** 2 * force
    if balance.wind is not None:
        blow, angle = where.get("wind_speed", 0.0), where.get("wind_angle", 0.0)
        total = total + balance.wind.force(own, np.asarray(blow), np.asarray(angle))
    return np.asarray(total)


def _climb(
    before: NDArray[np.float32],
    lack: NDArray[np.float32],
    short: NDArray[np.bool_],
    part: NDArray[np.float32],
) -> None:
    """Share of the step from one rung to the next, written to ``part``: all where still short."""
    with np.errstate(divide="ignore", invalid="ignore"):
        np.subtract(before, lack, out=part)
        np.divide(before, part, out=part)
    np.copyto(part, np.float32(1.0), where=short)


def _able(balance: Balance, speeds: FloatArray, powers: FloatArray) -> FloatArray:
    """Resistance [N] at which powers [W] are just used, at every speed."""
    top = 40.0 * float(np.max(balance.calm.total(speeds[-1:], np.array([np.inf]))))
    v, p = (grid.ravel() for grid in np.meshgrid(speeds, powers, indexing="ij"))
    if np.isinf(p).any():
        return np.full((len(speeds), len(powers)), np.inf)

    def excess(resistance: FloatArray, index: NDArray[np.intp]) -> FloatArray:
        return balance.propulsion.brake_power(v[index], resistance) - p[index]

    root = bracketed_root(excess, np.zeros(v.size), np.full(v.size, top), tolerance=1e-6 * top)
    return root.reshape(len(speeds), len(powers))
