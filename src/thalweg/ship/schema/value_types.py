"""Types of the values in a ship file: how each is read, and the range it may have."""

from __future__ import annotations

import math
import re
from numbers import Real
from typing import Annotated, Any

from pydantic import BeforeValidator, Field, PlainSerializer
from pydantic_core import PydanticCustomError

from thalweg.core.errors import unknown_name_error
from thalweg.core.limits import DEEPEST_DRAUGHT

STERN_SHAPE_NAMES = ("pram", "v", "v_shaped", "normal", "u", "u_shaped")


def wrong_value(wanted: str) -> PydanticCustomError:
    """Return the error of a value that is not what its key needs."""
    return PydanticCustomError("wrong_value", "must be {wanted}", {"wanted": wanted})


def as_number(value: Any) -> float:
    """Return a finite float; text that holds a number is accepted, true and false are not."""
    if isinstance(value, bool) or not isinstance(value, (Real, str)):
        raise wrong_value("a number")
    try:
        number = float(value)
    except (ValueError, OverflowError):
        raise wrong_value("a number") from None
    if not math.isfinite(number):
        raise wrong_value("a finite number")
    return number


def as_whole_number(value: Any) -> int:
    """Return a whole number."""
    number = as_number(value)
    if number != round(number):
        raise wrong_value("a whole number")
    return int(number)


def as_text(value: Any) -> str:
    """Return text that is not blank."""
    if not isinstance(value, str) or not value.strip():
        raise wrong_value("text")
    return value


def as_texts(value: Any) -> tuple[str, ...]:
    """Return one text or a list of texts as a tuple."""
    many = value if isinstance(value, (list, tuple)) else [value]
    if not all(isinstance(one, str) for one in many):
        raise wrong_value("text, or a list of texts")
    return tuple(many)


def as_list(value: Any) -> tuple[Any, ...]:
    """Return one number or a list of numbers as a tuple with at least one element."""
    many = tuple(value) if isinstance(value, (list, tuple)) else (value,)
    if not many:
        raise wrong_value("at least one number")
    return many


def as_flag(value: Any) -> bool:
    """Return true or false; other values are refused."""
    if not isinstance(value, bool):
        raise wrong_value("true or false")
    return value


def as_word(value: Any) -> str:
    """Return a choice in lower case, with underscores for spaces and hyphens."""
    return as_text(value).strip().casefold().replace("-", "_").replace(" ", "_")


def as_currency(value: Any) -> str:
    """Return the code of a currency, three capital letters (ISO 4217)."""
    code = as_text(value).strip().upper()
    if not re.fullmatch("[A-Z]{3}", code):
        raise wrong_value("a code of three letters (ISO 4217), such as USD or EUR")
    return code


def as_stern_shape(value: Any) -> str | float:
    """Return the name of a stern shape, or Holtrop's coefficient C_stern (-25 to 10)."""
    if isinstance(value, str):
        word = as_word(value)
        if word not in STERN_SHAPE_NAMES:
            raise unknown_name_error("hull.stern_shape", value, STERN_SHAPE_NAMES)
        return word
    number = as_number(value)
    if not -25.0 <= number <= 10.0:
        raise wrong_value("at least -25 and at most 10")
    return number


Number = Annotated[float, BeforeValidator(as_number)]
WholeNumber = Annotated[
    int, BeforeValidator(as_whole_number), PlainSerializer(float, return_type=float)
]
Text = Annotated[str, BeforeValidator(as_text)]
Texts = Annotated[tuple[str, ...], BeforeValidator(as_texts)]
Flag = Annotated[bool, BeforeValidator(as_flag)]
Word = BeforeValidator(as_word)
Currency = Annotated[str, BeforeValidator(as_currency)]
OneOrMore = BeforeValidator(as_list)
SternShape = Annotated[str | float, BeforeValidator(as_stern_shape)]

Length = Annotated[Number, Field(gt=0.0, le=500.0)]  #: [m]
Draught = Annotated[Number, Field(gt=0.0, le=DEEPEST_DRAUGHT)]  #: [m]
BulbHeight = Annotated[Number, Field(ge=0.0, le=DEEPEST_DRAUGHT)]  #: centre over the keel [m]
SuperstructureHeight = Annotated[Number, Field(gt=0.0, le=100.0)]  #: [m]
#: Name of a place or a task on board
PlaceName = Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9 _-]{0,39}$")]
Position = Annotated[Number, Field(ge=-300.0, le=300.0)]  #: ahead of midship [m]
SmallArea = Annotated[Number, Field(ge=0.0, le=500.0)]  #: [m2]
LateralArea = Annotated[Number, Field(gt=0.0, le=2e4)]  #: [m2]
Volume = Annotated[Number, Field(gt=0.0, le=1e6)]  #: [m3], or a mass [t]
Coefficient = Annotated[Number, Field(gt=0.0, le=1.0)]  #: form coefficient or efficiency
HullInteraction = Annotated[Number, Field(ge=-0.5, le=0.9)]  #: wake fraction, thrust deduction
AppendageCount = Annotated[WholeNumber, Field(ge=0, le=8)]
Power = Annotated[Number, Field(gt=0.0, le=2e5)]  #: [kW]
HotelLoad = Annotated[Number, Field(ge=0.0, le=1e5)]  #: [kW]
Consumption = Annotated[Number, Field(gt=0.0, le=1000.0)]  #: [g/kWh] or [t/day]
HourlyFuel = Annotated[Number, Field(gt=0.0, le=1e6 / 24.0)]  #: [kg/h], up to 1000 t/day
EngineLoad = Annotated[Number, Field(gt=0.0, le=1.5)]  #: share of the rating
Speed = Annotated[Number, Field(gt=0.0, le=80.0)]  #: [kn]
Percent = Annotated[Number, Field(gt=0.0, le=100.0)]
FuelPrice = Annotated[Number, Field(ge=0.0, le=1e5)]  #: per tonne
TimePrice = Annotated[Number, Field(ge=0.0, le=1e9)]  #: per day or per week
WaveHeight = Annotated[Number, Field(ge=0.0, le=40.0)]  #: [m]
