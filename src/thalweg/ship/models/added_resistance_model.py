"""Added resistance of waves and wind of a composed ship, by the name of the method."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Any, Final

import numpy as np

from thalweg.core.errors import unknown_name_error
from thalweg.core.types import FloatArray
from thalweg.ship.hull.estimate import Estimate
from thalweg.ship.hull.hull import Hull, required_particulars
from thalweg.ship.hull.hull_estimates import estimate_or_raise
from thalweg.ship.methods.added_resistance.snnm import (
    snnm_validity,
)
from thalweg.ship.methods.added_resistance.snnm_hull import (
    SnnmHull,
)
from thalweg.ship.methods.added_resistance.snnm_table import SnnmTable
from thalweg.ship.methods.added_resistance.stawave import (
    HEAD_SECTOR,
    head_sector_validity,
    stawave1,
    stawave1_validity,
    stawave2,
    stawave2_validity,
)
from thalweg.ship.methods.added_resistance.wind_resistance import (
    BLENDERMANN,
    ITTC_CURVES,
    FujiwaraShip,
    blendermann_1994,
    fujiwara_2006,
    ittc_curve,
    wind_resistance,
    yu_2021_area,
    yu_2021_coefficient,
)
from thalweg.ship.methods.relative_angles import relative_wind
from thalweg.ship.methods.resistance.holtrop_form import length_of_run
from thalweg.ship.methods.validity import RangeNote
from thalweg.ship.models.calm_water_model import FORM_KEYS, hull_form_of
from thalweg.ship.schema.ship_schema import ModelsSection

#: Methods that count waves from ahead alone, and the half width of their sector [rad].
HEAD_SEA_METHODS: Final = MappingProxyType({"stawave_1": HEAD_SECTOR, "stawave_2": HEAD_SECTOR})
#: entrance to 0.99 B as a share of (1 - C_P) L_WL: 0.17 L for a tanker, 0.36 L for a slender ship
_ENTRANCE_FRACTION: Final = 0.85
_PITCH_GYRATION: Final = Estimate("pitch_gyration", 0.25, "usual value, ITTC")
SHORTEST_PERIOD, LONGEST_PERIOD = 2.0, 30.0  #: peak periods are taken as no shorter or longer [s]


@dataclass(frozen=True, eq=False)
class AddedWaveResistance:
    """Added resistance in waves for one hull.

    Attributes
    ----------
    force : [N] from speed [m/s], significant height [m], peak period [s], angle off the bow [rad].
    validity_notes : callable
        Where the method is outside its range, from speeds, wave heights and angles off the bow.
    reads : The conditions that the forces depend on.
    """

    method: str
    hull: Hull
    force: Callable[[FloatArray, FloatArray, FloatArray, FloatArray], FloatArray]
    validity_notes: Callable[[FloatArray, FloatArray, FloatArray], list[RangeNote]]
    reads: frozenset[str]


@dataclass(frozen=True, eq=False)
class WindResistance:
    """Wind resistance for one ship.

    Attributes
    ----------
    frontal_area : [m2].
    coefficient : C_AA from the angle of the relative wind [rad].
    """

    method: str
    hull: Hull
    frontal_area: float
    coefficient: Callable[[FloatArray], FloatArray]

    def force(self, speed: FloatArray, wind_speed: FloatArray, angle: FloatArray) -> FloatArray:
        """Wind resistance [N] at a speed through water [m/s], the air's own resistance included.

        The wind is that relative to the moving water [m/s], its angle off the bow [rad].
        """
        relative, where = relative_wind(wind_speed, angle, ship_speed=speed)
        return wind_resistance(relative, self.coefficient(where), frontal_area=self.frontal_area)


_WAVE_PARTICULARS = (
    "length_between_perpendiculars_m",
    "breadth_m",
    "draught_m",
    "block_coefficient",
)
_WAVE_CONDITIONS = frozenset({"wave_height", "wave_angle"})


def _stawave_1(hull: Hull) -> AddedWaveResistance:
    need = ("length_between_perpendiculars_m", "breadth_m")
    length, breadth = required_particulars(hull, need, "stawave_1", instead="waves: none")
    bow = hull.number("length_bow_m")
    if bow is None:
        bow = 0.15 * length
        hull = hull.with_estimates(Estimate("length_bow_m", bow, "0.15 L_PP, as Yu (2021)"))

    def force(
        speed: FloatArray, height: FloatArray, period: FloatArray, angle: FloatArray
    ) -> FloatArray:
        found = stawave1(height, angle, breadth=breadth, bow_length=bow)
        return np.where(np.isnan(speed), np.nan, found)

    def notes(speed: FloatArray, height: FloatArray, angle: FloatArray) -> list[RangeNote]:
        high = stawave1_validity(height, length_between_perpendiculars=length)
        return [*high, *head_sector_validity(angle, method="stawave1")]

    return AddedWaveResistance("stawave_1", hull, force, notes, _WAVE_CONDITIONS)


def _stawave_2(hull: Hull) -> AddedWaveResistance:
    length, breadth, draught, block = required_particulars(
        hull, _WAVE_PARTICULARS, "stawave_2", instead="stawave_1"
    )
    sizes: dict[str, Any] = {
        "length_between_perpendiculars": length,
        "breadth": breadth,
        "draught": draught,
        "block_coefficient": block,
    }
    hull = hull.with_estimates(_PITCH_GYRATION)
    gyration = float(hull.values["pitch_gyration"])

    def force(
        speed: FloatArray, height: FloatArray, period: FloatArray, angle: FloatArray
    ) -> FloatArray:
        return stawave2(
            speed, height, _clipped_period(period), angle, **sizes, pitch_gyration=gyration
        )

    def notes(speed: FloatArray, height: FloatArray, angle: FloatArray) -> list[RangeNote]:
        ahead = head_sector_validity(angle, method="stawave2")
        return [*stawave2_validity(speed, **sizes), *ahead]

    return AddedWaveResistance("stawave_2", hull, force, notes, _WAVE_CONDITIONS | {"wave_period"})


def _snnm(hull: Hull) -> AddedWaveResistance:
    keys = (*_WAVE_PARTICULARS, *FORM_KEYS)
    hull = estimate_or_raise(hull, keys, "snnm", instead="stawave_1")
    length, breadth, _, block = (float(hull.values[key]) for key in _WAVE_PARTICULARS)
    hull = _with_entrance_and_run(hull).with_estimates(_PITCH_GYRATION)
    vessel = SnnmHull(
        length=length,
        breadth=breadth,
        draught_fore=float(hull.values["draught_fore_m"]),
        draught_aft=float(hull.values["draught_aft_m"]),
        block_coefficient=block,
        entrance_length=float(hull.values["length_entrance_m"]),
        run_length=float(hull.values["length_run_m"]),
        pitch_gyration=float(hull.values["pitch_gyration"]),
    )

    table = SnnmTable.of(vessel, shortest=SHORTEST_PERIOD, longest=LONGEST_PERIOD)

    def force(
        speed: FloatArray, height: FloatArray, period: FloatArray, angle: FloatArray
    ) -> FloatArray:
        return table(speed, height, _clipped_period(period), angle)

    def notes(speed: FloatArray, height: FloatArray, angle: FloatArray) -> list[RangeNote]:
        return snnm_validity(speed, vessel)

    return AddedWaveResistance("snnm", hull, force, notes, _WAVE_CONDITIONS | {"wave_period"})


def _with_entrance_and_run(hull: Hull) -> Hull:
    """The hull with lengths of entrance and run [m], estimated when not given."""
    form = hull_form_of(hull)
    entrance = float(_ENTRANCE_FRACTION * (1.0 - form.prismatic_coefficient) * form.length)
    run = float(length_of_run(form))
    return hull.with_estimates(
        Estimate("length_entrance_m", entrance, f"{_ENTRANCE_FRACTION:g} (1 - C_P) L_WL, ours"),
        Estimate("length_run_m", run, "Holtrop and Mennen (1982)"),
    )


def _clipped_period(period: FloatArray) -> FloatArray:
    return np.clip(period, SHORTEST_PERIOD, LONGEST_PERIOD)


def _wind_method_for(hull: Hull) -> str:
    """Return the choice of a wind method that needs no more than a hull has."""
    if hull.number("frontal_area_m2") is None:
        return "wind: yu_2021"
    return "wind: ittc" if hull.number("lateral_area_m2") is None else "wind: blendermann_1994"


def _fujiwara(hull: Hull, kind: str) -> WindResistance:
    keys = (
        *("length_overall_m", "breadth_m", "frontal_area_m2", "lateral_area_m2"),
        *("superstructure_lateral_area_m2", "superstructure_height_m"),
    )
    length, breadth, front, side, deck, high = required_particulars(
        hull, keys, "fujiwara_2006", instead=_wind_method_for(hull)
    )
    centre = hull.number("lateral_centre_height_m")
    if centre is None:
        centre = 0.5 * side / length
        guess = Estimate("lateral_centre_height_m", centre, "half of A_YV over L_OA")
        hull = hull.with_estimates(guess)
    vessel = FujiwaraShip(
        length,
        breadth,
        front,
        side,
        deck,
        high,
        hull.number("lateral_centre_offset_m") or 0.0,
        centre,
    )
    return WindResistance("fujiwara_2006", hull, front, lambda angle: fujiwara_2006(angle, vessel))


#: words in ``hull.type`` and Blendermann's type for them, the first that fits
_BLENDERMANN_TYPES: Final = {
    **{"container": "container_loaded", "lng": "lng_tanker", "gas": "lng_tanker"},
    **{"tanker": "tanker_loaded", "vehicle": "car_carrier", "car carrier": "car_carrier"},
    **{"cruise": "cruise", "ferry": "ferry", "ro pax": "ferry", "passenger": "ferry"},
    **{"supply": "offshore_supply", "offshore": "offshore_supply", "research": "research"},
}

_CARGO_WORDS: Final = ("cargo", "bulk", "carrier", "coaster", "dry", "multi", "reefer", "dredg")


def _with_blendermann_type(hull: Hull) -> tuple[Hull, str]:
    """Blendermann's type of ship from ``hull.type``; a cargo ship when it is not given."""
    given = str(hull.values.get("type", "")).casefold().replace("_", " ").replace("-", " ")
    kinds = (kind for word, kind in _BLENDERMANN_TYPES.items() if word in given)
    kind = next(kinds, "")
    why = f"from hull.type {given!r}" if given else "no hull.type given"
    if given and not kind and not any(word in given for word in _CARGO_WORDS):
        why = f"hull.type {given!r} names no known type"
    kind = kind or "cargo_loaded"
    return hull.with_estimates(Estimate("models.wind_type", kind, why)), kind


def _blendermann(hull: Hull, kind: str) -> WindResistance:
    if not kind:
        hull, kind = _with_blendermann_type(hull)
    if kind not in BLENDERMANN:
        raise unknown_name_error(
            "type of ship for blendermann_1994 (models.wind_type)", kind, BLENDERMANN
        )
    keys = ("frontal_area_m2", "lateral_area_m2")
    instead = _wind_method_for(hull)
    front, side = required_particulars(hull, keys, "blendermann_1994", instead=instead)

    def coefficient(angle: FloatArray) -> FloatArray:
        return blendermann_1994(
            angle, frontal_area=front, lateral_area=side, ship_type=BLENDERMANN[kind]
        )

    return WindResistance("blendermann_1994", hull, front, coefficient)


def _ittc(hull: Hull, kind: str) -> WindResistance:
    curve = kind or "tanker_laden"
    if not kind:
        hull = hull.with_estimates(Estimate("models.wind_type", curve, "the usual curve"))
    if curve not in ITTC_CURVES:
        raise unknown_name_error("wind curve (models.wind_type)", curve, ITTC_CURVES)
    (front,) = required_particulars(hull, ("frontal_area_m2",), "ittc", instead="wind: yu_2021")
    return WindResistance("ittc", hull, front, lambda angle: ittc_curve(angle, curve=curve))


def _yu(hull: Hull, kind: str) -> WindResistance:
    (breadth,) = required_particulars(hull, ("breadth_m",), "yu_2021", instead="wind: none")
    front = hull.number("frontal_area_m2")
    if front is None:
        aft = float(hull.values["draught_aft_m"])
        front = float(yu_2021_area(breadth, draught_aft=aft))
        hull = hull.with_estimates(Estimate("frontal_area_m2", front, "0.8 B T_A, Yu (2021)"))
    return WindResistance("yu_2021", hull, front, yu_2021_coefficient)


WAVE_METHODS: Final[Mapping[str, Callable[[Hull], AddedWaveResistance]]] = MappingProxyType(
    {"stawave_1": _stawave_1, "stawave_2": _stawave_2, "snnm": _snnm}
)
WIND_METHODS: Final[Mapping[str, Callable[[Hull, str], WindResistance]]] = MappingProxyType(
    {
        "fujiwara_2006": _fujiwara,
        "blendermann_1994": _blendermann,
        "ittc": _ittc,
        "iso_15016": _ittc,
        "yu_2021": _yu,
    }
)


def build_wave_resistance(models: ModelsSection, hull: Hull) -> AddedWaveResistance | None:
    """Return the wave part chosen in a ship file; None for ``none``.

    A negative resistance in waves from astern is set to zero unless the file says
    ``wave_push: true``: the push of high seas is the least certain part of such methods, and a
    search would look for it.

    Parameters
    ----------
    models : Methods of the ship file.

    Returns
    -------
    AddedWaveResistance or None : The resistance model.

    Raises
    ------
    InputError
    """
    name = models.waves
    if name == "none":
        return None
    if name not in WAVE_METHODS:
        raise unknown_name_error("wave method", name, ("none", *WAVE_METHODS))
    waves = WAVE_METHODS[name](hull)
    return waves if models.wave_push else _without_negative_resistance(waves)


def _without_negative_resistance(waves: AddedWaveResistance) -> AddedWaveResistance:
    def force(*at: FloatArray) -> FloatArray:
        return np.maximum(waves.force(*at), 0.0)

    return replace(waves, force=force)


def build_wind_resistance(models: ModelsSection, hull: Hull) -> WindResistance | None:
    """Return the wind part chosen in a ship file; None for ``none``.

    Parameters
    ----------
    models : Methods of the ship file.

    Returns
    -------
    WindResistance or None : The resistance model.

    Raises
    ------
    InputError
    """
    name = models.wind
    if name == "none":
        return None
    if name not in WIND_METHODS:
        raise unknown_name_error("wind method", name, ("none", *WIND_METHODS))
    return WIND_METHODS[name](hull, models.wind_type)
