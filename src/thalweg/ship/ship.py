"""`Ship`: name, model, loading, limits and ship file."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from thalweg.core.delegation import changed, delegated
from thalweg.core.types import FloatArray
from thalweg.core.units import KNOT
from thalweg.ship import queries, ship_changes, ship_tabulation
from thalweg.ship.condition_variables import HEADING_DEPENDENT
from thalweg.ship.file import ship_builder
from thalweg.ship.file.price_reader import fuel_terms
from thalweg.ship.file.ship_file import library_names, read_ship
from thalweg.ship.fuel_prices import FuelTerms
from thalweg.ship.hull.estimate import Estimate
from thalweg.ship.loading_state import Loading
from thalweg.ship.model_protocol import CrabAngleModel, ShipModel
from thalweg.ship.models.function_model import FunctionModel, SpeedFunction, model_of_function
from thalweg.ship.models.resistance_protocol import ResistanceBased
from thalweg.ship.plugins import load_plugin
from thalweg.ship.schema.ship_schema import ShipFile, empty_ship_file
from thalweg.ship.ship_limits import ShipLimits


@dataclass(frozen=True, eq=False)
class Ship:
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
    terms : FuelTerms, optional
        Fuels and prices that replace those of the ship file (`with_prices`).

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
    terms: FuelTerms | None = None

    @classmethod
    def load(cls, name_or_path: str | Path) -> Ship:
        """Read a ship of the library or of a plug-in by name, or a ship file (YAML) by path.

        Parameters
        ----------
        name_or_path : str or path-like
            A name of `library_names` or `plugin_names`, or the path of a ship file.

        Returns
        -------
        Ship
            At the load factor of its file.

        Raises
        ------
        InputError
            If there is no such ship (with near matches), or the file has a fault.
        """
        known = not isinstance(name_or_path, str) or name_or_path in library_names()
        offered = None if known else load_plugin(str(name_or_path))
        if isinstance(offered, Ship):
            return offered
        if offered is not None:
            return cls(*ship_builder.plugin_parts(str(name_or_path), offered))
        data, source = read_ship(name_or_path)
        return cls.from_dict(data, source=source)

    @classmethod
    def from_dict(cls, data: Mapping[str, Any], *, source: str = "ship") -> Ship:
        """Make a ship from the plain data of a ship file.

        Parameters
        ----------
        data : mapping
            Keys of a ship file, with the units in their names.
        source : str
            What messages call the data.

        Returns
        -------
        Ship
            At the load factor of the data.

        Raises
        ------
        InputError
            For unknown or missing keys, numbers out of range and impossible hulls.
        """
        return cls(*ship_builder.ship_parts(data, source))

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
        draught_m : float [m]
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
        hull = {
            "length_between_perpendiculars_m": length_m,
            "breadth_m": breadth_m,
            "draught_m": draught_m,
            "block_coefficient": block_coefficient,
            "displacement_m3": displacement_m3,
        }
        data = ship_builder.simple_data(
            name=name,
            speeds_kn=[speed_kn] if speeds_kn is None else list(speeds_kn),
            hull=hull,
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
            Draught [m].
        top_speed, top_speed_kn : float, optional
            Greatest speed it ever gives, [m/s] or [kn]; measured when not given, if possible.
        name : str
        limits : ShipLimits, optional
            By default none.

        Returns
        -------
        Ship
            With the function as its model; its power and fuel are unknown (NaN).

        Raises
        ------
        InputError
            If the function fails, mixes both kinds, or gives other than one speed per condition.
        """
        top = top_speed if top_speed_kn is None else top_speed_kn * KNOT
        model = model_of_function(function, top_speed=top)
        return cls(*ship_builder.bare_ship_parts(name, model, float(draught_m), limits))

    with_prices = changed(ship_changes.ship_with_prices)
    with_charges = changed(ship_changes.ship_with_charges)
    with_load_factor = changed(ship_changes.ship_with_load_factor)
    with_clearance = changed(ship_changes.ship_with_clearance)
    with_approach_speed = changed(ship_changes.ship_with_approach_speed)
    with_limits = changed(ship_changes.ship_with_limits)
    with_speeds = changed(ship_changes.ship_with_speeds)
    speed_through_water = delegated(queries.ship_speed_through_water)
    power = delegated(queries.ship_power)
    fuel_rate = delegated(queries.ship_fuel_rate)
    power_and_fuel = delegated(queries.ship_power_and_fuel)
    power_at_speed = delegated(queries.ship_power_at_speed)
    resistance = delegated(queries.ship_resistance)
    notes = delegated(queries.ship_range_notes)
    tabulate = delegated(ship_tabulation.ship_speed_table)
    tabulate_fuel = delegated(ship_tabulation.ship_fuel_table)
    tabulate_power = delegated(ship_tabulation.ship_power_table)
    top_speed = delegated(queries.ship_top_speed)
    greatest_order = delegated(queries.ship_greatest_order)
    fingerprint = delegated(ship_tabulation.ship_fingerprint)

    def __repr__(self) -> str:
        """Return the ship in one line, such as ``<Ship 'tug': 6 to 12 kn, draught 4.4 m>``."""
        ends = dict.fromkeys(f"{speed / KNOT:.3g}" for speed in self.speeds[[0, -1]])
        speeds = "speed by place" if "nan" in ends else f"{' to '.join(ends)} kn"
        return f"<Ship {self.name!r}: {speeds}, draught {self.draught:g} m>"

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
    def length(self) -> float | None:
        """Length overall, or between perpendiculars or at the waterline [m]; None if unknown."""
        return self.file.hull.length_m

    @property
    def air_draught(self) -> float | None:
        """Height of the highest point above the water [m]; None if the ship file gives none."""
        return self.file.hull.air_draught_m

    @property
    def min_under_keel_clearance(self) -> float:
        """Least under-keel clearance of the ship file [m]; 0 if it gives none."""
        return self.file.limits.min_under_keel_clearance_m

    @property
    def approach_speed(self) -> float:
        """Greatest speed over ground in the approaches of ports [m/s]: 10 kn by default."""
        return self.file.limits.approach_speed_kn * KNOT

    @property
    def specific_fuel_consumption(self) -> float:
        """Specific fuel consumption of the ship file [kg/J]; NaN if it gives none."""
        return self.file.engine.specific_consumption

    @property
    def depends_on_crab_angle(self) -> bool:
        """Whether the speed depends on the angle between heading and course."""
        return isinstance(self.model, CrabAngleModel) and self.model.depends_on_crab_angle

    @property
    def heading_matters(self) -> bool:
        """Whether the speed depends on the heading, or on its angle to the course."""
        return self.depends_on_crab_angle or bool(self.model.reads & HEADING_DEPENDENT)

    @property
    def is_resistance_based(self) -> bool:
        """Whether the model knows the resistance, so that `power_at_speed` is available."""
        return isinstance(self.model, ResistanceBased)

    @property
    def needs(self) -> frozenset[str]:
        """Sea variables (CF standard names) that the model and the limits need."""
        return queries.model_needs(self.model) | self.limits.needs

    @property
    def speed_field(self) -> Callable[..., FloatArray] | None:
        """``f(sampled, time, lat, lon) -> speed [m/s]`` for ships whose speed is a field, or None.

        ``sampled`` maps the variables of `needs` to arrays (m, s, m/s); time in seconds since
        1970-01-01T00:00Z, positions in degrees.
        """
        model = self.model
        return model.field(self.loading.load_factor) if isinstance(model, FunctionModel) else None

    @property
    def fuel_terms(self) -> FuelTerms:
        """Fuels inside and outside emission control areas, their carbon and prices."""
        return fuel_terms(self.file) if self.terms is None else self.terms

    @property
    def hotel_power(self) -> float:
        """Hotel load, under way and at anchor [W]; 0 if the ship file gives none."""
        return self.file.engine.hotel_power

    @property
    def waiting_fuel_rate(self) -> float:
        """Fuel rate at anchor [kg/s]: that of the hotel load; 0 if the ship file gives none."""
        return self.file.engine.hotel_fuel_rate
