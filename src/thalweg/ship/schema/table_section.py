"""The section ``table`` of a ship file: speeds with their fuel and power."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Annotated, Any, Final, Self

from pydantic import Field, model_validator

from thalweg.core.errors import InputError
from thalweg.core.units import DAY, HOUR, TONNE
from thalweg.ship.schema.section import Section
from thalweg.ship.schema.value_types import (
    Consumption,
    HourlyFuel,
    Number,
    OneOrMore,
    Power,
    Speed,
)

_DAILY: Final = DAY / HOUR / TONNE  # [t/day] of a kilogram per hour


class TableSection(Section):
    """Columns over speed; in a file also given as rows."""

    speed_kn: Annotated[tuple[Speed, ...], OneOrMore] | None = None
    fuel_t_per_day: Annotated[tuple[Consumption, ...], OneOrMore] | None = None
    fuel_kg_per_h: Annotated[tuple[HourlyFuel, ...], OneOrMore] | None = None
    power_kw: Annotated[tuple[Power, ...], OneOrMore] | None = None
    power_percent: (
        Annotated[tuple[Annotated[Number, Field(gt=0.0, le=120.0)], ...], OneOrMore] | None
    ) = None
    engines: Annotated[tuple[Annotated[Number, Field(ge=1.0, le=12.0)], ...], OneOrMore] | None = (
        None
    )

    @model_validator(mode="before")
    @classmethod
    def _rows_as_columns(cls, rows: Any) -> Any:
        """Turn a table given as a list of rows into columns."""
        if not isinstance(rows, Sequence) or isinstance(rows, str):
            return rows
        if not rows or not all(
            isinstance(row, Mapping) and row.keys() == rows[0].keys() for row in rows
        ):
            raise InputError(
                "The rows of 'table' do not all have the same keys.",
                f"A row holds keys among: {', '.join(cls.model_fields)}.",
                "Give every row the same keys, or give columns.",
                key="table",
            )
        return {name: [row[name] for row in rows] for name in rows[0]}

    @model_validator(mode="after")
    def _one_column_of_fuel(self) -> Self:
        """Refuse a fuel in two units."""
        if self.fuel_t_per_day is not None and self.fuel_kg_per_h is not None:
            raise InputError(
                "The fuel of the table is given twice, per day and per hour.",
                f"One of them is enough; 1 kg/h is {_DAILY:g} t a day.",
                "Keep fuel_t_per_day or fuel_kg_per_h.",
                key="table.fuel_kg_per_h",
            )
        return self

    @property
    def daily_fuel(self) -> tuple[float, ...] | None:
        """The fuel of the whole ship at each speed [t/day]; None where the file gives none."""
        if self.fuel_kg_per_h is None:
            return self.fuel_t_per_day
        return tuple(_DAILY * hourly for hourly in self.fuel_kg_per_h)

    @property
    def columns(self) -> dict[str, tuple[float, ...]]:
        """The columns that the file gives, by key; a fuel per hour as ``fuel_t_per_day``."""
        found = self.plain()
        if found.pop("fuel_kg_per_h", None) is not None:
            found["fuel_t_per_day"] = self.daily_fuel
        return found
