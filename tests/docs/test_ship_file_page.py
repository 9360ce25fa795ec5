"""The page on ship files names all keys and methods, and no others."""

import re
from pathlib import Path

import pytest

from thalweg.ship.file.part_builders import SPEED_LOSSES
from thalweg.ship.file.resistance_ship_builder import RUDDER_METHODS
from thalweg.ship.methods.added_resistance.wind_resistance import BLENDERMANN, ITTC_CURVES
from thalweg.ship.methods.engine.specific_consumption import BASE_SFOC
from thalweg.ship.models.added_resistance_model import WAVE_METHODS, WIND_METHODS
from thalweg.ship.models.calm_water_model import (
    CALM_WATER_METHODS,
    FRICTION_LINES,
    SHALLOW_WATER_METHODS,
    STERN_SHAPES,
)
from thalweg.ship.models.propulsion_model import PROPULSION_METHODS
from thalweg.ship.schema.ship_schema import ShipFile

PAGE = (Path(__file__).parents[2] / "docs" / "howto" / "ship_file.md").read_text(encoding="utf-8")
ROWS = {
    key: cells[1]
    for cells in re.findall(r"^\| (.+?) \| (.+) \|$", PAGE, flags=re.MULTILINE)
    for key in re.findall(r"`([a-z0-9_]+)`", cells[0])
}
NAMES = {
    "calm_water": {*CALM_WATER_METHODS, "table", "cubic", "none"},
    "waves": {*WAVE_METHODS, "none"},
    "wind": {*WIND_METHODS, "none"},
    "shallow_water": set(SHALLOW_WATER_METHODS),
    "friction": set(FRICTION_LINES),
    "propulsion": set(PROPULSION_METHODS),
    "speed_loss": set(SPEED_LOSSES),
    "wind_type": {*BLENDERMANN, *ITTC_CURVES, "blendermann_1994", "ittc", "iso_15016"},
    "rudder": set(RUDDER_METHODS),
}


def test_every_key_is_on_the_page_and_no_other():
    schema = ShipFile.model_json_schema()
    sections = {name.removesuffix("Section").lower() for name in schema["$defs"]}
    keys = {key for section in schema["$defs"].values() for key in section["properties"]}
    described = set(ROWS) | {"name", "description", "sources"}
    assert described - {"table"} == keys | set(schema["properties"]) - sections


@pytest.mark.parametrize("key", NAMES)
def test_every_method_is_on_the_page_and_no_other(key):
    assert set(re.findall(r"`([a-z0-9_]+)`", ROWS[key])) == NAMES[key]


def test_the_curves_of_each_wind_method_are_its_own():
    by_method = ROWS["wind_type"].split("; ")
    for text, names in zip(by_method, (BLENDERMANN, ITTC_CURVES), strict=True):
        assert set(re.findall(r"`([a-z_]+)`", text.partition(": ")[2])) == set(names)


def test_engines_and_sterns_are_on_the_page():
    (engines,) = re.findall(r"^\| `type` \| (`slow.+) \|$", PAGE, flags=re.MULTILINE)
    assert {engine for engine, _ in BASE_SFOC} == set(re.findall(r"`([a-z_]+)`", engines))
    sterns = re.findall(r"`([a-z]+)` \((-?\d+)\)", ROWS["stern_shape"])
    assert {word: float(value) for word, value in sterns}.items() <= dict(STERN_SHAPES).items()
