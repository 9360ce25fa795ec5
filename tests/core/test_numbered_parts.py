"""Parts of legs are numbered from 0 in each leg."""

from thalweg.core.arrays.numbered_parts import numbered_parts


def test_every_part_has_its_leg_and_its_number_in_it():
    leg, number = numbered_parts([2, 0, 3])
    assert leg.tolist() == [0, 0, 2, 2, 2]
    assert number.tolist() == [0, 1, 0, 1, 2]


def test_no_legs_have_no_parts():
    assert [one.tolist() for one in numbered_parts([])] == [[], []]
