"""`ShipFile`: the contents of a ship file as typed sections; every key with its kind and range."""

from __future__ import annotations

import math
from functools import cache
from typing import Annotated, Any, Literal, Self

from pydantic import Field, ValidationError

from thalweg.core.errors import InputError
from thalweg.ship.methods.engine.specific_consumption import GRAM_PER_KILOWATT_HOUR
from thalweg.ship.schema.schema_errors import input_error
from thalweg.ship.schema.section import Section
from thalweg.ship.schema.table_section import TableSection
from thalweg.ship.schema.value_types import (
    AppendageCount,
    BulbHeight,
    Coefficient,
    Consumption,
    Currency,
    Draught,
    EngineLoad,
    Flag,
    FuelPrice,
    HotelLoad,
    HullInteraction,
    LateralArea,
    Length,
    Number,
    OneOrMore,
    Percent,
    PlaceName,
    Position,
    Power,
    SmallArea,
    Speed,
    SternShape,
    SuperstructureHeight,
    Text,
    Texts,
    TimePrice,
    Volume,
    WaveHeight,
    WholeNumber,
    Word,
)


class HullSection(Section):
    """Particulars of the hull; `thalweg.ship.hull` completes them."""

    length_overall_m: Length | None = None
    length_waterline_m: Length | None = None
    length_between_perpendiculars_m: Length | None = None
    length_over_surface_m: Length | None = None
    length_bow_m: Length | None = None
    breadth_m: Annotated[Number, Field(gt=0.0, le=100.0)] | None = None
    depth_m: Annotated[Number, Field(gt=0.0, le=60.0)] | None = None
    draught_m: Draught | None = None
    draught_fore_m: Draught | None = None
    draught_aft_m: Draught | None = None
    air_draught_m: Annotated[Number, Field(gt=0.0, le=120.0)] | None = None
    displacement_m3: Volume | None = None
    displacement_t: Volume | None = None
    deadweight_t: Volume | None = None
    gross_tonnage: Volume | None = None
    suez_net_tonnage: Volume | None = None
    panama_net_tonnage: Volume | None = None
    block_coefficient: Coefficient | None = None
    midship_coefficient: Coefficient | None = None
    prismatic_coefficient: Coefficient | None = None
    waterplane_coefficient: Coefficient | None = None
    lcb_percent: Annotated[Number, Field(ge=-10.0, le=10.0)] | None = None
    wetted_surface_m2: Annotated[Number, Field(gt=0.0, le=1e5)] | None = None
    bulb_area_m2: SmallArea | None = None
    bulb_centre_height_m: BulbHeight | None = None
    transom_area_m2: Annotated[Number, Field(ge=0.0, le=2000.0)] | None = None
    appendage_area_m2: Annotated[Number, Field(ge=0.0, le=5000.0)] | None = None
    appendage_factor: Annotated[Number, Field(ge=1.0, le=10.0)] | None = None
    stern_shape: SternShape | None = None
    half_entrance_angle_deg: Annotated[Number, Field(gt=0.0, le=90.0)] | None = None
    length_entrance_m: Length | None = None
    length_run_m: Length | None = None
    frontal_area_m2: Annotated[Number, Field(gt=0.0, le=1e4)] | None = None
    lateral_area_m2: LateralArea | None = None
    superstructure_lateral_area_m2: Annotated[Number, Field(ge=0.0, le=2e4)] | None = None
    superstructure_height_m: SuperstructureHeight | None = None
    lateral_centre_height_m: SuperstructureHeight | None = None
    lateral_centre_offset_m: Annotated[Number, Field(ge=-250.0, le=250.0)] | None = None
    rudder_area_m2: SmallArea | None = None
    pitch_gyration: Annotated[Number, Field(gt=0.0, le=0.5)] | None = None
    metacentric_height_m: Annotated[Number, Field(gt=0.0, le=20.0)] | None = None
    roll_period_s: Annotated[Number, Field(gt=0.0, le=100.0)] | None = None
    roll_damping: Annotated[Number, Field(gt=0.0, le=0.5)] | None = None
    rudders: Annotated[WholeNumber, Field(ge=0, le=4)] | None = None
    brackets: AppendageCount | None = None
    bosses: AppendageCount | None = None
    thrusters: AppendageCount | None = None
    type: Text | None = None

    @property
    def length_m(self) -> float | None:
        """Length overall, or between perpendiculars or at the waterline [m]; None if not given."""
        lengths = (
            self.length_overall_m, self.length_between_perpendiculars_m, self.length_waterline_m,
        )  # fmt: skip
        return next((length for length in lengths if length is not None), None)


class PropulsionSection(Section):
    """Propellers, and efficiencies from thrust to the engines."""

    propellers: Annotated[WholeNumber, Field(ge=1, le=4)] = 1
    propeller_diameter_m: Annotated[Number, Field(gt=0.0, le=15.0)] | None = None
    propeller_pitch_ratio: Annotated[Number, Field(ge=0.3, le=2.0)] | None = None
    propeller_blades: Annotated[WholeNumber, Field(ge=2, le=7)] | None = None
    propeller_area_ratio: Annotated[Number, Field(ge=0.2, le=1.5)] | None = None
    propeller_rpm: Annotated[Number, Field(gt=0.0, le=2000.0)] | None = None
    wake_fraction: HullInteraction | None = None
    thrust_deduction: HullInteraction | None = None
    open_water_efficiency: Coefficient | None = None
    relative_rotative_efficiency: Annotated[Number, Field(gt=0.0, le=1.3)] | None = None
    hull_efficiency: Annotated[Number, Field(gt=0.0, le=2.0)] | None = None
    shaft_efficiency: Coefficient | None = None
    gear_efficiency: Coefficient | None = None
    propulsive_efficiency: Annotated[Number, Field(gt=0.0, le=1.5)] | None = None


class EngineSection(Section):
    """Engines, their specific consumption, and the hotel load, which burns at sea and at anchor.

    Fuel that is made from power gets that of the hotel load on top; fuel that is given
    (``fuel.reference_t_per_day``, ``table.fuel_t_per_day``) contains it.
    """

    count: Annotated[WholeNumber, Field(ge=1, le=12)] = 1
    type: Text | None = None
    power_kw: Power | None = None
    rpm: Annotated[Number, Field(gt=0.0, le=3000.0)] | None = None
    sfoc_g_per_kwh: Consumption | None = None
    sfoc_load: Annotated[tuple[EngineLoad, ...], OneOrMore] = ()
    sfoc_curve_g_per_kwh: Annotated[tuple[Consumption, ...], OneOrMore] = ()
    least_load: Annotated[Number, Field(ge=0.0, le=1.0)] = 0.0
    largest_load: Annotated[Number, Field(gt=0.0, le=1.1)] = 1.0
    hotel_load_kw: HotelLoad = 0.0
    hotel_sfoc_g_per_kwh: Consumption = 195.0
    reference_speed_kn: Speed | None = None
    reference_power_kw: Power | None = None
    sea_margin_percent: Annotated[Number, Field(ge=0.0, le=100.0)] = 0.0
    year: Annotated[Number, Field(ge=1900, le=2100)] = 2010

    @property
    def hotel_power(self) -> float:
        """Hotel load [W]; 0 if not given."""
        return 1000.0 * self.hotel_load_kw

    @property
    def hotel_fuel_rate(self) -> float:
        """Fuel rate of the hotel load [kg/s]; 0 if not given."""
        return self.hotel_power * self.hotel_sfoc_g_per_kwh / 3.6e9

    @property
    def specific_consumption(self) -> float:
        """Specific fuel consumption [kg/J]; NaN if not given."""
        given = self.sfoc_g_per_kwh
        return math.nan if given is None else given * GRAM_PER_KILOWATT_HOUR


class FuelSection(Section):
    """Fuels outside and inside emission control areas, their prices, and the fuel of a day at sea.

    ``reference_t_per_day`` is the whole ship's: propulsion and hotel load. ``usd_rate`` is the
    price of a US dollar in the currency of the prices: canal dues are in dollars.
    """

    type: Text | None = None
    eca_type: Text | None = None
    reference_t_per_day: Consumption | None = None
    carbon_factor: Annotated[Number, Field(ge=0.0, le=5.0)] | None = None
    price_per_t: FuelPrice | None = None
    eca_price_per_t: FuelPrice | None = None
    eca_price_factor: Annotated[Number, Field(gt=0.0, le=100.0)] = 1.0
    currency: Currency | None = None
    usd_rate: Annotated[Number, Field(gt=0.0, le=1e6)] | None = None


class LoadingSection(Section):
    """Draught, displacement and speeds of the full and the empty ship."""

    draught_full_m: Draught | None = None
    draught_empty_m: Draught | None = None
    load_factor: Annotated[Number, Field(ge=0.0, le=1.0)] = 1.0
    condition: Annotated[Literal["loaded", "normal", "ballast"], Word] = "loaded"
    speeds_full_kn: Annotated[tuple[Speed, ...], OneOrMore] | None = None
    speeds_empty_kn: Annotated[tuple[Speed, ...], OneOrMore] | None = None
    weight_full_t: Volume | None = None
    weight_empty_t: Volume | None = None
    displacement_full_m3: Volume | None = None
    displacement_empty_m3: Volume | None = None
    capacity_m3: Volume | None = None


LEAST_APPROACH_KN, GREATEST_APPROACH_KN = 2.0, 25.0  #: of the speed in approaches [kn]
_ApproachSpeed = Annotated[Number, Field(ge=LEAST_APPROACH_KN, le=GREATEST_APPROACH_KN)]


class LimitsSection(Section):
    """Waves, wind, speed in approaches, clearance and motions that the ship must keep to."""

    max_significant_wave_height_m: Annotated[Number, Field(gt=0.0, le=40.0)] | None = None
    max_wind_speed_kn: Annotated[Number, Field(gt=0.0, le=300.0)] | None = None
    max_wind_speed_m_s: Annotated[Number, Field(gt=0.0, le=150.0)] | None = None
    min_under_keel_clearance_m: Annotated[Number, Field(ge=0.0, le=50.0)] = 0.0
    approach_speed_kn: _ApproachSpeed = 10.0
    msc_circ_1228: Texts = ()
    danger_from_wave_height_m: WaveHeight | None = None
    roll_period_tolerance: Annotated[Number, Field(gt=0.0, le=0.5)] = 0.1
    max_vertical_acceleration_m_s2: Annotated[Number, Field(gt=0.0, le=20.0)] | None = None
    acceleration_at_m: Position | None = None
    max_motion_sickness_percent: Percent | None = None
    motion_sickness_hours: Annotated[Number, Field(gt=0.0, le=24.0)] = 2.0
    motion_sickness_at_m: Position = 0.0


class TaskSection(Section):
    """A task on board, and the root mean squares of motions up to which it can be done."""

    place: Text
    max_vertical_acceleration_m_s2: Annotated[Number, Field(gt=0.0, le=20.0)] | None = None
    max_vertical_velocity_m_s: Annotated[Number, Field(gt=0.0, le=20.0)] | None = None
    max_pitch_deg: Annotated[Number, Field(gt=0.0, le=45.0)] | None = None
    max_roll_deg: Annotated[Number, Field(gt=0.0, le=45.0)] | None = None


class CostsSection(Section):
    """Prices of time, and of speed where fuel has no price."""

    hire_per_day: TimePrice | None = None
    per_week: TimePrice | None = None
    per_second_per_cubed_speed: Annotated[Number, Field(ge=0.0, le=1e6)] | None = None
    co2_g_per_second_per_cubed_speed: Annotated[Number, Field(ge=0.0, le=1e6)] | None = None
    currency: Currency | None = None


class WaterSection(Section):
    """Properties of the water; the sea at 15 degC where a key is not given."""

    density_kg_m3: Annotated[Number, Field(ge=990.0, le=1040.0)] | None = None
    kinematic_viscosity_m2_s: Annotated[Number, Field(ge=6e-7, le=2.2e-6)] | None = None


class ModelsSection(Section):
    """Methods for each part of the ship's performance; "none" leaves the part out."""

    calm_water: Text | None = None
    waves: Text = "none"
    wind: Text = "none"
    shallow_water: Text = "none"
    speed_loss: Text = "none"
    propulsion: Text = "efficiencies"
    friction: Text = "ittc_1957"
    squat: Text = "none"
    rudder: Text = "none"
    wind_type: Text = ""
    largest_wave_height_m: Annotated[Number, Field(gt=0.0, le=40.0)] | None = None
    largest_wind_speed_m_s: Annotated[Number, Field(gt=0.0, le=150.0)] | None = None
    nothing_lost_in_calm: Flag = False
    kwon_sign: Annotated[Literal["plus", "printed", "minus"], Word] = "plus"
    kwon_classes: Flag = False
    wave_push: Flag = False
    correlation_area: Annotated[Literal["hull_and_appendages", "hull"], Word] = (
        "hull_and_appendages"
    )
    kwon_ship_type: Annotated[Literal["other", "container"], Word] = "other"


class ShipFile(Section):
    """The contents of a ship file, checked.

    Keys that the file does not give are None or have the value that every method takes for them;
    ``model_fields_set`` of a section holds the keys that the file gives.

    Examples
    --------
    >>> file = ShipFile.of({"name": "barge", "hull": {"breadth_m": 11}, "speeds_kn": 8})
    >>> file.hull.breadth_m, file.speeds_kn, file.models.waves
    (11.0, (8.0,), 'none')
    """

    name: Text
    description: Text = ""
    sources: Texts = ()
    speeds_kn: Annotated[tuple[Speed, ...], OneOrMore] | None = None
    powers_kw: Annotated[tuple[Power, ...], OneOrMore] | None = None
    hull: HullSection = Field(default_factory=HullSection)
    propulsion: PropulsionSection = Field(default_factory=PropulsionSection)
    engine: EngineSection = Field(default_factory=EngineSection)
    fuel: FuelSection = Field(default_factory=FuelSection)
    loading: LoadingSection = Field(default_factory=LoadingSection)
    limits: LimitsSection = Field(default_factory=LimitsSection)
    costs: CostsSection = Field(default_factory=CostsSection)
    water: WaterSection = Field(default_factory=WaterSection)
    table: TableSection | None = None
    models: ModelsSection = Field(default_factory=ModelsSection)
    places: dict[PlaceName, Position] = Field(default_factory=dict)
    tasks: dict[PlaceName, TaskSection] = Field(default_factory=dict)

    @classmethod
    def of(cls, data: Any, source: str = "ship") -> Self:
        """Check plain data against the keys that a ship file may hold.

        Parameters
        ----------
        data : As read from YAML.
        source : Name of the data in errors.

        Raises
        ------
        InputError
            For unknown keys (with near matches), wrong kinds, numbers that are NaN or out of range.
        """
        try:
            return cls.model_validate(data)
        except ValidationError as problem:
            raise input_error(problem, cls, data, source) from None

    def check_one_kind_of_order(self) -> None:
        """Refuse a file that gives both powers and speeds."""
        if self.powers_kw is not None and self.speeds_kn is not None:
            raise InputError(
                "The ship file gives both powers_kw and speeds_kn.",
                "Orders are either powers or speeds.",
                "Leave one of them out.",
                key="powers_kw",
            )

    @property
    def is_empty(self) -> bool:
        """Whether the ship was made without a ship file."""
        return self.model_fields_set <= {"name"}


@cache
def empty_ship_file() -> ShipFile:
    """Return the file of a ship that was made without one."""
    return ShipFile(name="ship")
