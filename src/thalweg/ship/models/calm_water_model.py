"""Calm-water resistance of a composed ship, by the name of the method."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, Final, Literal

import numpy as np

from thalweg.core.errors import unknown_name_error
from thalweg.core.types import FloatArray
from thalweg.core.units import SEA_WATER_DENSITY
from thalweg.ship.hull.estimate import Estimate
from thalweg.ship.hull.hull import Hull
from thalweg.ship.hull.hull_estimates import estimate_or_raise
from thalweg.ship.methods.resistance.friction_lines import (
    SEA_WATER_VISCOSITY,
    Water,
    reynolds_number,
)
from thalweg.ship.methods.resistance.hollenbach import (
    hollenbach_1998,
    hollenbach_validity,
    hollenbach_wetted_surface,
)
from thalweg.ship.methods.resistance.hollenbach_hull import (
    AppendageCounts,
    HollenbachHull,
)
from thalweg.ship.methods.resistance.holtrop_form import (
    HullForm,
    half_angle_of_entrance,
    hull_form,
    wetted_surface,
)
from thalweg.ship.methods.resistance.holtrop_mennen import (
    BulbTransomAppendages,
    holtrop,
    holtrop_validity,
)
from thalweg.ship.methods.shallow_water.shallow_water_resistance import (
    karpov_speed,
    karpov_validity,
    lackenby_1963_deep_speed,
    lackenby_1963_validity,
    zeng_2019_friction,
)
from thalweg.ship.methods.validity import RangeNote
from thalweg.ship.schema.ship_schema import ShipFile, WaterSection

#: names of the components of calm-water resistance; each is there, zero where a method has none
CALM_WATER_COMPONENTS: Final = (
    *("friction", "form_factor", "appendage", "wave_making", "bulb", "transom"),
    *("correlation", "residuary"),
)
#: ``karpov_bands`` has the steps that Karpov's curves are printed with; ``zeng_2019`` is friction
SHALLOW_WATER_METHODS: Final = ("none", "karpov", "karpov_bands", "lackenby_1963", "zeng_2019")
_KARPOV_METHODS: Final = ("karpov", "karpov_bands")
FRICTION_LINES: Final = ("ittc_1957", "zeng_2019")
STERN_SHAPES: Final = MappingProxyType(
    {"pram": -25.0, "v": -10.0, "v_shaped": -10.0, "normal": 0.0, "u": 10.0, "u_shaped": 10.0}
)
#: (speed, speed of the waves, friction coefficient or None) -> components
DeepWaterComponents = Callable[[FloatArray, FloatArray, "FloatArray | None"], dict[str, FloatArray]]


@dataclass(frozen=True, eq=False)
class CalmWaterResistance:
    """Calm-water resistance for one hull.

    Attributes
    ----------
    hull : With what the method needed and was estimated.
    deep : callable
        Components [N] from speed [m/s], the speed that makes the waves and a friction coefficient.
    validity_notes : Where the method is outside its range, from speeds.
    shallow_water, friction : Names of the shallow-water method and the friction line.
    viscosity : Kinematic viscosity of the water [m2/s].
    """

    method: str
    hull: Hull
    deep: DeepWaterComponents
    validity_notes: Callable[[FloatArray], list[RangeNote]]
    shallow_water: str = "none"
    friction: str = "ittc_1957"
    viscosity: float = SEA_WATER_VISCOSITY

    @property
    def reads_depth(self) -> bool:
        """Whether the depth of the water matters."""
        return self.shallow_water != "none" or self.friction == "zeng_2019"

    def total(self, speed: FloatArray, depth: FloatArray) -> FloatArray:
        """Resistance [N] at speeds [m/s] in water of a depth [m]."""
        if not self.reads_depth:
            return _total_resistance(self.deep(speed, speed, None))
        if self.shallow_water == "lackenby_1963":
            return self._lackenby(speed, depth)
        waves = speed
        if self.shallow_water in _KARPOV_METHODS:
            bands, draught = self.shallow_water == "karpov_bands", self._number("draught_m")
            waves = karpov_speed(speed, depth=depth, draught=draught, raw_bands=bands)
        return _total_resistance(self.deep(speed, waves, self._line(speed, depth)))

    def components(self, speed: FloatArray, depth: FloatArray) -> dict[str, FloatArray]:
        """Components [N] in deep water, and ``shallow``: what the depth adds to their sum."""
        far = np.full(np.shape(depth), np.inf)
        parts = self.deep(speed, speed, self._line(speed, far))
        shape = np.broadcast_shapes(np.shape(speed), np.shape(depth))
        parts = {name: np.broadcast_to(value, shape) for name, value in parts.items()}
        return {**parts, "shallow": self.total(speed, depth) - _total_resistance(parts)}

    def notes(self, speed: FloatArray, depth: FloatArray) -> list[RangeNote]:
        """Where the methods are outside their ranges."""
        found = self.validity_notes(speed)
        if self.shallow_water in _KARPOV_METHODS:
            found = [*found, *karpov_validity(speed, depth=depth)]
        if self.shallow_water == "lackenby_1963":
            area = self._midship_area()
            found = [*found, *lackenby_1963_validity(speed, depth=depth, midship_area=area)]
        return found

    def _lackenby(self, speed: FloatArray, depth: FloatArray) -> FloatArray:
        far = np.full(np.shape(depth), np.inf)
        deep = lackenby_1963_deep_speed(speed, depth=depth, midship_area=self._midship_area())
        force = _total_resistance(self.deep(deep, deep, self._line(deep, far)))
        with np.errstate(divide="ignore", invalid="ignore"):
            raised = np.where(speed > 0.0, force * deep / speed, 0.0 * force)
        return np.where(depth > self._number("draught_m"), raised, np.nan)

    def _line(self, speed: FloatArray, depth: FloatArray) -> FloatArray | None:
        """Friction coefficient, or None for the method's own ITTC 1957 line."""
        if self.friction == "ittc_1957":
            return None
        length, breadth = self._number("length_waterline_m"), self._number("breadth_m")
        return zeng_2019_friction(
            reynolds_number(speed, length=length, viscosity=self.viscosity),
            depth=depth,
            draught=self._number("draught_m"),
            length=length,
            wetted_surface=self._number("wetted_surface_m2"),
            flat_bottom_area=length * breadth,
        )

    def _midship_area(self) -> float:
        sides = ("breadth_m", "draught_m", "midship_coefficient")
        return float(np.prod([self._number(key) for key in sides]))

    def _number(self, key: str) -> float:
        return float(self.hull.values[key])


def _total_resistance(parts: Mapping[str, FloatArray]) -> FloatArray:
    return np.sum(np.broadcast_arrays(*parts.values()), axis=0)


def _water_properties(given: WaterSection) -> dict[str, float]:
    """Density and viscosity of the water; the sea at 15 degC when not given."""
    density, viscosity = given.density_kg_m3, given.kinematic_viscosity_m2_s
    return {
        "density": SEA_WATER_DENSITY if density is None else density,
        "viscosity": SEA_WATER_VISCOSITY if viscosity is None else viscosity,
    }


def _all_components(**known: FloatArray) -> dict[str, FloatArray]:
    zero = 0.0 * next(iter(known.values()))
    return {name: known.get(name, zero) for name in CALM_WATER_COMPONENTS}


#: what a `HullForm` is made from
FORM_KEYS: Final = (
    *("length_waterline_m", "breadth_m", "draught_m", "displacement_m3"),
    *("midship_coefficient", "waterplane_coefficient", "lcb_percent"),
)
_APPENDAGE_KEYS = ("bulb_area_m2", "bulb_centre_height_m", "transom_area_m2", "appendage_area_m2")


def hull_form_of(hull: Hull) -> HullForm:
    """The hull as Holtrop's methods take it; all of `FORM_KEYS` must be known."""
    numbers = {key: float(hull.values[key]) for key in FORM_KEYS}
    return hull_form(
        length_waterline=numbers["length_waterline_m"],
        breadth=numbers["breadth_m"],
        draught=numbers["draught_m"],
        displacement=numbers["displacement_m3"],
        midship_coefficient=numbers["midship_coefficient"],
        waterplane_coefficient=numbers["waterplane_coefficient"],
        lcb_percent=numbers["lcb_percent"],
    )


def stern_shape(hull: Hull) -> float:
    """Return C_stern from the name of a stern shape or a number; 0 by default."""
    given = hull.values.get("stern_shape", 0.0)
    return STERN_SHAPES[given] if isinstance(given, str) else float(given)


def _with_estimated_shape(hull: Hull, form: HullForm) -> Hull:
    """The hull with Holtrop's values for shapes that the ship file does not give."""
    angle = float(half_angle_of_entrance(form))
    taken = [Estimate("half_entrance_angle_deg", angle, "Holtrop and Mennen (1982)")]
    if "stern_shape" not in hull.values:
        taken.append(Estimate("stern_shape", "normal", "taken as normal"))
    if hull.number("appendage_area_m2"):
        taken.append(Estimate("appendage_factor", 1.5, "taken as that of a rudder behind a skeg"))
    return hull.with_estimates(*taken)


def _holtrop(hull: Hull, file: ShipFile, year: Literal[1982, 1984]) -> CalmWaterResistance:
    name = "holtrop_mennen_1982" if year == 1982 else "holtrop_1984"
    hull = estimate_or_raise(hull, (*FORM_KEYS, *_APPENDAGE_KEYS), name, instead="another method")
    form = hull_form_of(hull)
    if hull.number("wetted_surface_m2") is None:
        own = float(wetted_surface(form, bulb_area=float(hull.values["bulb_area_m2"])))
        hull = hull.with_estimates(Estimate("wetted_surface_m2", own, "Holtrop and Mennen (1982)"))
    hull = _with_estimated_shape(hull, form)
    ends = BulbTransomAppendages(
        bulb_area=float(hull.values["bulb_area_m2"]),
        bulb_centre_height=float(hull.values["bulb_centre_height_m"]),
        transom_area=float(hull.values["transom_area_m2"]),
        appendage_area=float(hull.values["appendage_area_m2"]),
        appendage_factor=hull.number("appendage_factor") or 1.5,
        stern_shape=stern_shape(hull),
    )
    fore = float(hull.values["draught_fore_m"])
    angle = hull.number("half_entrance_angle_deg")
    water = _water_properties(file.water)
    area_of_correlation = file.models.correlation_area

    def deep(
        speed: FloatArray, waves: FloatArray, line: FloatArray | None
    ) -> dict[str, FloatArray]:
        found = holtrop(
            speed,
            form,
            year=year,
            bulb_transom_appendages=ends,
            draught_fore=fore,
            wetted_surface_area=float(hull.values["wetted_surface_m2"]),
            entrance_angle_deg=angle,
            friction_coefficient=line,
            wave_speed=waves,
            correlation_area=area_of_correlation,
            **water,
        )
        return _all_components(
            **{k: getattr(found, k) for k in CALM_WATER_COMPONENTS if k != "residuary"}
        )

    def notes(speed: FloatArray) -> list[RangeNote]:
        height = float(hull.values["bulb_centre_height_m"])
        return holtrop_validity(
            speed, form, year=year, draught_fore=fore, bulb_centre_height=height
        )

    return CalmWaterResistance(name, hull, deep, notes)


_HOLLENBACH_KEYS = (
    *("length_between_perpendiculars_m", "length_waterline_m", "length_over_surface_m"),
    *("breadth_m", "draught_m", "block_coefficient", "propeller_diameter_m"),
)
#: in the order of `HollenbachHull`
_HOLLENBACH_PARTICULARS = (
    *("length_between_perpendiculars_m", "length_waterline_m", "length_over_surface_m"),
    *("breadth_m", "draught_fore_m", "draught_aft_m", "block_coefficient"),
    "propeller_diameter_m",
)
_APPENDAGE_COUNTS = ("rudders", "brackets", "bosses", "thrusters")


def _hollenbach(hull: Hull, file: ShipFile, line_of: str) -> CalmWaterResistance:
    name = f"hollenbach_1998_{line_of}"
    propulsion, diameter = file.propulsion, file.propulsion.propeller_diameter_m
    if diameter is not None:
        hull = Hull({**hull.values, "propeller_diameter_m": diameter}, hull.estimated)
    hull = estimate_or_raise(hull, _HOLLENBACH_KEYS, name, instead="another method")
    variant, surface_of = _hollenbach_variant(hull, file, line_of)
    if file.loading.condition == "ballast" and variant != "single_ballast":
        why = "Hollenbach has a ballast line for the mean of single screws only"
        hull = hull.with_estimates(Estimate("loading.condition", variant, why))
    sizes = _hollenbach_hull(hull)
    if propulsion.propellers >= 2:  # the lines of single screws do not depend on it
        hull = hull.with_estimates(Estimate("rudders", 1.0, "taken as one"))
    counts = AppendageCounts(**{key: hull.number(key) or 0.0 for key in _APPENDAGE_COUNTS})
    if hull.number("wetted_surface_m2") is None:
        own = hollenbach_wetted_surface(sizes, appendages=counts, variant=surface_of)
        hull = hull.with_estimates(Estimate("wetted_surface_m2", float(own), "Hollenbach (1998)"))
    options: dict[str, Any] = {
        "wetted_surface": float(hull.values["wetted_surface_m2"]),
        "appendages": counts,
        "variant": variant,
        "water": Water(**_water_properties(file.water)),
    }

    def deep(
        speed: FloatArray, waves: FloatArray, line: FloatArray | None
    ) -> dict[str, FloatArray]:
        found = hollenbach_1998(speed, sizes, **options, friction_coefficient=line)
        making = found if waves is speed else hollenbach_1998(waves, sizes, **options)
        return _all_components(friction=found.friction, residuary=making.residuary)

    def notes(speed: FloatArray) -> list[RangeNote]:
        return hollenbach_validity(speed, sizes, variant=variant)

    return CalmWaterResistance(name, hull, deep, notes)


def _hollenbach_hull(hull: Hull) -> HollenbachHull:
    """The hull as Hollenbach's regressions take it; all of its particulars must be known."""
    numbers = {key: float(hull.values[key]) for key in _HOLLENBACH_PARTICULARS}
    return HollenbachHull(*numbers.values())


def _hollenbach_variant(hull: Hull, file: ShipFile, line_of: str) -> tuple[Any, Any]:
    """Coefficient sets for resistance and wetted surface, from the screws and the loading."""
    screws = "twin" if file.propulsion.propellers >= 2 else "single"
    ballast = file.loading.condition == "ballast"
    if screws == "twin":
        bulb = (hull.number("bulb_area_m2") or 0.0) > 0.0
        surface = "twin_bulb" if bulb else "twin_no_bulb"
    else:
        surface = "single_ballast" if ballast else "single_design"
    if line_of == "min":
        return f"{screws}_minimum", surface
    if ballast and screws == "single":
        return "single_ballast", surface
    return f"{screws}_design", surface


CALM_WATER_METHODS: Final[Mapping[str, Callable[[Hull, ShipFile], CalmWaterResistance]]] = (
    MappingProxyType(
        {
            "holtrop_mennen_1982": lambda hull, file: _holtrop(hull, file, 1982),
            "holtrop_1984": lambda hull, file: _holtrop(hull, file, 1984),
            "hollenbach_1998_mean": lambda hull, file: _hollenbach(hull, file, "mean"),
            "hollenbach_1998_min": lambda hull, file: _hollenbach(hull, file, "min"),
        }
    )
)


def build_calm_water(file: ShipFile, hull: Hull) -> CalmWaterResistance:
    """Return the calm-water part chosen in a ship file.

    Returns
    -------
    CalmWaterResistance : The resistance model.

    Raises
    ------
    InputError : For unknown names, and particulars that are missing and cannot be estimated.
    """
    shallow, friction = file.models.shallow_water, file.models.friction
    if shallow not in SHALLOW_WATER_METHODS:
        raise unknown_name_error("shallow-water method", shallow, SHALLOW_WATER_METHODS)
    if friction not in FRICTION_LINES:
        raise unknown_name_error("friction line", friction, FRICTION_LINES)
    if shallow == "zeng_2019":
        shallow, friction = "none", "zeng_2019"
    calm = CALM_WATER_METHODS[file.models.calm_water or ""](hull, file)
    if shallow == "lackenby_1963":
        keys = ("midship_coefficient",)
        hull = estimate_or_raise(calm.hull, keys, shallow, instead="shallow_water: none")
        calm = CalmWaterResistance(calm.method, hull, calm.deep, calm.validity_notes)
    viscosity = _water_properties(file.water)["viscosity"]
    return CalmWaterResistance(
        calm.method, calm.hull, calm.deep, calm.validity_notes, shallow, friction, viscosity
    )
