"""The SNNM formula for one hull and many conditions, with precomputed sums over the spectrum.

The mean of `thalweg.ship.methods.added_resistance.snnm.snnm_transfer` over a spectrum is a sum over
about a hundred frequencies.
For one hull most factors of the summands depend on few numbers: the motion on the peak frequency in
units of the hull's natural frequency and on the speed of the ship relative to the waves; the
reflection on the peak frequency and the effective draught. Partial sums over these are tabulated
once, in steps of two thousandths of the peak frequency; the other factors are evaluated directly.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.core.types import FloatArray
from thalweg.core.units import GRAVITY, SEA_WATER_DENSITY
from thalweg.ship.methods.added_resistance.mean_wave_force import (
    LOG_FREQUENCY_STEP,
    REFLECTION_STEP,
    in_blocks,
    log_spaced_nodes,
    spectral_shape,
)
from thalweg.ship.methods.added_resistance.snnm import (
    LONGEST_REFLECTED_WAVE,
    ahead_factors,
    fold_angle,
    frequency_scale,
    motion_shape,
    reflection_terms,
    speed_factor,
)
from thalweg.ship.methods.added_resistance.snnm_hull import (
    SnnmHull,
)
from thalweg.ship.methods.resistance.friction_lines import froude_number, ship_speed

IntArray = NDArray[np.intp]
_SPECTRUM: Final = "bretschneider"
_STEP: Final = 0.002  # of the logarithm of peak frequencies
_BLOCK: Final = 8192
_FAR: Final = 0.12  # relative Froude number where the published factors change
_DRAUGHT_POINTS: Final = 33  # draughts that count at the stern


@dataclass(frozen=True, eq=False)
class LogTable:
    """Functions of a positive number, linear in its logarithm between close nodes.

    Attributes
    ----------
    first : Logarithm of the first node.
    values : Shape ``(nodes, ...)``.
    """

    first: float
    values: FloatArray

    @classmethod
    def grid(cls, low: float, high: float) -> FloatArray:
        """Return the nodes from a number to another."""
        return np.exp(np.arange(np.log(low), np.log(high) + 2 * _STEP, _STEP))

    def cell(self, x: FloatArray) -> tuple[IntArray, FloatArray]:
        """Return (index, fraction) of numbers; the ends hold beyond them."""
        place = (np.log(x) - self.first) / _STEP
        place = np.clip(np.where(np.isnan(place), 0.0, place), 0.0, len(self.values) - 1.001)
        index = place.astype(np.intp)
        return index, place - index

    def at(self, cell: tuple[IntArray, FloatArray], place: IntArray | int) -> FloatArray:
        """Return one of the interpolated functions, by its place in a row of the values."""
        low, part = cell
        flat = self.values.reshape(-1)
        width = flat.size // len(self.values)
        index = low * width + place
        near = flat.take(index)
        return np.asarray(near + part * (flat.take(index + width) - near))


@dataclass(frozen=True, eq=False)
class SnnmTable:
    r"""SNNM for one hull: mean added resistance in long-crested Bretschneider seas.

    .. math::
        R_{AW} = 2 \int_0^\infty \frac{R_{AWM}(\omega) + R_{AWR}(\omega)}{\zeta_A^2}
            E(\omega) \, d\omega

    with the terms of `thalweg.ship.methods.added_resistance.snnm.snnm_transfer`.

    Attributes
    ----------
    hull : Particulars, as `SnnmHull.arrays` gives them.
    reduced : Frequencies of the motion in units of the hull's own.
    shape : `motion_shape` there.
    motion : Over the peak in the same units: sums up to every frequency, times its powers -1, 0, 1.
    bow, stern : Over the peak frequency [rad/s]: sums of the reflection, times the powers 0 and 1
        of the frequency; at the stern for every draught that may count.
    """

    hull: tuple[FloatArray, ...]
    reduced: FloatArray
    shape: FloatArray
    motion: LogTable
    bow: LogTable
    stern: LogTable

    @classmethod
    def of(cls, hull: SnnmHull, *, shortest: float, longest: float) -> SnnmTable:
        """Sum up for a hull of numbers, for peak periods from ``shortest`` to ``longest`` [s]."""
        own = tuple(np.asarray(value, float) for value in hull.arrays())
        reduced = log_spaced_nodes(0.3, 4.0, step=LOG_FREQUENCY_STEP[_SPECTRUM])
        shape = motion_shape(reduced, own)
        angles, fast = np.linspace(0.0, np.pi, 181), np.array([[0.0], [0.42], [1.0]])
        scales = frequency_scale(angles, fast, own, GRAVITY)
        peaks = LogTable.grid(2.0 * np.pi / longest, 2.0 * np.pi / shortest)
        low, high = max(float(scales.min()), 0.01), float(scales.max())
        grid = LogTable.grid(low * peaks[0], high * peaks[-1])
        energy = spectral_shape(reduced / grid[:, None], spectrum=_SPECTRUM, gamma=1.0) * shape
        sums = np.zeros((len(grid), reduced.size + 1, 3))
        np.cumsum(energy[..., None] * reduced[:, None] ** np.arange(-1, 2), axis=1, out=sums[:, 1:])
        bow, stern = _reflections(own, peaks)
        return cls(own, reduced, shape, LogTable(float(np.log(grid[0])), sums), bow, stern)

    def __call__(
        self, speed: ArrayLike, wave_height: ArrayLike, wave_period: ArrayLike, angle: ArrayLike
    ) -> FloatArray:
        """Return the mean added resistance [N].

        Parameters
        ----------
        speed : Speed through the water [m/s].
        wave_height, wave_period : Significant height [m] and peak period [s].
        angle : [rad], 0 from ahead, pi from astern.

        Returns
        -------
        ndarray : May be negative for following waves; zero where the wave height is zero, NaN where
            something is unknown.
        """
        velocity, turned = ship_speed(speed), fold_angle(angle)
        period = np.asarray(wave_period, dtype=float)
        peak = 2.0 * np.pi / np.where(period > 0.0, period, np.nan)
        fn = froude_number(velocity, length=self.hull[0])
        mean = in_blocks(self._mean, velocity, peak, turned, fn, block=_BLOCK)
        height = np.asarray(wave_height, dtype=float)
        force = SEA_WATER_DENSITY * GRAVITY * height**2 * mean
        return np.where((height == 0.0) & ~np.isnan(fn), 0.0, force)

    def _mean(
        self, speed: FloatArray, peak: FloatArray, angle: FloatArray, fn: FloatArray
    ) -> FloatArray:
        """Mean force over rho g Hs^2 for flat arrays."""
        arrays = np.broadcast_arrays(speed, peak, angle, fn)
        speed, peak, angle, fn = arrays
        length, breadth, _, trim, block, gyration = self.hull[:6]
        scale = frequency_scale(angle, fn, self.hull, GRAVITY)
        cell = self.motion.cell(scale * peak)
        first, second = ahead_factors(angle, fn, self.hull)
        moved = first * second * self.motion.at(cell, 3 * self.reduced.size + 1)
        abaft = np.flatnonzero(angle > 0.5 * np.pi)
        if abaft.size:
            at = tuple(a[abaft] for a in (speed, peak, angle, fn, scale, first, second))
            moved[abaft] = self._from_abaft(*at, cell=(cell[0][abaft], cell[1][abaft]))
        size = 3859.2 * breadth / length * block**1.34 * gyration**2 * (1.0 + 28.7 * trim)
        reflected = self._reflection(speed, peak, angle, fn)
        total = (
            LOG_FREQUENCY_STEP[_SPECTRUM] * size * moved
            + 0.5625 * REFLECTION_STEP[_SPECTRUM] * reflected
        )
        unknown = np.isnan(speed + peak + angle + fn)
        return np.where(unknown, np.nan, 2.0 * breadth * total)

    def _from_abaft(
        self,
        speed: FloatArray,
        peak: FloatArray,
        angle: FloatArray,
        fn: FloatArray,
        scale: FloatArray,
        first: FloatArray,
        second: FloatArray,
        *,
        cell: tuple[IntArray, FloatArray],
    ) -> FloatArray:
        """Sum of factors times energy for waves from abaft the beam.

        The factors are linear in the frequency for waves that run from the ship, and linear in its
        inverse for those it overtakes slowly; those it overtakes fast are added one by one.
        """
        full, slim = 0.87 / self.hull[4], 1.0 / np.log(self.hull[1] / self.hull[2])
        part = np.clip(2.0 * angle / np.pi - 1.0, 0.0, 1.0)
        lead = first + part * (full * slim - first)
        stay = second * (1.0 - part)
        pace = np.maximum(2.0 * speed / (GRAVITY * scale), 1e-9)  # group number per frequency
        passed = np.searchsorted(self.reduced, 1.0 / pace, side="right")
        with np.errstate(divide="ignore"):
            quick = np.where(fn > _FAR, 1.0 / (pace * (1.0 - _FAR / np.maximum(fn, _FAR))), np.inf)
        fast = np.maximum(np.searchsorted(self.reduced, quick, side="left"), passed)
        below, slow0, slow1 = (self.motion.at(cell, 3 * passed + k) for k in range(3))
        low = self.motion.at(cell, 3 * fast) - below
        high = self.motion.at(cell, 3 * fast + 1) - slow0
        waits = stay - part * 0.0072
        total = lead * (waits * slow0 + part * 0.0144 * pace * slow1)
        slope = part * 0.1676 * fn
        total += lead * ((stay + part * 0.0072 + slope) * high - slope / pace * low)
        for k in range(self.reduced.size - 1, int(fast.min(initial=self.reduced.size)) - 1, -1):
            here = np.flatnonzero(fast <= k)
            relative = fn[here] * (1.0 - 1.0 / (pace[here] * self.reduced[k]))
            behind = np.exp((1.0 + relative) * np.log(full)) * slim
            own = first[here] + part[here] * (behind - first[here])
            own = own * (stay[here] + part[here] * speed_factor(relative))
            ratio = self.reduced[k] / (scale[here] * peak[here])
            energy = spectral_shape(ratio, spectrum=_SPECTRUM, gamma=1.0)
            total[here] += own * energy * self.shape[k]
        return np.asarray(total)

    def _reflection(
        self, speed: FloatArray, peak: FloatArray, angle: FloatArray, fn: FloatArray
    ) -> FloatArray:
        """Sum of what bow and stern reflect."""
        b0, b1, s0, s1, deep = reflection_terms(speed, angle, fn, self.hull, GRAVITY)
        cell = self.bow.cell(peak)
        reflected = b0 * self.bow.at(cell, 0) + b1 * self.bow.at(cell, 1)
        least = _least_depth(self.hull)
        place = (deep / self.hull[2] - least) / (1.0 - least) * (_DRAUGHT_POINTS - 1)
        place = np.clip(np.where(np.isnan(place), 0.0, place), 0.0, _DRAUGHT_POINTS - 1.001)
        row = place.astype(np.intp)
        for power, factor in ((0, s0), (1, s1)):
            shallow = self.stern.at(cell, 2 * row + power)
            deeper = self.stern.at(cell, 2 * row + 2 + power)
            reflected = reflected - factor * (shallow + (place - row) * (deeper - shallow))
        return np.asarray(reflected)


def _least_depth(hull: tuple[FloatArray, ...]) -> float:
    """Least draught that counts at the stern, as a part of the draught."""
    return 0.8 if float(hull[4]) <= 0.75 else 2.0 / 3.0


def _reflections(hull: tuple[FloatArray, ...], peaks: FloatArray) -> tuple[LogTable, LogTable]:
    """Sums of the energy that bow and stern reflect, over peak frequencies [rad/s]."""
    lowest = 2.0 * np.pi / (LONGEST_REFLECTED_WAVE * hull[0])
    above = log_spaced_nodes(1.0, 60.0, step=REFLECTION_STEP[_SPECTRUM])
    omega = above * np.sqrt(GRAVITY * lowest)
    excess = 2.0 * lowest * (above**2 - 1.0)
    energy = spectral_shape(omega / peaks[:, None], spectrum=_SPECTRUM, gamma=1.0)
    powers = omega[:, None] ** np.arange(2)
    draughts = hull[2] * np.linspace(_least_depth(hull), 1.0, _DRAUGHT_POINTS)
    share = -np.expm1(-draughts[:, None, None] * excess[:, None]) * powers
    stern = np.einsum("pw,dwk->pdk", energy, share)
    first = float(np.log(peaks[0]))
    return LogTable(first, np.ascontiguousarray(stern[:, -1])), LogTable(first, stern)
