"""Voyages on the meshes of real hydrodynamic models, against calculations by hand."""

from __future__ import annotations

import json

import numpy as np
import pytest
import xarray as xr

from tests.conftest import data_file
from thalweg import Sea, Ship, evaluate
from thalweg.cli.exit_codes import NO_ROUTE, SUCCESS
from thalweg.cli.main import main
from thalweg.core.errors import DatasetError
from thalweg.route import read_track

HERWART = "metocean/northsea_storm_herwart_20171027_29_dhi_ugrid.nc"
SAN_DIEGO = "tide/adh_sandiego_waterlevel_ugrid_30min.nc"


def planned(capsys, *words: str, code: int = SUCCESS) -> dict:
    """Run ``thalweg plan``, which ends with an exit code, and return its JSON answer."""
    assert main(["plan", *words, "--ship", "hopper-dredger", "--json"]) == code
    return json.loads(capsys.readouterr().out)


@pytest.mark.slow
def test_the_storm_mesh_of_herwart(capsys) -> None:
    """Off the Dutch coast on the mesh itself; level and current are those of the nearest face."""
    path = data_file(HERWART)
    answer = planned(
        capsys, "51.5,1.6", "52.2,4.2", "--sea", str(path), "--depart", "2017-10-28T00:00Z"
    )
    assert answer["provenance"]["networks"][0]["kind"] == "mesh"
    best = answer["routes"][0]
    assert best["feasible"] and best["min_ukc_m"] > 0.0
    # 10 kn calm water; head current of the first hours, fair current later
    assert best["time_h"] == pytest.approx(best["distance_nm"] / 10.0, rel=0.03)
    assert answer["lower_bound"] <= best["time_h"] + 1e-9
    raw = xr.open_dataset(path)
    faces = raw.mesh2d_face_nodes.values.astype(int)
    lat = raw.mesh2d_node_lat.values[faces].mean(axis=1)
    lon = raw.mesh2d_node_lon.values[faces].mean(axis=1)
    place = int(np.argmin((lat - 51.7) ** 2 + (lon - 2.6) ** 2))
    step = raw.isel(time=9, mesh2d_nFaces=place)
    second = float(step.time.values.astype("datetime64[s]").astype(float))
    got = Sea.open(path).sample(
        ["sea_surface_height_above_geopotential_datum", "eastward_sea_water_velocity"],
        second, lat[place], lon[place],
    )  # fmt: skip
    assert got["sea_surface_height_above_geopotential_datum"] == pytest.approx(float(step.zeta))
    assert got["eastward_sea_water_velocity"] == pytest.approx(float(step.ucur))


def test_san_diego_names_what_it_lacks() -> None:
    with pytest.raises(DatasetError, match=r"--map crs=EPSG") as caught:
        Sea.open(data_file(SAN_DIEGO))
    assert "projection" in str(caught.value)


@pytest.mark.slow
def test_san_diego_waits_for_the_tide_over_flats_that_fall_dry(tmp_path, capsys) -> None:
    """9140 nodes of which 1225 fall dry; the south bay is reached as the second tide rises."""
    path = data_file(SAN_DIEGO)
    words = ["--sea", str(path), "--map", "crs=EPSG:32611", "--coast", "none"]
    words += ["--depart", "2000-01-01T01:00Z", "--load-factor", "0", "--out", str(tmp_path)]
    ends = "32.65,-117.25", "32.63,-117.11"
    answer = planned(capsys, *ends, *words, "--ukc", "0.5", code=NO_ROUTE)  # with squat aground
    assert any("the ship is" in note and "too deep" in note for note in answer["notes"])
    assert answer["provenance"]["networks"][0]["nodes"] > 8000
    best = answer["routes"][0]
    assert not best["feasible"]
    assert [one["reason"] for one in best["violations"]] == ["under-keel clearance: with squat"]
    assert best["waiting_h"] > 5.0
    assert best["min_ukc_m"] >= 0.5 - 1e-6
    assert best["time_h"] <= 8.2
    sea = Sea.open(path, mapping={"crs": "EPSG:32611"})
    ship = Ship.load("hopper-dredger").with_load_factor(0.0)
    waits = np.array([row["waiting_h"] or 0.0 for row in best["waypoints"]])
    track = read_track(tmp_path / "route.csv")
    again = evaluate(track, ship=ship, sea=sea, min_ukc=0.5, step=5.0)
    assert again.feasible and again.min_ukc_m >= 0.5 - 1e-6
    assert again.time_h == pytest.approx(best["time_h"], abs=1e-3)
    # The waits are in the file, some seconds longer at most so that rounded times keep the limits.
    longer = read_track(tmp_path / "route.csv").wait.sum() - 3600.0 * waits.sum()
    assert -0.01 <= longer <= 6.0 * np.count_nonzero(waits)
    # The thinned mesh is too coarse for the gullies: all nodes are used.
    thinned = planned(
        capsys, *ends, *words[:-2], "--ukc", "0.5", "--network", "mesh", "--resolution", "0.3",
        code=NO_ROUTE,
    )  # fmt: skip
    assert len(thinned["routes"][0]["violations"]) == 1  # with squat, too
    assert thinned["routes"][0]["time_h"] == pytest.approx(best["time_h"], abs=0.01)
    # The flats are dry: without waiting there is no route.
    asked = ["32.65,-117.25", "32.63,-117.11", "--ship", "hopper-dredger", "--ukc", "0.5"]
    assert main(["plan", *asked, "--no-wait", *words]) == 4
    assert "No route" in capsys.readouterr().err
