"""Numbers of ship files that are impossible or unusual."""

import pytest

from thalweg import InputError, Ship
from thalweg.core.units import KNOT
from thalweg.ship import library_names
from thalweg.ship.methods.carbon_intensity import SHIP_TYPES
from thalweg.ship.schema.ship_schema import ShipFile
from thalweg.ship.schema.unusual_numbers import check_possible_numbers, unusual_numbers
from thalweg.ship.ship_assumptions import stated_assumptions

HULL = {
    "length_between_perpendiculars_m": 142.5,
    "breadth_m": 23.0,
    "draught_m": 5.8,
    "block_coefficient": 0.62,
}


def ship_file(**sections):
    data = {
        "name": "ro-ro",
        "hull": HULL,
        "speeds_kn": [14, 18],
        "fuel": {"reference_t_per_day": 32},
        "engine": {"reference_speed_kn": 18},
    }
    for name, section in sections.items():
        changed = {**data[name], **section} if isinstance(section, dict) else section
        data[name] = (
            {k: v for k, v in changed.items() if v is not None}
            if isinstance(changed, dict)
            else changed
        )
    return ShipFile.of(data)


@pytest.mark.parametrize("name", library_names())
def test_no_ship_of_the_library_is_unusual(name):
    assert unusual_numbers(Ship.load(name).file) == []


def test_an_ordinary_ship_is_not_unusual():
    assert unusual_numbers(ship_file()) == []


@pytest.mark.parametrize(
    ("sections", "text"),
    [
        ({"hull": {"draught_m": 23.5}}, "breadth of 23 m is 0.979 times the draught of 23.5 m"),
        ({"hull": {"breadth_m": 75.0}}, "142.5 m is 1.9 times the breadth of 75 m; 2.5 to 12"),
        ({"hull": {"length_between_perpendiculars_m": 467.0}}, "no ship was longer than 460 m"),
        (
            {"hull": {"block_coefficient": None, "displacement_m3": 2000.0}},
            "a block coefficient of 0.105; 0.3 to 0.95",
        ),
        (
            {"hull": {"block_coefficient": 0.78}, "speeds_kn": [14, 28]},  # km/h
            "28 kn on a length of 142.5 m is a Froude number of 0.39; 0.05 to 0.33",
        ),
        ({"speeds_kn": [60]}, "60 kn on a length of 142.5 m is a Froude number of 0.83"),
        (
            {"engine": {"reference_power_kw": 50_000}},
            "32 t of fuel a day at 50000 kW are 27 g/kWh; 120 to 400",
        ),
        (
            {"engine": {"reference_power_kw": 9000, "sfoc_g_per_kwh": 240}},
            "9000 kW are 148 g/kWh, and engine.sfoc_g_per_kwh is 240; the fuel a day counts",
        ),
        ({"engine": {"sfoc_g_per_kwh": 900}}, "engine.sfoc_g_per_kwh is 900 g/kWh; 120 to 400"),
        ({"fuel": {"reference_t_per_day": 0.3}}, "is an Admiralty coefficient of"),
    ],
)
def test_unusual_numbers_are_named_with_the_usual_range(sections, text):
    notes = unusual_numbers(ship_file(**sections))
    assert any(text in note for note in notes), notes


@pytest.mark.parametrize(
    ("sections", "key"),
    [
        ({"hull": {"breadth_m": 175.0}}, "hull.breadth_m"),
        ({"hull": {"draught_m": 29.0, "breadth_m": 18.0}}, "hull.draught_m"),
        ({"engine": {"sfoc_g_per_kwh": 0.185}}, "engine.sfoc_g_per_kwh"),
        ({"engine": {"reference_power_kw": 8.5}}, "engine.reference_power_kw"),  # MW
        ({"engine": {"reference_power_kw": 8.5e6}}, "engine.reference_power_kw"),  # W
        ({"hull": {"length_overall_m": 141.0}}, "hull.length_overall_m"),
        ({"hull": {"deadweight_t": 13_000}}, "hull.deadweight_t"),  # she displaces 12,080 t
        ({"hull": {"deadweight_t": 8.5, "type": "general cargo ship"}}, "hull.deadweight_t"),
    ],
)
def test_impossible_numbers_are_refused(sections, key):
    with pytest.raises(InputError) as caught:
        check_possible_numbers(ship_file(**sections))
    assert caught.value.key == key if hasattr(caught.value, "key") else key in str(caught.value)


@pytest.mark.parametrize(
    "sections",
    [
        {"hull": {"length_overall_m": 142.5, "deadweight_t": 12_000}},
        {"hull": {"deadweight_t": 8.5, "type": "research vessel"}},
    ],
)
def test_particulars_that_some_ships_have_are_taken(sections):
    check_possible_numbers(ship_file(**sections))


def test_the_deadweight_is_that_of_the_laden_ship():
    hull = {**HULL, "deadweight_t": 13_000}
    for more in ({"condition": "ballast"}, {"draught_full_m": 7.0}, {"weight_full_t": 18_000}):
        data = {"name": "ro-ro", "speeds_kn": [14], "hull": hull, "loading": more}
        check_possible_numbers(ShipFile.of(data))


def test_powers_in_megawatts_are_refused_by_the_speed_that_they_give():
    given = Ship.load("jbc").file.plain()
    given.pop("speeds_kn", None)
    slow = Ship.from_dict({**given, "powers_kw": [600]}).speeds[0]
    assert 2.0 < slow / KNOT < 6.0
    with pytest.raises(InputError) as caught:
        Ship.from_dict({**given, "powers_kw": [4, 6]})
    words = str(caught.value)
    assert "at most 6 kW, a ship of 280 m makes 0.99 kn" in words and "6 MW are 6000" in words


@pytest.mark.parametrize(
    ("hull", "words"),
    [
        ({"draught_m": 48.6}, "48.6 feet are 14.81 m"),
        ({"length_between_perpendiculars_m": 768.0}, "768 feet are 234.1 m"),
        ({"depth_m": 10.0, "draught_m": 19.0}, "19 feet are 5.79 m"),
    ],
)
def test_lengths_that_may_be_feet_are_given_in_metres(hull, words):
    plain = {"name": "ro-ro", "speeds_kn": [14], "hull": {**HULL, **hull}}
    with pytest.raises(InputError, match=words):
        Ship.from_dict({**plain, "models": {"speed_loss": "kwon_2008"}})


def test_results_state_unusual_numbers():
    plain = ship_file(hull={"draught_m": 20.0}).plain()
    ship = Ship.from_dict({**plain, "models": {"speed_loss": "kwon_2008"}})
    assert any(note.startswith("Unusual ship: a breadth") for note in stated_assumptions(ship))


def test_one_missing_particular_is_it_and_several_are_them():
    given = {"name": "x", "speeds_kn": [10], "hull": HULL, "models": {"wind": "ittc"}}
    engine = {"reference_speed_kn": 10, "reference_power_kw": 3000}
    given["models"]["calm_water"], given["engine"] = "cubic", engine
    with pytest.raises(InputError, match=r"Add it, or choose wind: yu_2021"):
        Ship.from_dict(given)
    with pytest.raises(InputError, match=r"Add them, or choose"):
        Ship.from_dict({**given, "models": {**given["models"], "wind": "blendermann_1994"}})


@pytest.mark.parametrize("given", ["foo_ship", "banana"])
def test_a_type_of_ship_that_nobody_knows_is_refused_with_the_known_ones(given):
    data = {"name": "x", "speeds_kn": [12], "hull": {"draught_m": 6.0, "type": given}}
    with pytest.raises(InputError, match=r"general_cargo_ship.*dredg") as refused:
        Ship.from_dict(data)
    assert given in str(refused.value)


@pytest.mark.parametrize(
    "given", [*SHIP_TYPES, "Crude Oil Tanker", "research vessel", "Ro-Pax", "hopper dredger"]
)
def test_types_of_the_cii_and_words_for_others_are_taken(given):
    data = {"name": "x", "speeds_kn": [12], "hull": {"draught_m": 6.0, "type": given}}
    assert Ship.from_dict(data).file.hull.type == given
