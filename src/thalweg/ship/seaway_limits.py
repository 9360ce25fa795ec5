"""Limits of safety and comfort in waves, for models and kernels."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.core.errors import InputError, unknown_name_error
from thalweg.core.types import FloatArray
from thalweg.core.units import HOUR
from thalweg.kernels.leg import wave_limits as places
from thalweg.ship.hull.hull import Hull, required_particulars
from thalweg.ship.hull.hull_checks import check_aboard
from thalweg.ship.loading_state import Loading
from thalweg.ship.methods.seakeeping.motion_sickness import (
    MIXED_ADULT_SUSCEPTIBILITY,
    wf_weighting,
)
from thalweg.ship.methods.seakeeping.ship_motions import (
    MotionHull,
    encounter_ratio,
    jensen_motions,
    vertical_motion,
)
from thalweg.ship.methods.seakeeping.stability_msc1_circ1228 import (
    DangerousSituations,
    dangerous_situations,
    roll_period,
    surf_riding_speed,
)
from thalweg.ship.methods.seakeeping.wave_spectra import jonswap, quadrature
from thalweg.ship.schema.ship_schema import LimitsSection

#: the situations of MSC.1/Circ.1228 that a ship file may name
DANGEROUS_SITUATIONS: Final = (
    "surf_riding",
    "successive_high_waves",
    "synchronous_roll",
    "parametric_roll",
)
#: mean over peak period of a JONSWAP spectrum with gamma 3.3 (DNV-RP-C205)
MEAN_TO_PEAK_PERIOD_RATIO: Final = 0.834
EXPOSURE_TIME: Final = 7200.0  #: of people on board, unless the ship file gives it [s]
SHORTEST_PERIOD, LONGEST_PERIOD = 2.0, 30.0  #: peak periods are taken as no shorter or longer [s]
_GRID_SHAPE: Final = (25, 37, 113)  # speeds, angles, periods
_ITERATIONS: Final = 6
_INITIAL_WAVE_HEIGHT: Final = 3.0  # from which heights that reach a limit are sought [m]
_BLOCK_SIZE: Final = 20_000


@dataclass(frozen=True)
class DangerousSituationLimits:
    """The dangerous situations of MSC.1/Circ.1228 that a ship must avoid.

    Attributes
    ----------
    dangers : Among `DANGEROUS_SITUATIONS`.
    roll_period : Natural roll period [s]; NaN when unknown.
    roll_tolerance : Relative difference of periods that counts as resonance.
    harmless_wave_height : Waves up to this height are not dangerous [m].
    """

    dangers: tuple[str, ...]
    roll_period: float
    roll_tolerance: float
    harmless_wave_height: float

    def in_waves(
        self,
        speed: FloatArray,
        angle: FloatArray,
        height: FloatArray,
        period: FloatArray,
        length: float,
    ) -> DangerousSituations:
        """Return the situations of a ship of a length [m] in waves of a peak period [s]."""
        return dangerous_situations(
            speed=speed,
            wave_angle=angle,
            wave_height=height,
            wave_period=MEAN_TO_PEAK_PERIOD_RATIO * period,
            length=length,
            roll_period=None if math.isnan(self.roll_period) else self.roll_period,
            roll_tolerance=self.roll_tolerance,
            harmless_wave_height=self.harmless_wave_height,
        )


@dataclass(frozen=True)
class AccelerationLimit:
    """A greatest vertical acceleration at a place of the ship.

    Attributes
    ----------
    greatest : Root mean square [m/s2].
    forward : Ahead of midship on the centre line [m].
    weighted : Weighted for motion sickness (W_f of ISO 2631-1).
    exposure : Time on board for which it is a limit of sickness [s].
    """

    greatest: float
    forward: float
    weighted: bool = False
    exposure: float = EXPOSURE_TIME

    def ratio_to_limit(
        self,
        hull: MotionHull,
        *,
        speed: FloatArray,
        angle: FloatArray,
        height: FloatArray,
        period: FloatArray,
    ) -> FloatArray:
        """Return the acceleration over its limit, for flat arrays."""
        found = np.empty(height.shape)
        for first in range(0, height.size, _BLOCK_SIZE):
            part = slice(first, first + _BLOCK_SIZE)
            peak_period = np.clip(period[part], SHORTEST_PERIOD, LONGEST_PERIOD)
            response = self.squared_response(
                hull, speed=speed[part], angle=angle[part], period=peak_period
            )
            found[part] = self.ratio_in_sea(response, height=height[part], period=peak_period)
        return found

    def squared_response(
        self, hull: MotionHull, *, speed: FloatArray, angle: FloatArray, period: FloatArray
    ) -> FloatArray:
        """Return the squared acceleration per wave amplitude at the nodes of `quadrature`."""
        w, _ = quadrature(period)
        heave, pitch = jensen_motions(w, speed=speed, wave_angle=angle, hull=hull, decay="strip")
        meeting = np.abs(w * encounter_ratio(w, speed=speed, wave_angle=angle))
        amplitude = meeting**2 * vertical_motion(heave, pitch, forward=self.forward)
        if self.weighted:
            amplitude *= wf_weighting(meeting / (2.0 * np.pi))
        squared: FloatArray = amplitude**2
        return squared

    def ratio_in_sea(
        self, squared_response: FloatArray, *, height: FloatArray, period: FloatArray
    ) -> FloatArray:
        """Return the root mean square of this response in JONSWAP seas over the limit."""
        w, weights = quadrature(period)
        waves = jonswap(w, height=height, period=period)
        rms: FloatArray = np.sqrt(np.einsum("ij,ij,ij->i", squared_response, waves, weights))
        return rms / self.greatest


@dataclass(frozen=True)
class SafetyLimits:
    """Limits of a ship in waves.

    Attributes
    ----------
    hull : At the loading of the ship file.
    top_speed : Speeds beyond are taken as this in the tables of motions [m/s].
    """

    hull: MotionHull
    situation_limits: DangerousSituationLimits | None = None
    motions: tuple[AccelerationLimit, ...] = ()
    top_speed: float = 20.0

    def forbids(
        self,
        speed: ArrayLike,
        *,
        wave_angle: ArrayLike,
        wave_height: ArrayLike,
        wave_period: ArrayLike,
    ) -> NDArray[np.bool_]:
        """Return where these speeds and angles break a limit.

        Parameters
        ----------
        speed : Through the water [m/s].
        wave_angle : Between the bow and where the waves come from [rad], 0 head to pi following.
        wave_height, wave_period : Significant height [m] and peak period [s].

        Returns
        -------
        ndarray of bool : False where something is unknown.
        """
        arrays = (np.asarray(x, float) for x in (speed, wave_angle, wave_height, wave_period))
        v, angle, height, period = np.broadcast_arrays(*arrays)
        known = np.isfinite(v + height) & ((height == 0.0) | np.isfinite(angle + period))
        bad = np.zeros(v.shape, bool)
        rough = known & (height > 0.0)
        at = [np.ascontiguousarray(x[rough]) for x in (v, angle, height, period)]
        if at[0].size:
            bad[rough] = self._dangerous(*at) | (self._share(*at) > 1.0)
        return bad

    def _dangerous(
        self, speed: FloatArray, angle: FloatArray, height: FloatArray, period: FloatArray
    ) -> NDArray[np.bool_]:
        bad = np.zeros(speed.shape, bool)
        if self.situation_limits is None:
            return bad
        checks = self.situation_limits.in_waves(speed, angle, height, period, self.hull.length)
        for name in self.situation_limits.dangers:
            bad |= getattr(checks, name)
        return bad

    def _share(
        self, speed: FloatArray, angle: FloatArray, height: FloatArray, period: FloatArray
    ) -> FloatArray:
        """The greatest acceleration over its limit, flat arrays."""
        at = {"speed": speed, "angle": angle, "height": height, "period": period}
        shares = [limit.ratio_to_limit(self.hull, **at) for limit in self.motions]
        return np.max(shares, axis=0) if shares else np.zeros(speed.shape)

    def kernel_arrays(self, margin: float = 0.0) -> dict[str, Any]:
        """Return the fields of `thalweg.kernels.leg.table_lookup.TableArrays` that belong to it.

        Parameters
        ----------
        margin : Share by which the limits of motions are stricter.
        """
        found: dict[str, Any] = {}
        if self.situation_limits is not None:
            found["safety"] = self._numbers
        if self.motions:
            per_metre, found["motion_grid"] = self._table
            found["motions"] = per_metre / np.float32(1.0 - margin)
        return found

    @cached_property
    def _numbers(self) -> FloatArray:
        """The numbers of `thalweg.kernels.leg.wave_limits`."""
        own = self.situation_limits
        numbers = np.zeros(places.SAFETY_NUMBER_COUNT)
        if own is None:
            return numbers
        rolls = {"synchronous_roll", "parametric_roll"} & set(own.dangers)
        astern = float(surf_riding_speed(math.pi, length=self.hull.length))
        numbers[places.SURF_RIDING_SPEED] = astern if "surf_riding" in own.dangers else math.inf
        if "successive_high_waves" in own.dangers:
            numbers[places.HIGH_WAVE_LENGTH] = self.hull.length
        numbers[places.ROLL_PERIOD] = own.roll_period if rolls else 0.0
        numbers[places.CHECK_HALF_ROLL_PERIOD] = float("parametric_roll" in own.dangers)
        numbers[places.ROLL_TOLERANCE] = own.roll_tolerance
        numbers[places.MIN_WAVE_HEIGHT] = own.harmless_wave_height
        numbers[places.MEAN_TO_PEAK_PERIOD] = MEAN_TO_PEAK_PERIOD_RATIO
        return numbers

    @cached_property
    def _table(self) -> tuple[NDArray[np.float32], FloatArray]:
        """One over the wave height that reaches a limit, over speed, angle and period."""
        ends = ((0.0, self.top_speed), (0.0, math.pi), (SHORTEST_PERIOD, LONGEST_PERIOD))
        axes = [np.linspace(*end, size) for end, size in zip(ends, _GRID_SHAPE)]
        v, angle, period = (x.ravel() for x in np.meshgrid(*axes, indexing="ij"))
        height = np.empty(v.shape)
        for first in range(0, height.size, _BLOCK_SIZE):
            part = slice(first, first + _BLOCK_SIZE)
            height[part] = self._heights_at_limit(v[part], angle[part], period[part])
        inverse = np.where(height < 60.0, 1.0 / height, 0.0)
        grid = np.array([[axis[0], 1.0 / (axis[1] - axis[0])] for axis in axes])
        return inverse.reshape(_GRID_SHAPE).astype(np.float32), grid

    def _heights_at_limit(
        self, speed: FloatArray, angle: FloatArray, period: FloatArray
    ) -> FloatArray:
        """The significant height [m] that reaches the first limit, 0.05 to 60 m."""
        responses = [
            limit.squared_response(self.hull, speed=speed, angle=angle, period=period)
            for limit in self.motions
        ]
        height = np.full(speed.shape, _INITIAL_WAVE_HEIGHT)
        for _ in range(_ITERATIONS):  # the spectrum's peak depends a little on the height
            ratios = [
                limit.ratio_in_sea(response, height=height, period=period)
                for limit, response in zip(self.motions, responses)
            ]
            height = np.clip(height / np.maximum(np.max(ratios, axis=0), 1e-6), 0.05, 60.0)
        return height


def build_safety_limits(given: LimitsSection, hull: Hull, loading: Loading) -> SafetyLimits | None:
    """Return the safety and comfort limits of a ship file; None when it states none.

    Returns
    -------
    SafetyLimits or None : Limits in waves.

    Raises
    ------
    InputError : For unknown dangers, and particulars that are missing.
    """
    dangers = tuple(dict.fromkeys(given.msc_circ_1228))
    limits = _acceleration_limits(given)
    if not dangers and not limits:
        return None
    size = make_motion_hull(hull, loading)
    middle = [
        AccelerationLimit(limit.greatest, 0.5 * size.length * math.copysign(1, limit.forward))
        if math.isinf(limit.forward)
        else limit
        for limit in limits
    ]
    for limit in middle:
        remedy = "Correct limits.acceleration_at_m or limits.motion_sickness_at_m."
        key = "limits.acceleration_at_m"
        check_aboard("A limit is set", limit.forward, size.length, remedy=remedy, key=key)
    situation_limits = _dangerous_situation_limits(given, dangers, hull, size) if dangers else None
    return SafetyLimits(size, situation_limits, tuple(middle))


def _dangerous_situation_limits(
    given: LimitsSection, dangers: tuple[str, ...], hull: Hull, size: MotionHull
) -> DangerousSituationLimits:
    """The dangers of MSC.1/Circ.1228 named in a ship file."""
    if "all" in dangers:
        dangers = DANGEROUS_SITUATIONS
    for name in dangers:
        if name not in DANGEROUS_SITUATIONS:
            raise unknown_name_error(
                "danger of MSC.1/Circ.1228", name, ("all", *DANGEROUS_SITUATIONS)
            )
    rolls = natural_roll_period(hull, size)
    if rolls is None and {"synchronous_roll", "parametric_roll"} & set(dangers):
        raise InputError(
            "The ship file limits roll, but gives no natural roll period.",
            "It is hull.roll_period_s, or follows from hull.metacentric_height_m.",
            "Add one of them, or name the other dangers only.",
            missing=["hull.roll_period_s", "hull.metacentric_height_m"],
        )
    harmless = given.danger_from_wave_height_m
    return DangerousSituationLimits(
        dangers=dangers,
        roll_period=math.nan if rolls is None else rolls,
        roll_tolerance=given.roll_period_tolerance,
        harmless_wave_height=0.01 * size.length if harmless is None else harmless,
    )


def natural_roll_period(hull: Hull, size: MotionHull) -> float | None:
    """Return the natural roll period [s], given or by the IS Code from GM; None when unknown.

    Parameters
    ----------
    hull : With the roll period or GM, if known.
    size : Dimensions of the hull [m].
    """
    own, gm = hull.number("roll_period_s"), hull.number("metacentric_height_m")
    if own is not None or gm is None:
        return own
    beam, deep = size.breadth, size.draught
    return float(roll_period(beam, deep, length_waterline=size.length, metacentric_height=gm))


def _acceleration_limits(given: LimitsSection) -> tuple[AccelerationLimit, ...]:
    """The limits of motions in a ship file; an infinite position means the bow."""
    found = []
    if given.max_vertical_acceleration_m_s2 is not None:
        place = math.inf if given.acceleration_at_m is None else given.acceleration_at_m
        found.append(AccelerationLimit(given.max_vertical_acceleration_m_s2, place))
    if given.max_motion_sickness_percent is not None:
        dose = given.max_motion_sickness_percent / MIXED_ADULT_SUSCEPTIBILITY
        greatest = dose / math.sqrt(given.motion_sickness_hours * HOUR)
        place, time = given.motion_sickness_at_m, given.motion_sickness_hours * HOUR
        found.append(AccelerationLimit(greatest, place, weighted=True, exposure=time))
    return tuple(found)


def make_motion_hull(hull: Hull, loading: Loading) -> MotionHull:
    """Return a hull as the closed forms of its motions need it, at a loading.

    Parameters
    ----------
    hull : Particulars; a breadth or block coefficient that is missing is estimated.
    loading : Gives the draught.

    Raises
    ------
    InputError : If the particulars do not suffice.
    """
    wanted: tuple[str, ...] = ("breadth_m", "block_coefficient")
    length = hull.number("length_waterline_m") or hull.number("length_between_perpendiculars_m")
    if length is None:
        wanted = ("length_between_perpendiculars_m", *wanted)
    if any(hull.number(key) is None for key in wanted):
        from thalweg.ship.hull.hull_estimates import estimate_particulars  # reads many regressions

        hull = estimate_particulars(hull, wanted)
    numbers = required_particulars(
        hull, wanted, "a limit of motions in waves", instead="no such limit"
    )
    length = numbers[0] if length is None else length
    return MotionHull(float(length), float(numbers[-2]), loading.draught, float(numbers[-1]))
