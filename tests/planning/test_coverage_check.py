"""Coverage check of the end points of a voyage."""

import numpy as np
import pytest
import xarray as xr

from thalweg import Chart, InputError, Sea, Ship, Voyage, plan
from thalweg.core.errors import OutsideAreaError
from thalweg.core.units import NAUTICAL_MILE as NM
from thalweg.planning.report.note_order import count_of_dangers, danger_first
from thalweg.planning.report.plan_summary import plan_summary
from thalweg.planning.request.coverage_check import _remedy, endpoints_within_coverage
from thalweg.planning.request.requirements import derive_requirements
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.route.formats.waypoint_names import waypoint_names
from thalweg.sea.fill_policies import filled_distance
from thalweg.sea.models.coast_fills import NearestLayer

SHIP = Ship.simple(speed_kn=10.0, draught_m=5.0)
WATER = Chart.open_water(50.0, 52.5, 1.0, 5.0)


def names_of_waypoints(found):
    ends = found.provenance["from"], found.provenance["to"]
    return waypoint_names(np.array([0.0, 5e4, 9e4]), *ends)


def known_where(condition):
    def east(t, lat, lon):
        return np.where(condition(lat, lon), 0.2, np.nan) + 0.0 * t

    return Sea.from_functions(
        {
            "eastward_sea_water_velocity": east,
            "northward_sea_water_velocity": lambda t, lat, lon: 0.0 * lat,
        }
    )


def ask(start, goal, sea, chart=WATER, **more):
    voyage = Voyage(start=start, goal=goal, depart="2026-01-01", **more)
    return plan(voyage, ship=SHIP, sea=sea, chart=chart, resolution=5000.0)


def test_a_position_outside_the_data_is_refused_with_the_nearest_covered_water():
    sea = known_where(lambda lat, lon: lon < 3.0)
    with pytest.raises(OutsideAreaError, match=r"nearest covered water is 1\d\.\d nm") as caught:
        ask((50.5, 1.5), (50.5, 3.4), sea)
    assert "eastward_sea_water_velocity" in caught.value.asked


def test_a_position_far_outside_the_data_is_refused():
    with pytest.raises(OutsideAreaError, match="no water within 32 nm"):
        ask((50.5, 1.5), (50.5, 4.5), known_where(lambda lat, lon: lon < 2.0))


@pytest.mark.slow
def test_a_port_moves_to_covered_water_with_a_note():
    found = ask((50.5, 1.5), "Rotterdam", known_where(lambda lat, lon: lon < 4.0))
    end = found.best.track
    assert 3.9 < end.lon[-1] < 4.0 and abs(end.lat[-1] - 51.9) < 0.1
    first = danger_first(found.notes)[0]
    assert first.startswith("Does not reach Rotterdam, NL, which is in water without data of east")
    assert '"fill": {"currents": "nearest:' in first
    assert "sea.filled(currents='nearest:" in first and "--fill currents=nearest:" in first
    assert found.provenance["to"].endswith(" nm from Rotterdam, NL")
    assert found.provenance["to"].startswith("51 5")
    assert "nm from Rotterdam, NL" in plan_summary(found)[0]
    assert not any("Rotterdam" in name for name in names_of_waypoints(found))


def test_the_distance_of_a_fill_is_that_from_the_data():
    """A port 5 nm beyond values that are filled up to 10 nm needs 20, not the 10 it has."""
    grid = Sea.calm().layers
    assert filled_distance(grid) == 0.0
    near = NearestLayer(grid, frozenset({"eastward_wind"}), 10.0 * NM)
    assert filled_distance((*grid, near)) == 10.0 * NM
    assert "wind=nearest:10" in _remedy(["eastward_wind"], 5.0 * NM)
    assert "wind=nearest:20" in _remedy(["eastward_wind"], 5.0 * NM + filled_distance([near]))


@pytest.mark.slow
def test_a_port_moves_to_water_deep_enough():
    chart = WATER.with_depth(lambda lat, lon: np.where(lon > 4.1, 3.0, 20.0) + 0.0 * lat)
    found = ask((50.5, 1.5), "Rotterdam", Sea.calm(), chart)
    assert 4.0 < found.best.track.lon[-1] <= 4.1
    assert found.best.min_ukc_m >= 0.0


def test_missing_depth_at_an_end_point_is_named():
    chart = WATER.with_depth(lambda lat, lon: np.where(lon < 3.0, 30.0, np.nan) + 0.0 * lat)
    with pytest.raises(OutsideAreaError, match="depth is not known there"):
        ask((50.5, 1.5), (50.5, 4.5), Sea.calm(), chart, min_ukc_m=1.0)


def test_an_end_point_covered_at_some_times_only_is_not_refused():
    sea = Sea.from_functions(
        {
            "eastward_sea_water_velocity": lambda t, lat, lon: np.where(
                (lon > 2.9) & (np.asarray(t) % 44712.0 < 22356.0), np.nan, 0.0 * lat
            ),
            "northward_sea_water_velocity": lambda t, lat, lon: 0.0 * lat,
        },
        time_step=600.0,
    )
    assert ask((50.5, 2.5), (50.5, 3.0), sea).best.feasible


@pytest.mark.parametrize(
    "wrong",
    [{"sea": None}, {"ship": "handysize-bulker"}, {"chart": 3}, {"network": 7}],
)
def test_arguments_of_the_wrong_kind(wrong):
    voyage = Voyage(start=(50.5, 1.5), goal=(50.5, 2.0), depart="2026-01-01")
    with pytest.raises(InputError):
        plan(voyage, **{"ship": SHIP, "sea": Sea.calm(), "chart": WATER, **wrong})


def test_a_voyage_of_another_type_is_refused():
    with pytest.raises(InputError, match="Voyage"):
        plan({"start": (50.5, 1.5)}, ship=SHIP, sea=Sea.calm(), chart=WATER)


@pytest.mark.parametrize("wrong", [{"via": "Dover"}, {"depart": [1]}, {"depart": True}])
def test_voyages_of_the_wrong_kind(wrong):
    with pytest.raises(InputError):
        Voyage(**{"start": (50.5, 1.5), "goal": (50.5, 2.0), "depart": "2026-01-01", **wrong})


def test_a_port_is_not_moved_over_land_to_covered_water():
    land = {
        "type": "Polygon",
        "coordinates": [[[3, 50], [3.2, 50], [3.2, 52.5], [3, 52.5], [3, 50]]],
    }
    chart, sea = Chart.from_geojson(land), known_where(lambda lat, lon: lon > 3.1)
    voyage = Voyage(start=(51.0, 2.0), goal=(51.0, 2.8), depart="2026-01-01")
    needs = derive_requirements(voyage, ship=SHIP, sea=sea, chart=chart)
    port = Endpoint("a port", 51.0, 2.8, 0.0, is_port=True)
    request = {"voyage": voyage, "ship": SHIP, "sea": sea, "chart": chart, "needs": needs}
    with pytest.raises(OutsideAreaError, match="a port is outside the data"):
        endpoints_within_coverage([port], **request)


def test_a_port_near_its_water_keeps_its_name_and_a_far_one_does_not():
    near = Endpoint("Hull, GB", 53.7, -0.3, 2_000.0, is_port=True)
    assert near.is_reached and near.true_name == "Hull, GB" and "moved 1.1 nm" in near.note
    far = Endpoint(
        "Hull, GB", 53.7, -0.3, 40_000.0, is_port=True, why="in water without data of waves",
        remedy="To reach it, add data.", way_left_m=60_000.0,
    )  # fmt: skip
    assert far.true_name == "53 42.0N 000 18.0W, 22 nm from Hull, GB"
    assert far.note == (
        "Does not reach Hull, GB, which is in water without data of waves: the plan has "
        "53 42.0N 000 18.0W instead, 22 nm away. At least 32 nm by sea are missing in all totals. "
        "To reach it, add data."
    )
    assert danger_first(["Check the depth: 9 m", far.note])[0] == far.note


@pytest.mark.parametrize(("year", "held"), [(2026, True), (2027, False)])
def test_weather_that_a_ship_does_not_read_is_stated(year, held, tmp_path):
    """A voyage a year after the data was 'calm or not known' without a note."""
    times = np.array(["2026-01-01", "2026-01-05"], "datetime64[ns]")
    lat, lon = np.array([50.0, 52.0]), np.array([1.0, 5.0])
    waves = xr.DataArray(
        np.full((2, 2, 2), 2.0), {"time": times, "lat": lat, "lon": lon}, ("time", "lat", "lon"),
        attrs={"standard_name": "sea_surface_wave_significant_height", "units": "m"},
    )  # fmt: skip
    xr.Dataset({"hs": waves}).to_netcdf(tmp_path / "waves.nc")
    sea = Sea.open(tmp_path / "waves.nc")
    voyage = Voyage(start=(50.5, 1.5), goal=(50.5, 2.5), depart=f"{year}-01-01T06:00Z")
    found = plan(voyage, ship=SHIP, sea=sea, chart=WATER, resolution=5000.0, proof=0.0)
    note = next(note for note in found.notes if note.startswith("Weather is not considered"))
    assert ("not at the departure" in note) is not held


def test_a_calm_sea_has_no_note_on_weather_that_is_not_considered():
    voyage = Voyage(start=(50.5, 1.5), goal=(50.5, 2.5), depart="2026-01-01T06:00Z")
    found = plan(voyage, ship=SHIP, sea=Sea.calm(), chart=WATER, resolution=5000.0, proof=0.0)
    assert not any(note.startswith("Weather is not considered") for note in found.notes)


def test_a_plan_states_units_and_times_that_are_not_in_the_data():
    lat, lon = np.array([49.0, 53.0]), np.array([0.0, 6.0])
    fields = {name: (("lat", "lon"), np.full((2, 2), 0.2)) for name in ("uo", "vo")}
    sea = Sea.open(xr.Dataset(fields, {"lat": lat, "lon": lon}))
    voyage = Voyage(start=(50.5, 1.5), goal=(50.5, 2.5), depart="2026-01-01T06:00Z")
    found = plan(voyage, ship=SHIP, sea=sea, chart=WATER, resolution=5000.0, proof=0.0)
    for begin in ("Units not stated", "No time in the data: the values"):
        (note,) = [note for note in found.notes if note.startswith(begin)]
        assert count_of_dangers([note]) == 1
