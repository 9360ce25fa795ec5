"""Limits of a ship in waves: the situations of MSC.1/Circ.1228, and limits of motions."""

import math

from thalweg.kernels.compilation.decorators import inlined

# entries of the numbers of a ship (`thalweg.ship.seaway_limits.SafetyLimits.kernel_arrays`)
SURF_RIDING_SPEED = 0  # 1.8 sqrt(L) in m/s; inf when surf-riding is not checked
HIGH_WAVE_LENGTH = 1  # length of the ship for successive high waves [m]; 0 when not checked
ROLL_PERIOD = 2  # [s]; 0 when roll is not checked
CHECK_HALF_ROLL_PERIOD = 3  # 1 when half of the roll period counts as well
ROLL_TOLERANCE = 4
MIN_WAVE_HEIGHT = 5  # waves up to this are not dangerous [m]
MEAN_TO_PEAK_PERIOD = 6  # mean over peak period
SAFETY_NUMBER_COUNT = 7
_KNOT = 1852.0 / 3600.0
_COS_45_DEGREES = math.cos(math.radians(45.0))


@inlined
def _resonant(table, encounter):
    """Return whether an encounter period is near the roll period, or half of it."""
    period, tolerance = table.safety[ROLL_PERIOD], table.safety[ROLL_TOLERANCE]
    if period <= 0.0:
        return False
    if abs(encounter / period - 1.0) < tolerance:
        return True
    return (
        table.safety[CHECK_HALF_ROLL_PERIOD] > 0.0
        and abs(2.0 * encounter / period - 1.0) < tolerance
    )


@inlined
def _dangerous(table, speed, angle, height, peak_period):
    """Return whether MSC.1/Circ.1228 warns of something (see `stability_checks`)."""
    numbers = table.safety
    if not height > numbers[MIN_WAVE_HEIGHT]:
        return False
    cosine = math.cos(angle)
    if -cosine > _COS_45_DEGREES and speed * -cosine > numbers[SURF_RIDING_SPEED]:
        return True
    period = numbers[MEAN_TO_PEAK_PERIOD] * peak_period
    met = abs(3.0 * period + speed / _KNOT * cosine)
    if met == 0.0 or period <= 0.0:
        return False
    encounter = 3.0 * period * period / met
    if _resonant(table, encounter):
        return True
    length = numbers[HIGH_WAVE_LENGTH]
    if length <= 0.0 or height <= 0.04 * length or 1.56 * period * period <= 0.8 * length:
        return False
    ratio = encounter / period
    return ratio > 1.8 and ratio < 3.0


@inlined
def _uncomfortable(table, speed, angle, height, period):
    """Return whether motions exceed their limit: height times the table is more than 1."""
    values, grid = table.motions, table.motion_grid
    x = min(max((speed - grid[0, 0]) * grid[0, 1], 0.0), values.shape[0] - 1.0)
    y = min(max((angle - grid[1, 0]) * grid[1, 1], 0.0), values.shape[1] - 1.0)
    z = min(max((period - grid[2, 0]) * grid[2, 1], 0.0), values.shape[2] - 1.0)
    i = min(int(x), values.shape[0] - 2)
    j = min(int(y), values.shape[1] - 2)
    k = min(int(z), values.shape[2] - 2)
    total = 0.0
    for corner in range(8):
        a, b, c = corner & 1, corner >> 1 & 1, corner >> 2
        weight = (x - i if a else 1.0 - x + i) * (y - j if b else 1.0 - y + j)
        weight *= z - k if c else 1.0 - z + k
        total += weight * values[i + a, j + b, k + c]
    return height * total > 1.0


@inlined
def exceeds_wave_limits(table, speed, angle, height, peak_period):
    """Return whether a ship must not sail so.

    Parameters
    ----------
    table : TableArrays
        With at least one of ``safety`` and ``motions`` not empty.
    speed : float
        Through the water [m/s].
    angle : float
        Between the bow and where the waves come from [rad].
    height, peak_period : float
        Significant wave height [m] and peak period [s].
    """
    if not height > 0.0:
        return False
    if table.safety.shape[0] > 0 and _dangerous(table, speed, angle, height, peak_period):
        return True
    if table.motions.shape[0] == 0:
        return False
    return _uncomfortable(table, speed, angle, height, peak_period)
