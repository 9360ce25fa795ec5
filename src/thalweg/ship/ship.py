"""`Ship`: name, model, loading, limits and ship file."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.errors import InputError
from thalweg.core.given_numbers import float_array
from thalweg.core.types import FloatArray
from thalweg.core.units import KNOT
from thalweg.ship.condition_variables import HEADING_DEPENDENT, needed_variables
from thalweg.ship.file.known_speed_ship_builder import estimates_of_known_speeds
from thalweg.ship.file.part_builders import build_limits, build_loading, with_safety_limits
from thalweg.ship.file.ship_builder import build_model, simple_data
from thalweg.ship.file.ship_file import library_names, read_ship
from thalweg.ship.fuel_prices import FuelTerms, fuel_terms
from thalweg.ship.hull.estimate import Estimate
from thalweg.ship.hull.hull import complete_hull
from thalweg.ship.loading_state import Loading
from thalweg.ship.methods.engine.specific_consumption import GRAM_PER_KILOWATT_HOUR
from thalweg.ship.model_protocol import (
    AdjustableModel,
    CrabAngleModel,
    DraughtModel,
    EstimatingModel,
    ShipModel,
)
from thalweg.ship.models.function_model import FunctionModel, SpeedFunction, model_of_function
from thalweg.ship.models.known_speed_fuel import hotel_load_fuel_rate, hotel_power
from thalweg.ship.plugins import load_plugin
from thalweg.ship.queries import ShipQueries
from thalweg.ship.schema.ship_schema import ShipFile, empty_ship_file
from thalweg.ship.ship_limits import ShipLimits

_SINGLE_PRECISION = 2.0**-23


@dataclass(frozen=True, eq=False)
class Ship(ShipQueries):
    """A ship: its speed, power and fuel in given conditions, and its limits of weather.

    Made by `Ship.load`, `Ship.from_dict`, `Ship.simple` or `Ship.from_speed_function`.

    Attributes
    ----------
    name : str
    model : ShipModel
        Speed, power and fuel.
    loading : Loading
        Draught and load factor.
    limits : ShipLimits
        Greatest waves and wind.
    file : ShipFile
        The contents of its ship file; empty for a ship without one.
    estimated : tuple of Estimate
        Estimated particulars.

    Examples
    --------
    >>> ship = Ship.simple(speed_kn=8.0, draught_m=5.0)
    >>> float(ship.draught), len(ship.speeds)
    (5.0, 1)
    """

    name: str
    model: ShipModel
    loading: Loading
    limits: ShipLimits = field(default_factory=ShipLimits)
    file: ShipFile = field(default_factory=empty_ship_file)
    estimated: tuple[Estimate, ...] = ()

    @classmethod
    def load(cls, name_or_path: str | Path) -> Ship:
        """Read a ship of the library or of a plug-in by name, or a ship file (YAML) by path.

        Raises
        ------
        InputError
            If there is no such ship (with near matches), or the file has a fault.
        """
        known = not isinstance(name_or_path, str) or name_or_path in library_names()
        offered = None if known else load_plugin(str(name_or_path))
        if offered is None:
            data, source = read_ship(name_or_path)
            return cls.from_dict(data, source=source)
        return cls._of_plugin(str(name_or_path), offered)

    @classmethod
    def _of_plugin(cls, name: str, offered: Any) -> Ship:
        """Make a ship of what a plug-in offers."""
        if isinstance(offered, Ship):
            return offered
        if isinstance(offered, Mapping):
            return cls.from_dict(offered, source=f"plug-in ship {name!r}")
        if isinstance(offered, ShipModel):
            draught = float(offered.draught) if isinstance(offered, DraughtModel) else 0.0
            return cls(name, offered, Loading(draught, draught))
        if callable(offered):
            return cls.from_speed_function(offered, name=name)
        raise InputError(
            f"The plug-in ship {name!r} is {type(offered).__name__}.",
            "A plug-in offers a Ship, a mapping like a ship file, a ship model, or a function of "
            "conditions that returns speeds.",
            "Report this to the author of the plug-in.",
        )

    @classmethod
    def from_dict(cls, data: Mapping[str, Any], *, source: str = "ship") -> Ship:
        """Make a ship from the plain data of a ship file.

        Raises
        ------
        InputError
            For unknown or missing keys, numbers out of range and impossible hulls.
        """
        file = ShipFile.of(data, source)
        hull = complete_hull(file.hull.plain())
        loading = build_loading(file, hull)
        model = build_model(file, hull, loading)
        return cls(
            name=file.name,
            model=model,
            loading=loading,
            limits=with_safety_limits(build_limits(file), file, hull, loading),
            file=file,
            estimated=model.estimated
            if isinstance(model, EstimatingModel)
            else estimates_of_known_speeds(file, hull, loading),
        )

    @classmethod
    def simple(
        cls,
        speed_kn: float = 8.0,
        draught_m: float = 5.0,
        *,
        name: str = "simple ship",
        speeds_kn: Sequence[float] | None = None,
        length_m: float | None = None,
        breadth_m: float | None = None,
        block_coefficient: float | None = None,
        displacement_m3: float | None = None,
        fuel_t_per_day: float | None = None,
        speed_loss: str = "none",
        max_wave_height_m: float | None = None,
        max_wind_speed_kn: float | None = None,
    ) -> Ship:
        """Make a ship from a few numbers.

        Parameters
        ----------
        speed_kn : float
            Calm-water speed [kn].
        draught_m : float
            [m].
        name : str
        speeds_kn : sequence of float, optional
            Several ordered speeds [kn]; ``speed_kn`` is then only the reference of the fuel.
        length_m, breadth_m, block_coefficient, displacement_m3 : float, optional
            Particulars, for the speed loss.
        fuel_t_per_day : float, optional
            Fuel at ``speed_kn`` [t/day]; other speeds follow the cubic law.
        speed_loss : {"none", "kwon_2008"}
        max_wave_height_m, max_wind_speed_kn : float, optional
            Limits: significant wave height [m], wind at 10 m [kn].

        Returns
        -------
        Ship
            Without fuel data its fuel is unknown (NaN), never zero.
        """
        data = simple_data(
            name=name,
            speeds_kn=[speed_kn] if speeds_kn is None else list(speeds_kn),
            hull={
                "length_between_perpendiculars_m": length_m,
                "breadth_m": breadth_m,
                "draught_m": draught_m,
                "block_coefficient": block_coefficient,
                "displacement_m3": displacement_m3,
            },
            limits={
                "max_significant_wave_height_m": max_wave_height_m,
                "max_wind_speed_kn": max_wind_speed_kn,
            },
            fuel={"reference_t_per_day": fuel_t_per_day},
            engine={"reference_speed_kn": speed_kn},
            models={"speed_loss": speed_loss},
        )
        return cls.from_dict(data)

    @classmethod
    def from_speed_function(
        cls,
        function: SpeedFunction,
        *,
        draught_m: float = 0.0,
        top_speed: float | None = None,
        top_speed_kn: float | None = None,
        name: str = "function ship",
        limits: ShipLimits | None = None,
    ) -> Ship:
        """Make a ship from a function of conditions.

        Parameters
        ----------
        function : callable
            ``f(conditions) -> speed through water [m/s]``; conditions are read by attribute or key
            (see `Conditions`), as arrays. It may read either only what a table has axes for (wind
            and waves relative to the bow, depth), or only what does not depend on the heading
            (place, time, currents, plain sea variables by name).
        draught_m : float
            [m].
        top_speed, top_speed_kn : float, optional
            Greatest speed it ever gives, [m/s] or [kn]; measured when not given, if possible.
        name : str
        limits : ShipLimits, optional

        Raises
        ------
        InputError
            If the function fails, mixes both kinds, or gives other than one speed per condition.
        """
        if top_speed_kn is not None:
            top_speed = top_speed_kn * KNOT
        model = model_of_function(function, top_speed=top_speed)
        loading = Loading(float(draught_m), float(draught_m))
        return cls(name, model, loading, limits or ShipLimits())

    @property
    def speeds(self) -> FloatArray:
        """Calm-water speed of every setting at the load factor [m/s], ascending."""
        return self.model.speeds(self.loading.load_factor)

    @property
    def draught(self) -> float:
        """Draught at the load factor [m]."""
        return self.loading.draught

    @property
    def reads(self) -> frozenset[str]:
        """Conditions the model reads (names of `Conditions`)."""
        return self.model.reads

    @property
    def data(self) -> dict[str, Any]:
        """The keys of its ship file as plain data, for a changed ship by `Ship.from_dict`."""
        return self.file.plain()

    @property
    def breadth(self) -> float | None:
        """Breadth [m]; None if the ship file does not give it."""
        return self.file.hull.breadth_m

    @property
    def min_under_keel_clearance(self) -> float:
        """Least under-keel clearance of the ship file [m]; 0 if it gives none."""
        return self.file.limits.min_under_keel_clearance_m

    @property
    def specific_fuel_consumption(self) -> float:
        """Specific fuel consumption of the ship file [kg/J]; NaN if it gives none."""
        given = self.file.engine.sfoc_g_per_kwh
        return math.nan if given is None else given * GRAM_PER_KILOWATT_HOUR

    @property
    def depends_on_crab_angle(self) -> bool:
        """Whether the speed depends on the angle between heading and course."""
        return isinstance(self.model, CrabAngleModel) and self.model.depends_on_crab_angle

    @property
    def heading_matters(self) -> bool:
        """Whether the speed depends on the heading, or on its angle to the course."""
        return self.depends_on_crab_angle or bool(self.model.reads & HEADING_DEPENDENT)

    @property
    def needs(self) -> frozenset[str]:
        """Sea variables (CF standard names) that the model and the limits need."""
        if isinstance(self.model, FunctionModel):
            return self.model.needs | self.limits.needs
        return needed_variables(self.model.reads) | self.limits.needs

    @property
    def speed_field(self) -> Callable[..., FloatArray] | None:
        """``f(sampled, time, lat, lon) -> speed [m/s]`` for ships whose speed is a field, or None.

        ``sampled`` maps the variables of `needs` to arrays (m, s, m/s); time in seconds since
        1970-01-01T00:00Z, positions in degrees.
        """
        if isinstance(self.model, FunctionModel):
            return self.model.field(self.loading.load_factor)
        return None

    @property
    def fuel_terms(self) -> FuelTerms:
        """Fuels inside and outside emission control areas, their carbon and prices."""
        return fuel_terms(self.file)

    def with_load_factor(self, load_factor: float) -> Ship:
        """Return the ship at another load factor, 0 empty to 1 full."""
        return replace(self, loading=self.loading.at(load_factor))

    def with_limits(self, limits: ShipLimits) -> Ship:
        """Return the ship with other limits."""
        return replace(self, limits=limits)

    def with_speeds(self, speeds: ArrayLike) -> Ship:
        """Return the ship with other settings, given by their calm-water speeds [m/s].

        Raises
        ------
        InputError
            If a speed is not positive, is outside the ship's range, or the model has one speed.
        """
        wanted = np.unique(np.atleast_1d(float_array(speeds, "speeds")))
        if not isinstance(self.model, AdjustableModel):
            raise InputError(
                f"The speed of {self.name!r} follows from its model; no speed can be ordered.",
                "Only ships with an adjustable speed accept an ordered speed.",
                "Leave the ordered speed out.",
            )
        return replace(self, model=self.model.with_speeds(wanted, self.loading.load_factor))

    def top_speed(self, setting: int = 0) -> float | None:
        """Upper bound of the speed through water [m/s]; None for an unbounded field.

        It holds for the model and for its table, which is rounded to single precision.
        """
        top = self.model.top_speed(setting, self.loading.load_factor)
        return None if top is None else top * (1.0 + _SINGLE_PRECISION)

    @property
    def hotel_power(self) -> float:
        """Hotel load, under way and at anchor [W]; 0 if the ship file gives none."""
        return hotel_power(self.file.engine)

    @property
    def waiting_fuel_rate(self) -> float:
        """Fuel rate at anchor [kg/s]: that of the hotel load; 0 if the ship file gives none."""
        return hotel_load_fuel_rate(self.file.engine)

    def fingerprint(self) -> str:
        """Return a text that is equal for two ships only if they have the same performance."""
        return self._fingerprint

    @cached_property
    def _fingerprint(self) -> str:
        facts = {
            "model": self.model.identity,
            "loading": repr(self.loading),
            "limits": repr(self.limits),
        }
        text = json.dumps(facts, sort_keys=True, default=str)
        return hashlib.sha256(text.encode()).hexdigest()[:16]
