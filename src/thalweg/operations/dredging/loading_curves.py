"""Loading and unloading times of a hopper: constant rates and loading curves."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from thalweg.core.errors import InputError, unknown_name_error
from thalweg.core.given_numbers import is_number
from thalweg.core.units import DAY, HOUR
from thalweg.operations.dredging.project_validation import positive_number

_KEYS = ("rate_m3_s", "rate_m3_h", "minutes", "share", "power_kw", "fixed_minutes")
_RATES = {"rate_m3_s": 1.0, "rate_m3_h": HOUR}  # units of a rate in m3/s
_QUICKEST = 60.0  # [s] for a full hopper
_SLOWEST = 7.0 * DAY  # [s] for a full hopper, and for the fixed time
_STRONGEST = 1e8  # [W] of pumps and winches


@dataclass(frozen=True)
class LoadingCurve:
    """Loading or unloading: share of the hopper against time.

    Attributes
    ----------
    seconds : tuple of float
        From 0, ascending [s].
    share : tuple of float
        Share of the hopper loaded (or unloaded) by then, from 0 to 1, ascending; linear between.
    power : float
        Power of pumps and winches during the work [W].
    fixed : float
        Additional time that does not depend on the load: coupling, turning [s].

    Notes
    -----
    A curve with a decreasing slope describes loading with overflow: water and fines leave over the
    weir, so that the last tenth of a load takes longer than the first.
    """

    seconds: tuple[float, ...]
    share: tuple[float, ...]
    power: float = 0.0
    fixed: float = 0.0

    @classmethod
    def constant(
        cls, rate: float, hopper: float, *, power: float = 0.0, fixed: float = 0.0
    ) -> LoadingCurve:
        """Return the curve of a constant rate.

        Parameters
        ----------
        rate : float
            Rate [m3/s], above 0.
        hopper : float
            Volume of the hopper [m3].
        power : float, optional
            Power of the equipment meanwhile [W].
        fixed : float, optional
            Time that each load takes in addition [s].

        Returns
        -------
        LoadingCurve
            From 0 to the full hopper in ``hopper / rate`` seconds.

        Raises
        ------
        InputError
            If the rate is not a positive number.
        """
        rate = positive_number({"rate_m3_s": rate}, "rate_m3_s")
        return cls((0.0, hopper / rate), (0.0, 1.0), power, fixed)

    @classmethod
    def from_data(cls, data: Any, hopper: float, what: str) -> LoadingCurve:
        """Return the curve of a rate [m3/s], or of a mapping with a rate or a curve, and powers.

        Parameters
        ----------
        data : float or mapping
            ``rate_m3_s`` or ``rate_m3_h``, or ``minutes`` with ``share``;
            ``power_kw`` and ``fixed_minutes``.
        hopper : float [m3]
        what : str
            "loading" or "unloading", for errors.

        Returns
        -------
        LoadingCurve
            In seconds and shares of the hopper.

        Raises
        ------
        InputError
            For rates that are not positive, curves that do not increase from 0 to 1, unknown keys,
            and full hoppers in less than a minute or more than a week.
        """
        given = data if isinstance(data, Mapping) else {"rate_m3_s": data}
        for key in given:
            if key not in _KEYS:
                raise unknown_name_error(f"entry of {what}", str(key), _KEYS)
        more = {
            "power": 1000.0 * _non_negative(f"{what}.power_kw", given.get("power_kw", 0.0)),
            "fixed": 60.0 * _non_negative(f"{what}.fixed_minutes", given.get("fixed_minutes", 0.0)),
        }
        rates = [key for key in _RATES if key in given]
        if len(rates) == 1 and "minutes" not in given:
            name = f"{what}.{rates[0]}"
            rate = positive_number({name: given[rates[0]]}, name) / _RATES[rates[0]]
            curve = cls.constant(rate, hopper, **more)
        else:
            minutes, share = given.get("minutes"), given.get("share")
            _check_curve(what, minutes, share, bool(rates))
            seconds = tuple(60.0 * float(m) for m in minutes)  # type: ignore[union-attr]
            curve = cls(seconds, tuple(float(s) for s in share), **more)  # type: ignore[union-attr]
        _check_plausible(curve, what, f"{what}.{rates[0] if rates else 'minutes'}")
        return curve

    def time(self, share: float) -> float:
        """Return the time for a share of the hopper.

        Parameters
        ----------
        share : float
            0 (empty) to 1 (full).

        Returns
        -------
        float
            Time [s] with the fixed part; 0 for an empty hopper.
        """
        if share <= 0.0:
            return 0.0
        return self.fixed + float(np.interp(share, self.share, self.seconds))

    def to_data(self) -> dict[str, Any]:
        """Return plain data, as `from_data` reads it.

        Returns
        -------
        dict
            ``minutes`` and ``share``; ``power_kw`` and ``fixed_minutes`` where they are
            not zero.
        """
        data: dict[str, Any] = {
            "minutes": [s / 60.0 for s in self.seconds],
            "share": list(self.share),
        }
        if self.power:
            data["power_kw"] = self.power / 1000.0
        if self.fixed:
            data["fixed_minutes"] = self.fixed / 60.0
        return data


def _check_plausible(curve: LoadingCurve, what: str, name: str) -> None:
    """Raise `InputError` for durations and a power that only another unit explains."""
    full = curve.seconds[-1]
    if not _QUICKEST <= full <= _SLOWEST:
        raise InputError(
            f"With this {name} {what} a full hopper takes {full:.3g} s ({full / HOUR:.3g} h).",
            "It takes from one minute to a week. A rate without a name is in m3/s.",
            f"Check the unit: {what}: {{rate_m3_h: 7650}} in m3 per hour, or rate_m3_s in m3 per "
            "second; the times of a curve are minutes.",
            field=name,
        )
    if curve.fixed > _SLOWEST:
        raise InputError(
            f"{what}.fixed_minutes is {curve.fixed / 60.0:g}, {curve.fixed / DAY:.1f} days.",
            "It is at most a week.",
            "Check the unit: it is in minutes.",
            field=f"{what}.fixed_minutes",
        )
    if curve.power > _STRONGEST:
        raise InputError(
            f"{what}.power_kw is {curve.power / 1000.0:g}.",
            f"It is at most {_STRONGEST / 1000.0:g} kW.",
            "Check the unit: it is in kW.",
            field=f"{what}.power_kw",
        )


def _non_negative(name: str, value: Any) -> float:
    if not is_number(value) or value < 0.0:
        raise InputError(f"{name} is {value!r}.", "It is zero or more.", "Correct it.", field=name)
    return float(value)


def _check_curve(what: str, minutes: Any, share: Any, rate_too: bool) -> None:
    """Raise `InputError` unless two lists make a curve from an empty to a full hopper."""
    if rate_too:
        raise InputError(
            f"The {what} has more than one rate, or a rate and a curve.",
            "It has one of them.",
            "Keep one rate, or minutes and share.",
        )
    lists = all(isinstance(x, Sequence) and not isinstance(x, str) for x in (minutes, share))
    sound = lists and len(minutes) == len(share) >= 2
    if sound:
        try:
            t, s = np.array(minutes, float), np.array(share, float)
        except (TypeError, ValueError):
            sound = False
        else:
            rising = np.all(np.diff(t) > 0.0) and np.all(np.diff(s) > 0.0)
            sound = bool(rising and t[0] == 0.0 and s[0] == 0.0 and s[-1] == 1.0)
    if not sound:
        raise InputError(
            f"The curve of {what} cannot be used: minutes {minutes!r}, share {share!r}.",
            "They are two increasing lists of equal length, from 0 minutes and share 0 to share 1.",
            "Write, for example, minutes: [0, 30, 60] and share: [0, 0.7, 1].",
            field=what,
        )
