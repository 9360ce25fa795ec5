"""Distances for a draught where the depth layer is coarse, and where a strait is deep in part."""

from itertools import pairwise

import pytest

from tests.planning.distances import sea_distance

pytestmark = pytest.mark.slow


@pytest.mark.parametrize(
    ("start", "goal", "draught", "nm", "passed"),
    [
        ("Gothenburg", "Copenhagen", 12.5, 131.0, "Oresund: northern part"),
        ("Copenhagen", "Aarhus", 8.0, 107.0, "Oresund: northern part"),
        ("Gdansk", "Copenhagen", 9.0, 465.0, "Great Belt (Route T)"),  # Drogden has 8 m
        ("Riga", "Gdansk", 12.5, 330.0, "Irben Strait"),
    ],
)
def test_the_sound_is_shallow_at_drogden_and_irben_is_deep(start, goal, draught, nm, passed):
    way = sea_distance(start, goal, draught_m=draught)
    assert way.nm == pytest.approx(nm, rel=0.02)
    assert passed in way.straits


@pytest.mark.parametrize(
    ("start", "goal", "draught"),
    [
        ("Bangkok", "Ho Chi Minh City", 8.0),  # the layer has 3 m round Con Son
        ("Jakarta", "Surabaya", 8.0),  # ... and 3 m off Tanjung Karawang
        ("Prince Rupert", "Vancouver", 12.0),  # ... and 8 m in Brown Passage
        ("Nuevitas", "Caucedo", 8.0),  # edges of the graph beside the coast of Haiti
    ],
)
def test_a_draught_lengthens_a_way_little_where_ships_sail(start, goal, draught):
    without = sea_distance(start, goal).nm
    assert sea_distance(start, goal, draught_m=draught).nm < 1.05 * without


def test_a_detour_round_shoals_is_stated():
    way = sea_distance("Rio Grande", "Montevideo", draught_m=8.0)
    assert any("27 nm shorter, over that water" in note for note in way.notes)


@pytest.mark.parametrize(
    ("start", "goal", "draught", "closed", "miles"),
    [
        ("Hamburg", "Gdansk", 12.0, "Kiel Canal: the draught of 12 m is over the 9.5 m", 441),
        ("Rotterdam", "Mumbai", 21.0, "Suez Canal: the draught of 21 m is over the 20.12 m", 4383),
        (
            "Ras Tanura",
            "Yokohama",
            20.8,
            "Malacca: One Fathom Bank, Malacca-Singapore west, Singapore Main Strait and Horsburgh "
            "(Middle Channel): the draught of 20.8 m is over the 20.5 m",
            973,
        ),
    ],
)
def test_canals_and_passages_that_a_draught_closes_are_named(start, goal, draught, closed, miles):
    """The miles are those to the way of a ship that just fits; ways over shoals were compared."""
    (note,) = [
        one for one in sea_distance(start, goal, draught_m=draught).notes if " closed: " in one
    ]
    assert closed in note
    saved = float(note.split("about ")[1].split(" nm")[0].replace(",", ""))
    assert saved == pytest.approx(miles, abs=5.0)


@pytest.mark.parametrize(
    ("start", "goal", "draught", "closed", "shallow"),
    [
        ("Baltimore", "New York", 12.0, "the Chesapeake and Delaware Canal: the draught", 10.0),
        ("Surabaya", "Darwin", 8.0, "Passage closed: Surabaya: Eastern Channel: the draught", 6.5),
        ("Singapore", "Jakarta", 16.0, "Passage closed: Gelasa (Gaspar): the draught", 15.0),
    ],
)
def test_a_closed_way_is_as_much_shorter_as_its_note_states(start, goal, draught, closed, shallow):
    """Branches of approaches were not named, and passages by ways over shoals (Bangka 91 nm)."""
    way = sea_distance(start, goal, draught_m=draught)
    (note,) = [one for one in way.notes if " closed: " in one]
    assert closed in note
    saved = float(note.split("about ")[1].split(" nm")[0])
    assert sea_distance(start, goal, draught_m=shallow).nm == pytest.approx(
        way.nm - saved, rel=0.015
    )


@pytest.mark.parametrize("goal", ["Jakarta", "Fremantle"])
def test_a_closed_passage_that_saves_nothing_is_not_named(goal):
    """Bangka: 28 and 48 nm shorter over shoals, where a ship of 8 m sails by Gelasa as well."""
    notes = sea_distance("Singapore", goal, draught_m=12.0).notes
    assert not any("Bangka" in note for note in notes)


def test_a_way_far_round_has_one_reason():
    """With the Kiel Canal named, the note on narrow channels that no table has adds nothing."""
    notes = sea_distance("Kiel", "Hamburg", draught_m=12.0).notes
    assert sum("Kiel Canal: the draught of 12 m is over the 9.5 m" in note for note in notes) == 1
    assert not any("narrow channels" in note for note in notes)


def test_canals_that_are_avoided_or_elsewhere_are_not_named():
    avoided = sea_distance("Rotterdam", "Mumbai", draught_m=21.0, avoid=["suez"])
    elsewhere = sea_distance("Rotterdam", "New York", draught_m=17.0)
    for way in (avoided, elsewhere):
        assert not any(" closed: " in note for note in way.notes)


@pytest.mark.parametrize(
    ("start", "goal", "nm"),
    [("Bergen", "Alesund", 166.7), ("Wellington", "Nelson, NZ", 125.7), ("Osaka", "Nagoya", 236.4)],
)
def test_a_draught_does_not_shorten_a_way(start, goal, nm):
    """Ways without a draught were found by another search: 168.3 nm, and 167.0 with 9 m."""
    found = [sea_distance(start, goal, draught_m=draught).nm for draught in (None, 5.0, 8.0, 12.0)]
    assert found[0] == pytest.approx(nm, rel=0.005)
    for shallow, deep in pairwise(found):
        assert deep >= 0.999 * shallow


@pytest.mark.parametrize(
    ("start", "goal", "draughts", "nm"),
    [
        ("Kuwait", "Bandar Abbas", (None, 4.0, 12.0), 526.8),  # 524 through oil fields
        ("Sydney", "Brisbane", (None, 4.0, 12.0), 519.1),  # 519, 490 and 490
        ("Santos", "Buenos Aires", (None, 4.0), 989.8),  # 994 and 990
        ("Pori", "Stockholm", (4.0, 8.0), 199.0),  # by Furusund
        ("Thessaloniki", "Mersin", (None, 8.0), 725.6),  # by Skiathos; 719.6 east of the Sporades
        ("Constanta", "Split", (None, 8.0, 16.0), 1163.8),  # by Splitska Vrata
        ("Bergen", "Trondheim", (8.0, 12.0), 313.5),  # 317 and 314
    ],
)
def test_a_way_that_is_open_to_deep_ships_is_open_to_others(start, goal, draughts, nm):
    found = [sea_distance(start, goal, draught_m=draught).nm for draught in draughts]
    assert found[0] == pytest.approx(nm, rel=0.005)
    for shallow, deep in pairwise(found):
        assert deep >= 0.998 * shallow
