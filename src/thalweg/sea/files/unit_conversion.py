"""Convert the units of files to SI."""

from __future__ import annotations

import re
from typing import Any, Final

import numpy as np

from thalweg.core.units import KNOT

#: factor to SI by dimension and unit; units as `normalised_unit` returns them
_SI_FACTORS: Final[dict[str, dict[str, float]]] = {
    "speed": {
        "m/s": 1.0, "ms-1": 1.0, "cm/s": 0.01, "cms-1": 0.01, "mm/s": 0.001, "mms-1": 0.001,
        "km/h": 1.0 / 3.6, "kmh-1": 1.0 / 3.6, "km/hr": 1.0 / 3.6, "kph": 1.0 / 3.6,
        "kmh": 1.0 / 3.6, "kn": KNOT, "kt": KNOT, "kts": KNOT, "knot": KNOT, "knots": KNOT,
        "nm/h": KNOT, "mph": 0.44704, "mi/h": 0.44704, "ft/s": 0.3048,
    },
    "length": {
        "m": 1.0, "cm": 0.01, "mm": 0.001, "dm": 0.1, "km": 1000.0,
        "ft": 0.3048, "feet": 0.3048, "foot": 0.3048, "fathom": 1.8288, "fathoms": 1.8288,
        "mmsl": 1.0, "gpm": 1.0,
    },
    "time": {"s": 1.0, "min": 60.0, "minutes": 60.0, "h": 3600.0, "hour": 3600.0, "hours": 3600.0},
    "pressure": {
        "pa": 1.0, "hpa": 100.0, "mb": 100.0, "mbar": 100.0, "millibar": 100.0,
        "millibars": 100.0, "kpa": 1000.0, "dbar": 1e4, "bar": 1e5,
    },
    "fraction": {"1": 1.0, "fraction": 1.0, "-": 1.0, "(0-1)": 1.0, "%": 0.01, "percent": 0.01},
    "direction": {
        "degree": 1.0, "degrees": 1.0, "deg": 1.0, "°": 1.0, "rad": 57.29577951308232,
        "radian": 57.29577951308232, "radians": 57.29577951308232,
    },
}  # fmt: skip
UNSPECIFIED_UNITS: Final = frozenset({"", "~", "unknown", "none", "nan", "n/a", "nondim"})
_WORD_PATTERNS: Final = (
    (r"met(re|er)s?", "m"),
    (r"centim", "cm"),
    (r"kilom", "km"),
    (r"seconds?|\bsec\b", "s"),
    (r"hours?\b", "h"),
    (r"\s*per\s*", "/"),
    (r"nautical\s*miles?", "nm"),
    (r"pascals?", "pa"),
)
_TRUE_NORTH_SUFFIX: Final = re.compile(r"(_|\s)*(true|t|clockwise.*|from.*|north|\(.*\))$")


def normalised_unit(text: str) -> str:
    """Return a unit in lower case, without spaces, power signs and long words.

    Examples
    --------
    >>> normalised_unit("metres per second")
    'm/s'
    """
    unit = text.strip().lower()
    for word, short in _WORD_PATTERNS:
        unit = re.sub(word, short, unit)
    return re.sub(r"\*\*|\^|[\s.*]", "", unit)


def si_factor(text: str, dimension: str) -> float | None:
    """Return the factor that converts values in a unit to SI (degrees for directions).

    Parameters
    ----------
    text : The unit as spelled in the file.
    dimension : "speed", "length", "time", "pressure", "fraction" or "direction".

    Returns
    -------
    float or None : None if the unit does not fit the dimension.

    Examples
    --------
    >>> si_factor("m s**-1", "speed"), si_factor("cm s-1", "speed"), si_factor("K", "speed")
    (1.0, 0.01, None)
    >>> si_factor("Degree true", "direction")
    1.0
    """
    table = _SI_FACTORS[dimension]
    if dimension == "direction":
        text = _TRUE_NORTH_SUFFIX.sub("", text.strip().lower())
    return table.get(normalised_unit(text))


def valid_limits(array: Any) -> tuple[float, float] | None:
    """Return the least and greatest valid value that a variable states, in its unpacked unit.

    ``valid_range``, ``valid_min`` and ``valid_max`` of packed variables are packed values where
    they have the packed type (CF conventions, section 2.5.1).

    Parameters
    ----------
    array : A variable, decoded.

    Returns
    -------
    (float, float) or None : Infinite where one side is not limited; None without limits, or where
        they contradict each other.
    """
    attributes = array.attrs
    both = attributes.get("valid_range", (None, None))
    sides = [attributes.get("valid_min", None), attributes.get("valid_max", None)]
    limits = [-np.inf, np.inf]
    for k, given in enumerate(s if s is not None else r for s, r in zip(sides, both)):
        number = np.asarray(given) if given is not None else None
        if number is None or number.size != 1 or number.dtype.kind not in "fiu":
            continue
        value = float(number.ravel()[0])
        packed = array.encoding.get("dtype")
        if packed is not None and np.dtype(packed).kind in "iu" and number.dtype.kind in "iu":
            value *= float(np.asarray(array.encoding.get("scale_factor", 1.0)).ravel()[0])
            value += float(np.asarray(array.encoding.get("add_offset", 0.0)).ravel()[0])
        limits[k] = value
    low, high = limits
    if not low < high or (np.isinf(low) and np.isinf(high)):
        return None
    slack = 1e-6 * max(abs(v) for v in (low, high) if np.isfinite(v))
    return low - slack, high + slack


def is_unspecified(text: str) -> bool:
    """Return whether a text states no unit."""
    return text.strip().lower() in UNSPECIFIED_UNITS
