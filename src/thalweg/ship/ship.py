"""`Ship`: name, model, loading, limits and ship file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from numpy.typing import ArrayLike

from thalweg.core.delegation import delegated
from thalweg.core.units import KNOT
from thalweg.ship import queries, ship_tabulation
from thalweg.ship.file import ship_builder
from thalweg.ship.file.ship_file import library_names, read_ship
from thalweg.ship.fuel_prices import FuelTerms
from thalweg.ship.hull.estimate import Estimate
from thalweg.ship.loading_state import Loading
from thalweg.ship.methods.engine.european_charges import EuropeanCharges
from thalweg.ship.model_protocol import ShipModel
from thalweg.ship.models.function_model import SpeedFunction, model_of_function
from thalweg.ship.plugins import load_plugin
from thalweg.ship.schema.ship_schema import ShipFile, empty_ship_file
from thalweg.ship.ship_limits import ShipLimits
from thalweg.ship.ship_properties import ShipProperties


@dataclass(frozen=True, eq=False)
class Ship(ShipProperties):
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
        data = ship_builder.simple_data(
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

    def with_prices(
        self,
        usd_per_t: float | None = None,
        eca_price_factor: float | None = None,
        *,
        time_usd_per_day: float | None = None,
    ) -> Ship:
        """Return the ship with other prices of fuel and time.

        Parameters
        ----------
        usd_per_t : float, optional
            Price of fuel outside emission control areas [USD/t], 0 or more.
        eca_price_factor : float, optional
            Price of fuel inside them over the price outside [-], above 0.
        time_usd_per_day : float, optional
            Price of time [USD/day], 0 or more.

        Returns
        -------
        Ship
            Prices that are not given stay as they are.

        Raises
        ------
        InputError
            For prices that are not possible, or in two currencies.
        """
        given = {"usd_per_t": usd_per_t, "eca_price_factor": eca_price_factor}
        terms = self.fuel_terms.with_prices(**given, time_usd_per_day=time_usd_per_day)
        return replace(self, terms=terms)

    def with_charges(self, charges: EuropeanCharges | None) -> Ship:
        """Return the ship with charges of the European Union on its fuel, or without.

        Parameters
        ----------
        charges : EuropeanCharges or None
            Charges by mass of CO2 and greenhouse gases; None removes them.

        Returns
        -------
        Ship
            Its ``fuel_terms`` hold the charges.

        Raises
        ------
        InputError
            If its fuel has no price.
        """
        return replace(self, terms=self.fuel_terms.with_charges(charges))

    def with_load_factor(self, load_factor: float) -> Ship:
        """Return the ship at another load factor.

        Parameters
        ----------
        load_factor : float
            0 empty to 1 full.

        Returns
        -------
        Ship
            With the draught and displacement of that load.

        Raises
        ------
        InputError
            If the load factor is not a number from 0 to 1.
        """
        return replace(self, loading=self.loading.at(load_factor))

    def with_limits(self, limits: ShipLimits) -> Ship:
        """Return the ship with other limits of weather.

        Parameters
        ----------
        limits : ShipLimits
            These replace all limits that the ship has.

        Returns
        -------
        Ship
            Otherwise unchanged.
        """
        return replace(self, limits=limits)

    def with_speeds(self, speeds: ArrayLike) -> Ship:
        """Return the ship with other settings, given by their calm-water speeds.

        Parameters
        ----------
        speeds : array_like
            Calm-water speeds [m/s] at the load factor, above 0; sorted, each once.

        Returns
        -------
        Ship
            With these `speeds`.

        Raises
        ------
        InputError
            If a speed is not positive, is outside the ship's range, or the model has one speed.
        """
        return replace(self, model=queries.model_with_speeds(self, speeds))

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
    fingerprint = delegated(ship_tabulation.ship_fingerprint)
