"""What follows from the model, loading, limits and file of a ship."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from thalweg.core.types import FloatArray
from thalweg.ship import queries
from thalweg.ship.condition_variables import HEADING_DEPENDENT
from thalweg.ship.fuel_prices import FuelTerms, fuel_terms
from thalweg.ship.loading_state import Loading
from thalweg.ship.model_protocol import CrabAngleModel, ShipModel
from thalweg.ship.models import known_speed_fuel
from thalweg.ship.models.function_model import FunctionModel
from thalweg.ship.models.resistance_protocol import ResistanceBased
from thalweg.ship.schema.ship_schema import ShipFile
from thalweg.ship.ship_limits import ShipLimits


class ShipProperties:
    """Properties of `thalweg.ship.Ship`; a ship holds the attributes."""

    model: ShipModel
    loading: Loading
    limits: ShipLimits
    file: ShipFile
    terms: FuelTerms | None

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
        hull = self.file.hull
        lengths = (
            hull.length_overall_m, hull.length_between_perpendiculars_m, hull.length_waterline_m,
        )  # fmt: skip
        return next((length for length in lengths if length is not None), None)

    @property
    def min_under_keel_clearance(self) -> float:
        """Least under-keel clearance of the ship file [m]; 0 if it gives none."""
        return self.file.limits.min_under_keel_clearance_m

    @property
    def specific_fuel_consumption(self) -> float:
        """Specific fuel consumption of the ship file [kg/J]; NaN if it gives none."""
        return known_speed_fuel.given_specific_consumption(self.file.engine)

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
        return known_speed_fuel.hotel_power(self.file.engine)

    @property
    def waiting_fuel_rate(self) -> float:
        """Fuel rate at anchor [kg/s]: that of the hotel load; 0 if the ship file gives none."""
        return known_speed_fuel.hotel_load_fuel_rate(self.file.engine)
