"""Involuntary speed loss in wind and waves by Kwon (2008).

Source: Y. J. Kwon, "Speed loss due to added resistance in wind and waves", The Naval Architect,
March 2008, 14-16, after Townsin and Kwon (1983); coefficients as reprinted by Seuren (2020),
tables B.1 to B.3::

    loss = C_beta C_U C_form / 100        (fraction of the calm-water speed V)

Two points require a choice; both can be selected:

* **Sign of the last term of C_U for C_B 0.75 and 0.80.** Reprints print a minus. With it C_U
  turns negative at ordinary speeds (Fn > 0.17 for C_B 0.80): weather would push a full ship
  forward. With a plus the rows 0.75, 0.80 and 0.85 form one family (1.02, 0.98, 0.93 at
  Fn 0.15), and the row 0.85 has a plus in print. ``sign="plus"`` is the default,
  ``sign="printed"`` gives the minus. The 2008 paper itself was not available.
* **Classes.** Beaufort number and heading sector are classes in the tables. A staircase
  in either makes optimal routes jump, so by default the Beaufort number is continuous,
  B = (v / 0.836)^(2/3), and C_beta runs linearly between the middles of the sectors.
  ``classes=True`` gives the tables as printed.

C_beta falls again when the wind rises beyond B 4, 6 or 8, so far that a hurricane on the beam would
cause no loss; in the composed ship the loss therefore never falls while the wind rises
(``hold=True``).
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any, Final, Literal

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.errors import unknown_name_error
from thalweg.core.types import FloatArray
from thalweg.core.units import GRAVITY
from thalweg.ship.methods.validity import RangeNote, range_notes

LoadingCondition = Literal["loaded", "normal", "ballast"]
LastTermSign = Literal["plus", "printed"]
ShipType = Literal["other", "container"]

GREATEST_LOSS: Final = 0.99  #: cap of the loss, as in Seuren (2020)
SECTOR_MIDDLES: Final = np.radians(
    [15.0, 45.0, 105.0, 165.0]
)  #: middles of the heading sectors [rad]
_SECTOR_EDGES: Final = np.radians([30.0, 60.0, 150.0])
_BEAUFORT_LOWER_LIMITS: Final = (0.3, 1.6, 3.4, 5.5, 8.0, 10.8, 13.9, 17.2, 20.8, 24.5, 28.5, 32.7)
# C_beta = a - b (B - c)^2 for head, bow, beam and following weather
_TOP: Final = np.array([1.0, 0.85, 0.45, 0.20])
_BEND: Final = np.array([0.0, 0.015, 0.030, 0.015])
_VERTEX: Final = np.array([0.0, 4.0, 6.0, 8.0])
_BLOCK_COEFFICIENTS: Final = (0.55, 0.60, 0.65, 0.70, 0.75, 0.80, 0.85)
_LOADED: Final = (
    *((1.7, -1.4, -7.4), (2.2, -2.5, -9.7), (2.6, -3.7, -11.6), (3.1, -5.3, -12.4)),
    *((2.4, -10.6, 9.5), (2.6, -13.1, 15.1), (3.1, -18.7, 28.0)),
)
_BALLAST: Final = (*_LOADED[:4], (2.6, -12.5, 13.5), (3.0, -16.3, 21.6), (3.4, -20.9, 31.8))
LARGEST_FORM_COEFFICIENT: Final = 50.0  #: C_form [%] above which losses are no predictions
#: Froude number beyond which C_U is that at it: further on the parabolas of fine ships fall to
#: zero, as if weather cost a fast ship nothing. Displacement ships are slower.
GREATEST_FROUDE: Final = 0.3
_DISPUTED_ROWS: Final = (4, 5)  # rows whose last sign is in doubt


def beaufort_number(wind_speed: ArrayLike, *, classes: bool = False) -> FloatArray:
    r"""Beaufort number of a wind at 10 m [m/s].

    .. math:: B = (v / 0.836)^{2/3}, \quad v\ \text{in m/s}

    Parameters
    ----------
    wind_speed : [m/s], not negative.
    classes : Whole numbers by the usual class limits, instead of the continuous B = (v /
        0.836)^(2/3). Both end at 12.

    Returns
    -------
    ndarray : 0 to 12; NaN for NaN.

    References
    ----------
    World Meteorological Organization, v = 0.836 B^1.5.
    """
    wind = np.asarray(wind_speed, float)
    if classes:
        number = np.searchsorted(_BEAUFORT_LOWER_LIMITS, wind, side="right").astype(float)
        return np.where(np.isnan(wind), np.nan, number)
    return np.minimum((wind / 0.836) ** (2.0 / 3.0), 12.0)


def kwon_direction_coefficients(beaufort: ArrayLike) -> FloatArray:
    """C_beta of head, bow, beam and following weather, not below zero (table B.1).

    Parameters
    ----------
    beaufort : Beaufort number.

    Returns
    -------
    ndarray
        Shape ``(4, *beaufort.shape)``: angles off the bow of 0-30, 30-60, 60-150, 150-180 deg.
    """
    number = np.asarray(beaufort, float)
    column = (slice(None),) + (None,) * number.ndim
    return np.maximum(_TOP[column] - _BEND[column] * (number - _VERTEX[column]) ** 2, 0.0)


def kwon_speed_coefficient(
    froude: ArrayLike,
    *,
    block_coefficient: ArrayLike,
    loading: LoadingCondition = "loaded",
    sign: LastTermSign = "plus",
) -> FloatArray:
    """C_U, linear in the block coefficient between the rows of table B.2, not below zero.

    Parameters
    ----------
    froude : Froude number of the calm-water speed on the length between perpendiculars.
    block_coefficient : 0.55 to 0.85; beyond, the last row holds.
    loading : {"loaded", "normal", "ballast"}
        Below 0.75 ballast has no rows of its own; those of the normal condition hold.
    sign : {"plus", "printed"}
        Sign of the last term for C_B 0.75 and 0.80; see the module's text.
    """
    rows = np.array(_choose({"loaded": _LOADED, "normal": _LOADED, "ballast": _BALLAST}, loading))
    factor = _choose({"plus": 1.0, "printed": -1.0}, sign)
    rows[list(_DISPUTED_ROWS), 2] *= factor
    fn, block = np.asarray(froude, float), np.asarray(block_coefficient, float)
    c0, c1, c2 = (np.interp(block, _BLOCK_COEFFICIENTS, rows[:, k]) for k in range(3))
    return np.maximum(c0 + c1 * fn + c2 * fn**2, 0.0)


def kwon_form_coefficient(
    beaufort: ArrayLike,
    *,
    displacement_volume: ArrayLike,
    loading: LoadingCondition = "loaded",
    ship_type: ShipType = "other",
) -> FloatArray:
    r"""C_form of table B.3: c B + B^6.5 / (d V^(2/3)) [per cent].

    .. math:: C_{form} = c B + \frac{B^{6.5}}{d \nabla^{2/3}}

    Parameters
    ----------
    beaufort : Beaufort number.
    displacement_volume : Displaced volume V [m3]. The term was fitted to large ships: below 100,000
        m3 it grows out of bounds above Beaufort 6.
    loading : {"loaded", "normal", "ballast"}
        c = 0.5, in ballast 0.7.
    ship_type : {"other", "container"}
        d = 2.7; for container ships 22.0 with c = 0.5 (Townsin and Kwon 1983 have 0.7).

    References
    ----------
    Y.J. Kwon, "Speed loss due to added resistance in wind and waves", The Naval Architect
    (2008), as printed by Seuren (2020), Table B.3.
    """
    slope = _choose({"loaded": 0.5, "normal": 0.5, "ballast": 0.7}, loading)
    divisor = _choose({"other": 2.7, "container": 22.0}, ship_type)
    slope = 0.5 if ship_type == "container" else slope
    number = np.asarray(beaufort, float)
    volume = np.asarray(displacement_volume, float)
    return slope * number + number**6.5 / (divisor * volume ** (2.0 / 3.0))


def kwon_speed_loss(
    wind_speed: ArrayLike,
    wind_angle: ArrayLike,
    *,
    speed: ArrayLike,
    length: float,
    block_coefficient: ArrayLike,
    displacement_volume: ArrayLike,
    loading: LoadingCondition = "loaded",
    ship_type: ShipType = "other",
    sign: LastTermSign = "plus",
    classes: bool = False,
    hold: bool = True,
) -> FloatArray:
    r"""Share of the calm-water speed that wind and waves take, at constant power.

    .. math:: \frac{\Delta V}{V} = \frac{C_\beta C_U C_{form}}{100}

    Parameters
    ----------
    wind_speed : Wind at 10 m relative to the water [m/s].
    wind_angle : Angle off the bow it comes from, 0 to pi [rad].
    speed : Calm-water speed V [m/s]; beyond a Froude number of 0.3, C_U is that at 0.3.
    length : Between perpendiculars [m].
    block_coefficient, displacement_volume : C_B, and displaced volume [m3].
    loading, ship_type, sign
        See `kwon_speed_coefficient` and `kwon_form_coefficient`.
    classes : Whole Beaufort numbers and sectors as printed, instead of continuous ones.
    hold : Never let the loss fall while the wind rises.

    Returns
    -------
    ndarray
        0 to 0.99 (the cap holds in each sector, before the angles between are filled); NaN for NaN.

    References
    ----------
    Y.J. Kwon, "Speed loss due to added resistance in wind and waves", The Naval Architect
    (2008), as printed by Seuren (2020), Tables B.1 to B.3.
    """
    number = beaufort_number(wind_speed, classes=classes)
    volume = np.asarray(displacement_volume, float)
    options: dict[str, Any] = {"loading": loading, "ship_type": ship_type}
    axes = np.empty((1,) * max(np.ndim(speed), np.ndim(block_coefficient)))
    number, angle, volume, _ = np.broadcast_arrays(
        number, np.asarray(wind_angle, float), volume, axes
    )  # so that the axis of the sectors stays ahead of those of the speeds
    by_sector = np.empty((4, *number.shape))
    for sector in range(4):
        at = (
            np.minimum(number, _worst_beaufort_numbers(sector, volume, **options))
            if hold
            else number
        )
        direction = kwon_direction_coefficients(at)[sector]
        by_sector[sector] = direction * kwon_form_coefficient(
            at, displacement_volume=volume, **options
        )
    froude = np.minimum(np.asarray(speed, float) / np.sqrt(GRAVITY * length), GREATEST_FROUDE)
    steepness = kwon_speed_coefficient(
        froude, block_coefficient=block_coefficient, loading=loading, sign=sign
    )
    capped = np.minimum(by_sector * steepness / 100.0, GREATEST_LOSS)
    return _between_sectors(capped, angle, classes=classes)


def greatest_kwon_beaufort(displacement_volume: ArrayLike) -> FloatArray:
    """Return the highest Beaufort number that Kwon's method is made for.

    Parameters
    ----------
    displacement_volume : Displaced volume [m3].
    """
    return np.where(np.asarray(displacement_volume, float) < 1e5, 6.0, 8.0)


def kwon_notes(
    wind_speed: ArrayLike,
    *,
    block_coefficient: ArrayLike,
    displacement_volume: ArrayLike,
    froude: ArrayLike = 0.0,
    loading: LoadingCondition = "loaded",
    ship_type: ShipType = "other",
) -> list[RangeNote]:
    """Where Kwon's method is used outside its range; parameters as for `kwon_speed_loss`.

    The bound of Beaufort 6 is for displacements under 100,000 m3, that of 8 for larger ones. C_form
    was fitted to large ships: it passes `LARGEST_FORM_COEFFICIENT` at Beaufort 6 for 27,000 m3, and
    at Beaufort 5 for 4,500 m3.

    Parameters
    ----------
    wind_speed : Wind speed at 10 m [m/s].
    block_coefficient : C_B [-].
    displacement_volume : Displaced volume [m3].
    froude : Froude number of the calm-water speed [-].
    loading, ship_type
        See `kwon_form_coefficient`.

    Returns
    -------
    list of RangeNote : Empty inside the range.
    """
    highest = float(np.nanmin(greatest_kwon_beaufort(displacement_volume)))
    number = beaufort_number(wind_speed)
    form = kwon_form_coefficient(
        number, displacement_volume=displacement_volume, loading=loading, ship_type=ship_type
    )
    return range_notes(
        "kwon_2008",
        {
            "Beaufort number": (number, 0.0, highest),
            "C_form (loss from ahead in per cent)": (form, 0.0, LARGEST_FORM_COEFFICIENT),
            "Froude number": (froude, 0.0, GREATEST_FROUDE),
            "block coefficient": (
                block_coefficient,
                _BLOCK_COEFFICIENTS[0],
                _BLOCK_COEFFICIENTS[-1],
            ),
        },
    )


def _worst_beaufort_numbers(sector: int, volume: FloatArray, **options: Any) -> FloatArray:
    """Return the Beaufort number at which C_beta C_form of a sector is greatest."""
    if volume.size and volume.min() == volume.max():
        only = _worst_beaufort_number(sector, float(volume.flat[0]), **options)
        return np.broadcast_to(np.float64(only), volume.shape)
    volumes, which = np.unique(volume, return_inverse=True)
    peaks = np.array([_worst_beaufort_number(sector, float(one), **options) for one in volumes])
    return peaks[which].reshape(volume.shape)


@lru_cache(maxsize=4096)
def _worst_beaufort_number(
    sector: int, volume: float, *, loading: LoadingCondition, ship_type: ShipType
) -> float:
    """Return that number for one displaced volume [m3]."""
    if _BEND[sector] == 0.0:
        return 12.0

    def product(at: FloatArray) -> FloatArray:
        form = kwon_form_coefficient(
            at, displacement_volume=volume, loading=loading, ship_type=ship_type
        )
        return kwon_direction_coefficients(at)[sector] * form

    low = float(_VERTEX[sector])
    high = min(low + math.sqrt(_TOP[sector] / _BEND[sector]), 12.0)
    for _ in range(6):  # the product has a single top
        at = np.linspace(low, high, 65)
        top = int(np.argmax(product(at)))
        low, high = at[max(top - 1, 0)], at[min(top + 1, 64)]
    return float(0.5 * (low + high))


def _between_sectors(by_sector: FloatArray, angle: FloatArray, *, classes: bool) -> FloatArray:
    if classes:
        sector = np.searchsorted(_SECTOR_EDGES, angle, side="left")
        loss = np.take_along_axis(by_sector, np.minimum(sector, 3)[None], axis=0)[0]
        return np.where(np.isnan(angle), np.nan, loss)
    place = np.interp(angle, SECTOR_MIDDLES, np.arange(4.0))
    # only the index of an unknown angle is made up: its value stays NaN through ``place`` below
    cell = np.minimum(np.nan_to_num(place).astype(np.intp), 2)
    low = np.take_along_axis(by_sector, cell[None], axis=0)[0]
    high = np.take_along_axis(by_sector, cell[None] + 1, axis=0)[0]
    return low + (place - cell) * (high - low)


def _choose(options: dict[str, Any], name: str) -> Any:
    if name not in options:
        raise unknown_name_error("choice in Kwon's method", name, options)
    return options[name]


def prestegardshus_speed_factor(
    angle: ArrayLike, share: ArrayLike, *, consistent: bool = False
) -> FloatArray:
    r"""Return the factor on the speed by waves or by wind of Prestegardshus (2020).

    .. math:: r = 1 - 0.8 \, \frac{\theta/\pi + k}{2}

    For comparison with that thesis only. The rule is wrong: in a flat calm, where the direction
    of waves and wind has no meaning, it still takes up to 40 % of the speed for each of the two, so
    that a ship heading into no waves and no wind keeps 0.36 of its speed; and waves that follow
    cost as much as they would from ahead with half the height. ``consistent`` has
    :math:`r = 1 - 0.8\,k\,(1 + \theta/\pi)/2`, which takes nothing in a calm.

    Parameters
    ----------
    angle : array_like
        :math:`\theta` between the heading and where waves or wind go to [rad], 0 following to pi
        ahead.
    share : array_like
        k, wave height or wind speed over the largest of the data, 0 to 1.
    consistent : bool
        The variant.

    Returns
    -------
    ndarray
        Of the speed; NaN for a share above 1. The speed is the product of the factors of waves and
        wind with that in calm water.

    References
    ----------
    Prestegardshus (2020), eqs. 3.47 and 3.48. The variant is ours.
    """
    turn, k = np.asarray(angle, float) / np.pi, np.asarray(share, float)
    lost = 0.5 * k * (1.0 + turn) if consistent else 0.5 * (turn + k)
    return np.where(k <= 1.0 + 1e-9, 1.0 - 0.8 * lost, np.nan)
