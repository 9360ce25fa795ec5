"""Properties of Kwon's speed loss."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from thalweg.core.errors import InputError
from thalweg.ship import Conditions, Ship
from thalweg.ship.methods.speed_loss import (
    GREATEST_LOSS,
    beaufort_number,
    kwon_form_coefficient,
    kwon_speed_coefficient,
    kwon_speed_loss,
)
from thalweg.ship.ship_assumptions import stated_assumptions

winds = st.floats(0.0, 60.0)
angles = st.floats(0.0, np.pi)
blocks = st.floats(0.55, 0.85)
volumes = st.floats(5e3, 4e5)
loadings = st.sampled_from(["loaded", "normal", "ballast"])


def _loss(wind, angle, block=0.8, volume=27150.0, **more):
    options = {"speed": 7.0, "length": 152.9, **more}
    return float(
        kwon_speed_loss(wind, angle, block_coefficient=block, displacement_volume=volume, **options)
    )


@given(angles, blocks, volumes, loadings)
def test_no_wind_gives_no_speed_loss(angle, block, volume, loading):
    assert _loss(0.0, angle, block, volume, loading=loading) == 0.0


@given(winds, angles, blocks, volumes, loadings)
def test_the_loss_is_a_share_and_greatest_from_ahead(wind, angle, block, volume, loading):
    loss = _loss(wind, angle, block, volume, loading=loading)
    assert 0.0 <= loss <= GREATEST_LOSS
    assert loss <= _loss(wind, 0.0, block, volume, loading=loading) + 1e-12


@pytest.mark.parametrize("block", [0.55, 0.6, 0.65, 0.7])
def test_a_fast_ship_loses_speed_too(block):
    """C_U of fine ships fell to zero at Froude numbers of 0.39 and more: 16 kn in any weather."""
    at = {"block": block, "volume": 20e3, "length": 100.0}
    edge = 0.3 * np.sqrt(9.80665 * 100.0)
    assert _loss(10.0, 0.0, **at, speed=edge) > 0.02
    assert _loss(10.0, 0.0, **at, speed=2.0 * edge) == _loss(10.0, 0.0, **at, speed=edge)
    assert _loss(10.0, 0.0, **at, speed=0.9 * edge) > _loss(10.0, 0.0, **at, speed=edge)


def test_a_froude_number_out_of_range_is_noted():
    """10 kn and 17 kn at 140 m are Froude numbers of 0.139 and 0.236; 30 m makes it 0.51."""
    loss = _ship("other").model.loss
    weather = Conditions({"wind_speed": 5.0, "wind_angle": 0.0}, load_factor=1.0)
    assert not [note for note in loss.notes(weather, 8.7) if "Froude" in str(note)]
    (note,) = [n for n in replace(loss, length=30.0).notes(weather, 8.7) if "Froude" in str(n)]
    assert "0.5073" in str(note) or "0.507" in str(note)


def _ship(kind, **models) -> Ship:
    return Ship.from_dict(
        {
            "name": "x",
            "speeds_kn": [10, 17],
            "hull": {
                "type": kind, "length_between_perpendiculars_m": 140.0, "breadth_m": 22.0,
                "draught_m": 6.0, "block_coefficient": 0.62, "displacement_m3": 11458.0,
            },
            "models": {"speed_loss": "kwon_2008", **models},
        }
    )  # fmt: skip


@pytest.mark.parametrize(
    ("kind", "given_form", "form", "noted"),
    [
        ("Container ship", {}, "container", False),
        ("container ship", {"kwon_ship_type": "other"}, "other", False),
        ("bulk carrier", {}, "other", False),
        ("ro-ro cargo ship", {}, "other", True),
        ("ro-ro cargo ship", {"kwon_ship_type": "other"}, "other", False),
        ("ro-ro cargo ship", {"kwon_ship_type": "container"}, "container", False),
        ("tanker", {"kwon_ship_type": "container"}, "container", True),
    ],
)
def test_the_form_follows_the_type_of_the_ship_and_a_misfit_is_noted(kind, given_form, form, noted):
    ship = _ship(kind, **given_form)
    assert ship.model.loss.ship_type == form
    notes = stated_assumptions(ship)
    assert len(notes) == int(noted), notes
    if noted:
        assert f"Kwon's form '{form}' is used for a {kind}" in notes[0]
        assert "falls by 30 % by the form 'other'" in notes[0]
        assert "6 % by 'container'" in notes[0]


def test_one_weather_for_many_speeds_is_that_weather_for_each():
    speeds = np.array([5.0, 6.0, 7.0, 7.5, 8.0])
    assert kwon_speed_loss(
        14.0, 0.4, speed=speeds, length=152.9, block_coefficient=0.8, displacement_volume=27150.0
    ) == pytest.approx([_loss(14.0, 0.4, speed=speed) for speed in speeds])
    many = kwon_speed_loss(
        np.array([[8.0], [14.0]]),
        0.4,
        speed=speeds,
        length=152.9,
        block_coefficient=0.8,
        displacement_volume=27150.0,
    )
    assert many.shape == (2, 5)
    assert many[1, 2] == pytest.approx(_loss(14.0, 0.4))


@given(winds, winds, angles, blocks, volumes)
def test_more_wind_never_costs_less(first, second, angle, block, volume):
    low, high = sorted((first, second))
    assert _loss(low, angle, block, volume) <= _loss(high, angle, block, volume) + 1e-9


@given(winds, angles)
def test_the_loss_has_no_steps(wind, angle):
    near = _loss(wind + 1e-6, min(angle + 1e-6, np.pi))
    assert near == pytest.approx(_loss(wind, angle), abs=1e-4)


@given(winds, angles, volumes, st.floats(1.0, 2.0))
def test_a_larger_ship_loses_less(wind, angle, volume, growth):
    large = _loss(wind, angle, volume=volume * growth)
    assert large <= _loss(wind, angle, volume=volume) + 1e-9


@given(winds, angles)
def test_arrays_of_displacement_answer_as_numbers_do(wind, angle):
    volumes_ = np.array([2e4, 5e4, 2e4])
    found = kwon_speed_loss(
        wind, angle, speed=7.0, length=150.0, block_coefficient=0.8, displacement_volume=volumes_
    )
    expected = [_loss(wind, angle, volume=v, length=150.0) for v in volumes_]
    assert found == pytest.approx(expected, abs=1e-9)


def test_a_hurricane_on_the_beam_has_no_loss_only_as_printed():
    printed = {"hold": False, "classes": True}
    assert _loss(40.0, np.pi / 2, volume=3e5, **printed) == 0.0
    assert _loss(40.0, np.pi / 2, volume=3e5) > 0.05


def test_printed_sign_would_push_a_full_ship_forward_and_is_clipped():
    fast = 15.2 * 1852 / 3600
    assert _loss(12.0, 0.0, speed=fast, sign="printed") == 0.0
    assert _loss(12.0, 0.0, speed=fast) > 0.1


def test_unknown_stays_unknown():
    assert np.isnan(_loss(np.nan, 0.0)) and np.isnan(_loss(5.0, np.nan))
    assert np.isnan(_loss(12.0, np.nan, classes=True))  # was that of a following sea
    assert _loss(12.0, 0.0, classes=True) > 0.1
    assert np.isnan(beaufort_number(np.nan, classes=True))


@pytest.mark.parametrize(
    "call",
    [
        lambda: kwon_speed_coefficient(0.2, block_coefficient=0.8, loading="full"),
        lambda: kwon_speed_coefficient(0.2, block_coefficient=0.8, sign="minus"),
        lambda: kwon_form_coefficient(4.0, displacement_volume=1e4, ship_type="tanker"),
    ],
)
def test_unknown_choices_are_refused(call):
    with pytest.raises(InputError, match="There is no choice"):
        call()
