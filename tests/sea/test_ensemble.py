"""Ensembles of a sea: from a dimension of a file, from several files, from seas."""

from __future__ import annotations

import json

import numpy as np
import pytest
import xarray as xr

from tests.sea.small_datasets import EAST, HS, NORTH, T0, affine, mesh, regular, value
from thalweg import Sea
from thalweg.core.errors import DatasetError, InputError
from thalweg.sea.ensemble_layer import EnsembleLayer

DEPTH = "sea_floor_depth_below_geoid"


def members(count=3, dim="number", bed=False) -> xr.Dataset:
    """Return the affine field times 1, 2, 3, ... along a dimension of members."""
    one = regular()
    many = xr.concat([one["swh"] * (k + 1.0) for k in range(count)], dim=dim)
    one = one.drop_vars("swh").assign(swh=many.transpose("time", dim, "lat", "lon"))
    one["swh"].attrs = {"standard_name": HS, "units": "m"}
    if bed:
        one["bed"] = (("lat", "lon"), np.full((4, 3), 30.0), {"standard_name": DEPTH, "units": "m"})
    return one


@pytest.mark.parametrize("dim", ["number", "realization", "ensemble", "member", "Ensemble_Member"])
def test_a_dimension_of_a_file_is_an_ensemble(dim) -> None:
    sea = Sea.open(members(dim=dim))
    assert sea.members == 3
    for k in range(3):
        got = value(sea.member(k), HS, T0 + 1800.0, 11.5, 20.5)
        assert got == pytest.approx((k + 1) * affine(T0 + 1800.0, 11.5, 20.5), rel=1e-12)
        assert sea.member(k).members == 0


def test_a_member_dimension_is_recognised_by_its_standard_name() -> None:
    data = members(dim="scenario").assign_coords(
        scenario=("scenario", [1, 2, 3], {"standard_name": "realization"})
    )
    assert Sea.open(data).members == 3


def test_several_files_of_one_ensemble_follow_in_time(tmp_path) -> None:
    whole = members()
    paths = [tmp_path / "a.nc", tmp_path / "b.nc"]
    whole.isel(time=slice(0, 2)).to_netcdf(paths[0])
    whole.isel(time=slice(2, 3)).to_netcdf(paths[1])
    sea = Sea.open(*paths)
    assert len(sea.layers) == 1 and sea.members == 3
    got = value(sea.member(2), HS, T0 + 2.5 * 3600.0, 11.0, 21.0)
    assert got == pytest.approx(3.0 * affine(T0 + 2.5 * 3600.0, 11.0, 21.0), rel=1e-12)


def test_a_file_for_each_member(tmp_path) -> None:
    paths = [tmp_path / f"member{k}.nc" for k in range(3)]
    for k, path in enumerate(paths):
        members().isel(number=k, drop=True).to_netcdf(path)
    sea = Sea.ensemble(*paths)
    assert sea.members == 3
    assert value(sea.member(1), HS, T0, 11.0, 21.0) == pytest.approx(2 * affine(T0, 11.0, 21.0))
    halves = [
        [tmp_path / f"{k}{half}.nc" for half in "ab"] for k in range(2)
    ]  # members in two files each
    for k, (a, b) in enumerate(halves):
        one = members().isel(number=k, drop=True)
        one.isel(time=slice(0, 2)).to_netcdf(a)
        one.isel(time=slice(2, 3)).to_netcdf(b)
    sea = Sea.ensemble(*halves)
    assert sea.members == 2 and len(sea.layers) == 1
    assert sea.member(1).coverage()[0].end == T0 + 3 * 3600.0


def test_fields_without_members_are_one_plain_layer(tmp_path) -> None:
    members(bed=True).to_netcdf(tmp_path / "members.nc")
    regular(fields={"zos": {}}, hours=(0.0, 3.0)).to_netcdf(tmp_path / "level.nc")
    sea = Sea.open(tmp_path / "members.nc", tmp_path / "level.nc")
    kinds = [type(layer) for layer in sea.layers]
    assert sorted(k.__name__ for k in kinds) == ["EnsembleLayer", "GridLayer", "GridLayer"]
    assert sea.members == 3
    level = "sea_surface_height_above_geopotential_datum"
    for k in range(3):
        got = sea.member(k).sample([HS, DEPTH, level], T0, 11.0, 21.0)
        assert got[DEPTH] == 30.0
        assert got[level] == pytest.approx(affine(T0, 11.0, 21.0))
        assert got[HS] == pytest.approx((k + 1) * affine(T0, 11.0, 21.0))
    (forecast,) = (layer for layer in sea.layers if isinstance(layer, EnsembleLayer))
    assert forecast.member_layers[0].grid is forecast.member_layers[2].grid


def test_members_on_a_mesh_share_its_triangles() -> None:
    one = mesh(location="face")
    many = xr.concat([one["swh"] * (k + 1.0) for k in range(3)], dim="realization")
    one = one.drop_vars("swh").assign(swh=many)
    one["swh"].attrs = {"standard_name": HS, "units": "m"}
    sea = Sea.open(one)
    grids = [version.grid for version in sea.layers[0].member_layers]
    assert all(grid is grids[0] for grid in grids)
    assert sea.mesh() is not None
    where = T0 + 900.0, 50.5, 2.5
    ratio = value(sea.member(2), HS, *where) / value(sea.member(0), HS, *where)
    assert ratio == pytest.approx(3.0, rel=1e-6)


def current(speed, area=None):
    """Return a sea with a current to the east."""
    return Sea.from_functions(
        {EAST: lambda t, y, x: speed + 0 * t, NORTH: lambda t, y, x: 0.0 * t}, area=area
    )


def test_ensembles_combined_with_single_seas() -> None:
    forecast = Sea.ensemble(current(1.0), current(2.0))
    sea = (forecast + Sea.calm()).filled(water_level=0.5)
    assert sea.members == 2
    got = sea.member(1).sample([EAST, HS], T0, 5.0, 5.0)
    assert got[EAST] == 2.0 and got[HS] == 0.0
    assert any("water level = 0.5" in text for text in sea.member(1).assumptions)


def test_an_ensemble_has_no_values_itself() -> None:
    sea = Sea.open(members()) + Sea.calm()
    uses = [
        lambda: sea.sample([HS], T0, 11.0, 21.0),
        lambda: sea.series([HS], np.array([T0]), np.array([11.0]), np.array([21.0])),
        lambda: sea.freeze_stations([11.0], [21.0], T0, T0 + 3600.0, [4]),
        lambda: sea.layers[0].sample([HS], np.array([T0]), np.array([11.0]), np.array([21.0])),
        lambda: Sea.from_tides(sea),
        lambda: sea.draw("never.png"),
    ]
    for use in uses:
        with pytest.raises(InputError, match=r"ensemble of 3 members.*sea\.member\(i\)"):
            use()


def test_coverage_and_provenance_of_an_ensemble() -> None:
    sea = Sea.open(members())
    row = sea.coverage()[0]
    assert row.source == "dataset, member 0 and 2 more members"
    assert (row.start, row.end) == (T0, T0 + 3 * 3600.0)
    assert sea.describe().members == 3
    assert sea.describe().as_dict()["members"] == 3
    assert json.dumps(sea.provenance())
    prints = {sea.fingerprint(), *(sea.member(k).fingerprint() for k in range(3))}
    assert len(prints) == 4


def refused(word, make, kind=InputError):
    with pytest.raises(kind, match=word) as caught:
        make()
    assert caught.value.possible and caught.value.remedy
    return caught.value


def test_members_that_do_not_match(tmp_path) -> None:
    one = Sea.open(regular())
    refused("another grid", lambda: Sea.ensemble(one, Sea.open(regular(lon=(20.0, 21.0, 22.5)))))
    refused("another grid", lambda: Sea.ensemble(one, Sea.open(regular(lat=(10.0, 11.0)))))
    error = refused(
        "Member 1 .*runs from", lambda: Sea.ensemble(one, Sea.open(regular(hours=(0.0, 1.0, 4.0))))
    )
    assert error.details["member"] == 1
    refused("not those of", lambda: Sea.ensemble(one, Sea.open(regular(hours=(0.0, 2.0, 3.0)))))
    other = Sea.open(regular(fields={"zos": {}}))
    refused("lacks sea_surface_wave", lambda: Sea.ensemble(one + other, other))
    refused("has sea_surface_height", lambda: Sea.ensemble(one, one + other))
    refused("2 layers, member 0 has 1", lambda: Sea.ensemble(one, one + one))
    refused("another area", lambda: Sea.ensemble(current(1.0), current(1.0, (0, 1, 0, 1))))
    refused("itself an ensemble", lambda: Sea.ensemble(one, Sea.open(members())))
    refused("two or more", lambda: Sea.ensemble(one))


def test_ensembles_of_different_sizes() -> None:
    refused("2 and 3 members", lambda: Sea.open(members(2)) + Sea.open(members(3)))
    level = members(2).rename(swh="zos")
    level["zos"].attrs = {}
    refused("different sizes", lambda: Sea.open(members(3), level), DatasetError)
    twice = members(3).expand_dims(realization=[1, 2])
    refused("along number and along realization|along", lambda: Sea.open(twice), DatasetError)


@pytest.mark.parametrize("index", [3, -1, 1.0, True, "one"])
def test_members_that_do_not_exist(index) -> None:
    sea = Sea.open(members())
    with pytest.raises(InputError):
        sea.member(index)


def test_a_single_sea_has_no_members() -> None:
    refused("not an ensemble", lambda: Sea.calm().member(0))
    assert Sea.open(members(2).isel(number=[0])).members == 0


@pytest.mark.parametrize("fill", ["nearest:60", "coastal_shelter:60:1"])
def test_fills_next_to_land_are_those_of_each_member(fill) -> None:
    """They were refused: "no file holds" the heights that the sea was said to hold."""
    data = members()
    data["swh"][..., 0] = np.nan  # next to land
    sea = Sea.open(data).filled(waves=fill)
    assert sea.members == 3
    at_land = [value(sea.member(k), HS, T0 + 1800.0, 11.0, float(data["lon"][0])) for k in range(3)]
    assert np.isfinite(at_land).all()
    assert at_land[1] == pytest.approx(2.0 * at_land[0], rel=1e-9)
    assert at_land[2] == pytest.approx(3.0 * at_land[0], rel=1e-9)


def test_waves_from_ahead_have_the_height_of_each_member() -> None:
    sea = Sea.open(members()).filled(waves="head_seas")
    place = (T0 + 1800.0, 11.5, 20.5)
    found = [value(sea.member(k), HS, *place) for k in range(3)]
    assert found == pytest.approx([(k + 1) * affine(*place) for k in range(3)], rel=1e-9)
