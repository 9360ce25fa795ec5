"""Distances by sea against published ones, and their properties."""

import json

import numpy as np
import pytest

import thalweg
from tests.planning.distances import sea_distance
from thalweg.chart.depth.shoal_areas import SHOAL_AREAS
from thalweg.cli.distance_command import names_in_list
from thalweg.cli.main import main
from thalweg.core.errors import InputError, NoRouteError
from thalweg.core.geodesy import densify, distance
from thalweg.core.units import NAUTICAL_MILE
from thalweg.planning.request.size_closures import closed_and_open
from thalweg.planning.sea_distance import small_ship_distance
from thalweg.planning.seaways import world_chart
from thalweg.ship import Ship

# Distances [nm] as tables commonly quote them, to about 1 %: New York to Colombo is quoted from NGA
# Publication 151 (Distances Between Ports, 11th edition); the others are from general knowledge.
PUBLISHED = [
    ("Rotterdam", "New York", 3_310),
    ("Rotterdam", "Singapore", 8_288),
    ("New York", "Colombo", 8_604),
    ("Sydney, AU", "Auckland", 1_274),
    ("Santos", "Rotterdam", 5_430),
    ("Shanghai", "Los Angeles", 5_708),
    ("Gibraltar", "Port Said", 1_920),
]


@pytest.mark.slow
@pytest.mark.parametrize(("start", "goal", "miles"), PUBLISHED)
def test_published_distances(start, goal, miles):
    assert sea_distance(start, goal).nm == pytest.approx(miles, rel=0.015)


@pytest.mark.slow
def test_the_way_by_another_strait_is_pulled_off_shoals_too():
    """Reefs beside the way by Yucatan were left by the Windward Passage, 38 nm longer."""
    found = sea_distance("Miami", "Colon")
    assert "Yucatan" in found.straits and found.nm == pytest.approx(1_185.0, abs=5.0)


def test_ships_leave_callao_north_of_san_lorenzo():
    """The Boqueron, between the island and La Punta, was on the way: 1,295 nm."""
    assert sea_distance("Callao", "Valparaiso").nm == pytest.approx(1_302.0, abs=2.0)


@pytest.mark.slow
def test_a_passage_that_is_opened_is_used_in_spite_of_the_draught():
    ports = "Gothenburg", "Gdynia"
    closed = sea_distance(*ports, draught_m=9.0)
    found = sea_distance(*ports, draught_m=9.0, open=["Oresund"])
    assert "Oresund" not in closed.straits and "Oresund" in found.straits
    assert found.nm < closed.nm - 80.0


@pytest.mark.slow
def test_a_passage_to_avoid_that_an_approach_leads_through_is_named():
    (note,) = [
        note
        for note in sea_distance("Halifax", "New York", avoid=["Verrazano Narrows"]).notes
        if note.startswith("Not avoided")
    ]
    assert "Verrazano Narrows: the approach" in note
    free = sea_distance("Halifax", "New York").notes
    assert not any(note.startswith("Not avoided") for note in free)


@pytest.mark.parametrize("ports", [("Santos", "Durban"), ("FRBON", "ITSAT"), ("IERAT", "GBBDF")])
def test_the_same_distance_both_ways(ports):
    there, back = sea_distance(*ports), sea_distance(*ports[::-1])
    assert there.nm == pytest.approx(back.nm, rel=1e-9)
    assert there.line[0] == pytest.approx(back.line[-1])


@pytest.mark.slow
def test_the_whole_is_the_sum_of_its_line():
    found = sea_distance("Rotterdam", "New York")
    line = np.array(found.line)
    legs = thalweg.core.geodesy.distance(line[:-1, 0], line[:-1, 1], line[1:, 0], line[1:, 1])
    assert found.length == pytest.approx(legs.sum(), rel=1e-9)
    names = [name for name, _ in found.approaches]
    assert names == ["Rotterdam, NL", "New York City, US"]
    assert "Dover" in found.straits


@pytest.mark.slow
def test_canals_are_used_avoided_and_have_their_own_length():
    short = sea_distance("Rotterdam", "Singapore")
    long = sea_distance("Rotterdam", "Singapore", avoid=["suez"])
    assert short.canals == ("Suez Canal",)
    assert long.canals == ()
    assert "Cape of Good Hope" in long.straits
    assert 3_200 < long.nm - short.nm < 3_700  # 11,755 against 8,288 nm in tables
    kiel = sea_distance("Hamburg", "Gdansk")
    assert kiel.canals == ("Kiel Canal",)
    with pytest.raises(InputError, match="canal"):
        sea_distance("Rotterdam", "Singapore", avoid=["sues"])


@pytest.mark.slow
def test_corinth_is_used_only_when_asked():
    assert sea_distance("Piraeus", "Messina").canals == ()
    assert sea_distance("Piraeus", "Messina", avoid=()).canals == ("Corinth Canal",)


@pytest.mark.slow
def test_ways_do_not_cross_ice_unless_they_begin_there():
    north = np.array(sea_distance("Yokohama", "Bremerhaven", avoid=["suez", "panama"]).line)
    assert np.abs(north[:, 0]).max() < 66.0
    south = sea_distance("Rio de Janeiro", "Brisbane")  # the great circle reaches 72 S
    assert np.array(south.line)[:, 0].min() >= -60.001
    assert np.array(sea_distance("Murmansk", "Hammerfest").line)[:, 0].max() < 72.0
    assert 514.0 < sea_distance("Longyearbyen", "Tromso").nm < 590.0  # great circle: 514 nm


@pytest.mark.slow
def test_only_passages_whose_water_the_way_goes_through_are_named():
    found = sea_distance("New York", "Rotterdam")
    assert "Verrazano Narrows" in found.straits
    assert "Hell Gate (East River)" not in found.straits
    assert found.straits.index("Verrazano Narrows") < found.straits.index("Dover")


@pytest.mark.slow
def test_passages_for_small_ships_are_used_only_when_opened():
    cabot = sea_distance("Baltimore", "Montreal")
    canso = sea_distance("Baltimore", "Montreal", open=["Canso"])
    assert "Cabot" in cabot.straits
    assert canso.straits[0] == "Canso (causeway lock)"
    assert 50.0 < cabot.nm - canso.nm < 200.0


@pytest.mark.slow
def test_passages_can_be_avoided():
    direct = sea_distance("Rotterdam", "New York")
    north = sea_distance("Rotterdam", "New York", avoid=["Dover"])
    assert "Dover" not in north.straits
    assert {"Pentland Firth", "Fair Isle Channel"} & set(north.straits)
    assert 20.0 < north.nm - direct.nm < 200.0
    with pytest.raises(InputError, match="passage or canal"):
        sea_distance("Rotterdam", "New York", avoid=["Atlantis Strait"])


def test_ways_keep_off_land():
    from thalweg import Chart

    chart = Chart.gshhg("i")
    found = sea_distance("Recife", "Las Palmas")
    way = np.array(found.line[2:-2])
    lat, lon, _ = thalweg.core.geodesy.densify(way[:, 0], way[:, 1], 0.5 * NAUTICAL_MILE)
    near = chart.coastline.shore_distance(lat, lon) < 1.9 * NAUTICAL_MILE
    assert near.mean() < 0.01  # where the graph has no water so far from land
    with pytest.raises(InputError, match="offing"):
        sea_distance("Recife", "Las Palmas", offing_nm=-1.0)


@pytest.mark.slow
def test_places_to_pass():
    direct = sea_distance("Rotterdam", "New York")
    north = sea_distance("Rotterdam", "New York", via=["58.7N 4.0W"])
    assert north.nm > direct.nm
    assert "Dover" not in north.straits


def test_ports_of_one_river():
    found = sea_distance("Rotterdam", "Hook of Holland")
    assert found.nm == pytest.approx(14.4, abs=2.0)
    assert found.straits == ()


def test_days_count_approaches_at_ten_knots():
    found = sea_distance("Hamburg", "Rotterdam")
    near = sum(length for _, length in found.approaches) / NAUTICAL_MILE
    assert found.days(20.0) * 24.0 == pytest.approx((found.nm - near) / 20.0 + near / 10.0)
    assert found.days(5.0) * 24.0 == pytest.approx(found.nm / 5.0)
    for speed in (0.0, -3.0, float("nan"), "fast"):
        with pytest.raises(InputError, match="speed"):
            found.days(speed)


def test_errors_of_the_request():
    with pytest.raises(InputError, match="same place"):
        sea_distance("Rotterdam", "Rotterdam")
    with pytest.raises(InputError, match="no port named"):
        sea_distance("Rotterdam", "Atlantis")
    with pytest.raises(InputError, match="Great Lakes"):
        sea_distance("Rotterdam", "Chicago")
    assert issubclass(NoRouteError, thalweg.ThalwegError)


@pytest.mark.slow
def test_command(capsys):
    assert main(["distance", "Rotterdam", "Hamburg", "--speed", "12", "--quiet"]) == 0
    text = capsys.readouterr().out
    assert "Rotterdam, NL to Hamburg, DE" in text
    assert "days" in text
    assert "approach of Hamburg, DE" in text
    assert main(["distance", "Rotterdam", "Hamburg", "--json", "--quiet"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["distance_nm"] == pytest.approx(thalweg.distance("Rotterdam", "Hamburg").nm)
    assert main(["distance", "Rotterdam", "Nowhere", "--quiet"]) == 2


@pytest.mark.slow
def test_with_a_draught_shallow_canals_are_closed_and_shoals_avoided_or_named():
    plain = sea_distance("USNYC", "USBOS")
    assert plain.canals == ("Cape Cod Canal",) and plain.nm < 260.0
    assert not any("less water" in note for note in plain.notes)
    deep = sea_distance("USNYC", "USBOS", draught_m=12.0)
    assert deep.canals == ()
    assert deep.nm > sea_distance("USNYC", "USBOS", avoid=["cape-cod"]).nm
    shallow = sea_distance("Karumba", "Darwin", draught_m=14.0)
    assert sum("less water than the draught" in note for note in shallow.notes) == 1
    for wrong in (0.0, -1.0, 40.0, float("nan"), "deep"):
        with pytest.raises(InputError, match="draught"):
            sea_distance("USNYC", "USBOS", draught_m=wrong)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("start", "goal"),
    [("Naples", "Palermo"), ("Santos", "Buenos Aires"), ("Valparaiso", "Auckland")],
)
def test_ways_past_capes_keep_off_land_where_there_is_room(start, goal):
    """They passed Capri at 0.28 nm, and capes of Brazil and of the Chatham Islands at 0.04."""
    way = sea_distance(start, goal)
    assert not any("nearer to land" in note for note in way.notes)
    chart, (first, last) = world_chart(), (way.line[0], way.line[-1])
    lat, lon, _ = densify(*np.array(way.line).T, 500.0)
    far = np.minimum(distance(lat, lon, *first), distance(lat, lon, *last)) > 40.0 * NAUTICAL_MILE
    shore = chart.coastline.shore_distance(lat[far], lon[far], cap=5000.0)
    assert shore.min() > 1.9 * NAUTICAL_MILE


@pytest.mark.slow
def test_what_is_nearer_to_land_than_required_is_stated():
    way = sea_distance("Narvik", "Harstad")
    note = next(note for note in way.notes if "nearer to land than 2 nm" in note)
    assert "nm off at 68.3" in note or "nm off at 68.4" in note  # in Vestfjorden
    dardanelles = sea_distance("Piraeus", "Ambarli")
    assert not any("nearer to land" in note for note in dardanelles.notes)


@pytest.mark.slow
@pytest.mark.parametrize(("offing", "least"), [(1.0, 0.9), (2.0, 1.3), (3.0, 2.5), (5.0, 4.5)])
def test_a_larger_offing_comes_no_nearer_to_islets(offing, least):
    """Douala to Surabaya passed the Thousand Islands at 0.4 nm by 2 nm, and at 0.2 nm by 5 nm."""
    way = sea_distance((-5.2, 105.95), (-5.9, 107.6), offing_nm=offing)
    lat, lon, _ = densify(*np.array(way.line).T, 500.0)
    shore = world_chart().coastline.shore_distance(lat, lon, cap=10_000.0)
    assert np.min(shore[(lon > 106.2) & (lon < 107.2)]) > least * NAUTICAL_MILE


@pytest.mark.slow
def test_without_a_draught_ways_keep_off_reefs():
    """Houston to Brindisi led through the Florida Keys."""
    keys = sea_distance("Houston", "Brindisi")
    lat, lon, _ = densify(*np.array(keys.line).T, 2000.0)
    assert not np.any((lat > 24.85) & (lat < 25.3) & (lon > -81.3) & (lon < -80.5))


@pytest.mark.slow
@pytest.mark.parametrize("code", ["USLO9", "YERAI"])
def test_terminals_in_open_water_have_no_turn_at_their_end(code):
    """Their approach is one position: the turn there was looked up beyond the ends of the way."""
    assert sea_distance("GDSTG", code).nm > 1000.0
    assert sea_distance(code, "GDSTG").nm == pytest.approx(sea_distance("GDSTG", code).nm)


@pytest.mark.slow
def test_deep_ships_pass_outside_nantucket_sound():
    # tables of distances have 379 nm round the shoals, and the canal is 9.75 m deep
    deep = sea_distance("New York City, US", "Boston, US", draught_m=10.0)
    assert deep.nm == pytest.approx(379.0, rel=0.02)
    assert not deep.canals
    assert [note[:15] for note in deep.notes] == [
        "Bridges over th", "No largest drau", "Passage closed:", "Keeps off shoal"
    ]  # fmt: skip
    assert "Cape Cod Canal: the draught of 10 m is over the 9.75 m allowed" in deep.notes[2]


@pytest.mark.slow
def test_the_command_states_the_way_of_small_ships(capsys):
    """Narvik to Harstad is 266 nm round Lofoten and 48 through straits for ships below 120 m."""
    assert main(["distance", "Narvik", "Harstad", "--quiet"]) == 0
    text = capsys.readouterr().out
    assert "ships shorter than 120 m: 48.1 nm by Ramsund, Tjeldsund (--open all)" in text
    assert main(["distance", "Narvik", "Harstad", "--open", "all", "--quiet"]) == 0
    text = capsys.readouterr().out
    assert text.startswith("Narvik, NO to Harstad, NO: 48.1 nm") and "shorter than" not in text
    assert main(["distance", "Rotterdam", "Hamburg", "--quiet"]) == 0
    assert "shorter than" not in capsys.readouterr().out


@pytest.mark.slow
def test_the_way_of_small_ships_is_stated_for_long_ways_by_a_passage_near_an_end(capsys):
    """Over 500 nm: 823 nm by the Race, and silence where little is gained."""
    assert main(["distance", "Bridgeport, US", "Savannah, US", "--quiet"]) == 0
    text = capsys.readouterr().out
    assert "Savannah, US: 823 nm" in text
    (line,) = [one for one in text.splitlines() if "ships shorter than 120 m" in one]
    assert "by Hell Gate" in line and "(--open all)" in line
    ends = "Rotterdam", "New York"
    assert small_ship_distance(sea_distance(*ends), *ends) is None
    ends = "Bridgeport, US", "Savannah, US"
    small = small_ship_distance(sea_distance(*ends), *ends)
    assert small.nm == sea_distance(*ends, open=["all"]).nm


def test_lists_of_passages_keep_names_with_commas():
    assert names_in_list("suez,panama") == ["suez", "panama"]
    assert names_in_list("korea, western channel") == ["korea, western channel"]
    assert names_in_list("Korea, western channel; suez") == ["Korea, western channel", "suez"]
    assert names_in_list(" , ") == []


@pytest.mark.slow
def test_deep_ships_go_south_of_shikoku():
    inland = sea_distance("Kobe", "Oita", draught_m=14.0)
    outside = sea_distance("Kobe", "Oita", draught_m=20.8)
    assert "Bisan Seto" in inland.straits
    assert outside.straits == ("Tomogashima (Kitan)", "Bungo/Hayasui")
    assert 255.0 < outside.nm < 320.0  # Kii Channel, Muroto, Ashizuri, Bungo Channel
    assert any("Bisan Seto" in note for note in outside.notes)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("start", "goal", "miles", "passages"),
    [
        # 100 nm in tables of the Alaska ferries
        ("Skagway", "Juneau", 101, {"Stephens Passage (north)"}),
        # round Cape Spencer; by Peril Strait, which is for ferries, tables give 161
        ("Sitka", "Juneau", 208, {"Chatham Strait-Icy Strait", "Stephens Passage (north)"}),
    ],
)
def test_ways_in_south_east_alaska(start, goal, miles, passages):
    found = sea_distance(start, goal)
    assert found.nm == pytest.approx(miles, rel=0.03)
    assert passages <= set(found.straits)
    assert not any("Turns back" in note for note in found.notes)


def test_ships_from_belize_pass_between_its_reefs():
    found = sea_distance("Belize City", "Puerto Cortes", draught_m=7.0)
    assert found.nm == pytest.approx(107.0, abs=3.0)  # not outside Glover's Reef, 117 nm
    lat, lon, _ = thalweg.core.geodesy.densify(*np.array(found.line).T, 0.2 * NAUTICAL_MILE)
    north = lat > 16.7  # beside Gladden Spit the graph of all seas is coarser than the reef
    for area in SHOAL_AREAS:
        assert not area.contains(lat[north], lon[north]).any(), area.name


@pytest.mark.slow
@pytest.mark.parametrize(
    ("start", "goal", "way", "most"),
    [
        # round the Grand Recif Sud 780; tables give 740
        ("Noumea", "Suva", "by the Havannah and Woodin Canals", 745.0),
        ("Seward", "Valdez", "by Cape Resurrection", 156.0),  # by the western entrance 160
    ],
)
def test_second_entrances_on_the_side_of_the_way(start, goal, way, most):
    found = sea_distance(start, goal)
    assert any(way in name for name, _ in found.approaches)
    assert any(way in name for name, _ in found.approaches)
    assert found.nm < most


@pytest.mark.slow
def test_the_distance_of_a_ship_has_what_her_size_closes_and_opens(capsys):
    """A car carrier of 60 m air draught goes round the Skaw, a coaster through the Kiel Canal."""

    def answer(*options):
        assert main(["distance", "Rostock", "Antwerp", "--json", "--quiet", *options]) == 0
        return json.loads(capsys.readouterr().out)

    coaster = Ship.simple(speed_kn=11.0, draught_m=5.7, length_m=90.0, breadth_m=13.6)
    chart = world_chart()
    assert closed_and_open(coaster, chart).opened == ("all",)
    usual = answer("--ship", "handysize-bulker")
    assert usual["canals"] == ["Kiel Canal"]
    deep = closed_and_open(tall_ship(60.0), chart)
    assert "kiel" in deep.closed and not deep.opened
    without = answer("--ship", "handysize-bulker", "--avoid", "kiel")
    assert without["canals"] == [] and without["distance_nm"] > usual["distance_nm"] + 200.0
    assert answer("--draught", "9.5")["distance_nm"] == pytest.approx(usual["distance_nm"])


@pytest.mark.slow
def test_an_approach_too_low_for_the_ship_is_noted_and_not_called_avoided():
    found = thalweg.distance("Rotterdam", "New York", ship=tall_ship(75.0))
    assert "Verrazano Narrows" in found.straits
    assert not [note for note in found.notes if note.startswith("Not avoided")]
    (note,) = [note for note in found.notes if note.startswith("The approach is too small")]
    assert "Verrazano Narrows: the air draught of 75 m is over the 65 m allowed" in note
    assert not [note for note in found.notes if note.startswith("Passage closed: Verrazano")]
    lower = thalweg.distance("Rotterdam", "New York", ship=tall_ship(60.0))
    assert lower.nm == pytest.approx(found.nm)
    assert not [note for note in lower.notes if note.startswith("The approach is too small")]


def tall_ship(metres):
    """Return a ship of 200 m with this air draught [m]."""
    hull = {
        "length_between_perpendiculars_m": 200.0, "breadth_m": 32.0, "draught_m": 9.8,
        "block_coefficient": 0.6, "air_draught_m": metres,
    }  # fmt: skip
    return Ship.from_dict({"name": "tall", "hull": hull, "speeds_kn": [15.0]})


@pytest.mark.slow
def test_a_ship_too_high_for_a_canal_takes_the_main_approach_and_is_stated_closed_ways():
    """366 m and 63 m high: through the Chesapeake and Delaware Canal, and not a word on Panama."""
    hull = {
        "length_between_perpendiculars_m": 350.0, "length_overall_m": 366.0, "breadth_m": 48.2,
        "draught_m": 9.0, "block_coefficient": 0.66, "air_draught_m": 63.0,
    }  # fmt: skip
    ship = Ship.from_dict({"name": "cruise", "hull": hull, "speeds_kn": [18.0]})
    high = thalweg.distance("New York", "Baltimore", ship=ship)
    assert not [name for name, _ in high.approaches if "Delaware" in name]
    assert any("Chesapeake Bay Bridge" in note for note in high.notes)
    low = thalweg.distance("New York", "Baltimore", draught_m=9.0)
    assert [name for name, _ in low.approaches if "Delaware" in name]
    round_the_horn = thalweg.distance("Kingston, JM", "San Francisco, US", ship=ship)
    (note,) = [
        note for note in round_the_horn.notes if note.startswith("Passage closed: Panama Canal")
    ]
    assert "the air draught of 63 m is over the 57.91 m allowed. The way through is about" in note
    with pytest.raises(NoRouteError, match="Bosporus: the air draught of 63 m is over the 58 m"):
        thalweg.distance("Piraeus", "Odesa", ship=ship)
    opened = thalweg.distance("Piraeus", "Odesa", ship=ship, open=["Bosporus"])
    assert "Bosporus" in opened.straits
