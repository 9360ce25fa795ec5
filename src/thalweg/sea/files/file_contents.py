"""Read one file: recognise its variables, place them in space and time, assemble quantities."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from thalweg.core.errors import DatasetError
from thalweg.sea import standard_names as nm
from thalweg.sea.files import coordinates as co
from thalweg.sea.files import (
    draught_averaging,
    time_coordinates,
    ugrid,
    unit_conversion,
    vertical_levels,
)
from thalweg.sea.files import variable_aliases as sp
from thalweg.sea.files.grid_detection import (
    NEMO_U_COORDINATES,
    GridPlacement,
    grid_placement,
)
from thalweg.sea.files.layer_candidate import (
    FileContents,
    OpenedFile,
    PlacedVariable,
    PlacementCache,
)
from thalweg.sea.files.quantity_assembly import QuantityAssembler
from thalweg.sea.files.variable_recognition import (
    AssignedVariable,
    IgnoredVariable,
    recognise_variables,
)
from thalweg.sea.grids.source_variables import SourceVariable, VariableInFile

NO_TIMES = np.empty(0)
CURRENT_ROLES = frozenset((*nm.CURRENT.pair, sp.X_CURRENT, sp.Y_CURRENT))


class NothingRecognised(DatasetError):
    """A dataset holds no known variable."""


def layer_candidates(
    file: OpenedFile, mapping: Mapping[str, str], placement_cache: PlacementCache | None = None
) -> FileContents:
    """Return the quantities of one file by grid and time axis, and the variables ignored.

    Parameters
    ----------
    mapping : Given by the user: canonical name to name in the file.
    placement_cache : Grids of an earlier file with the same positions.

    Raises
    ------
    DatasetError : If no variable is recognised, or a recognised one has no usable grid or times.
    """
    skip = _coordinates(file.dataset)
    chosen, ignored = recognise_variables(
        file.dataset, mapping=mapping, source=file.source, skip=skip
    )
    if not chosen:
        raise _nothing_recognised_error(file, ignored)
    placement_cache = placement_cache or PlacementCache()
    if placement_cache.meshes is None:
        placement_cache.meshes = ugrid.mesh_layouts(file.dataset, mapping, file.source)
    placed = {
        role: _placed_variable(file, one, mapping, placement_cache) for role, one in chosen.items()
    }
    assembly = QuantityAssembler(file, placed, ignored)
    assembly.assemble()
    if not assembly.candidates:
        raise _nothing_recognised_error(file, assembly.ignored)
    return assembly.candidates, assembly.ignored


def _coordinates(dataset: Any) -> frozenset[str]:
    names = {
        str(n) for n in dataset.variables if str(n) in dataset.coords or str(n) in dataset.dims
    }
    places = ugrid.mesh_dimensions(dataset)
    for n in dataset.variables:
        array = dataset[n]
        if (
            co.is_latitude(array, str(n))
            or co.is_longitude(array, str(n))
            or time_coordinates.is_time(array)
        ):
            names.add(str(n))
        if array.ndim == 1 and array.dims[0] not in places and "positive" in array.attrs:
            names.add(str(n))  # vertical coordinates of layers
        for key in ("bounds", "climatology"):
            if key in array.attrs:
                names.add(str(array.attrs[key]))
    return frozenset(names) | ugrid.mesh_description_variables(dataset)


def _nothing_recognised_error(
    file: OpenedFile, ignored: Sequence[IgnoredVariable]
) -> NothingRecognised:
    reasons = "; ".join(f"{i.variable}: {i.reason}" for i in ignored[:12])
    return NothingRecognised(
        f"{file.source}: no wind, waves, currents, level or depth was recognised in it.",
        f"It holds {reasons}." if reasons else "It holds no numeric field.",
        f"Name the variables: {sp.naming_of('eastward_wind', 'NAME_IN_THE_FILE')}."
        if reasons
        else "Check that it is the right file, and complete.",
        file=file.source,
    )


def _placed_variable(
    file: OpenedFile,
    chosen: AssignedVariable,
    mapping: Mapping[str, str],
    placement_cache: PlacementCache,
) -> PlacedVariable:
    dataset, source = file.dataset, file.source
    array = dataset[chosen.variable]
    clock = time_coordinates.time_coordinate(dataset, array)
    if clock is None:
        _refuse_undated(array, source)
    array, roms_shift = _at_roms_centres(dataset, array, chosen.role)
    place = placement_cache.places.get(chosen.variable)
    if place is None:
        place = grid_placement(dataset, array, mapping, source, placement_cache.meshes or [])
        placement_cache.places[chosen.variable] = place
    time_dim = str(clock.dims[0]) if clock is not None else ""
    keep = frozenset((*place.dims, time_dim))
    layers = None
    if file.draught is not None and chosen.role in CURRENT_ROLES:
        layers = draught_averaging.find_vertical_layers(dataset, array, keep, source)
    deep = [] if layers is None else [layers.dim]
    keep = keep | frozenset(deep)
    array = vertical_levels.pick_surface(dataset, array, keep, chosen.role, source)
    has_time = time_dim in array.dims
    array = array.transpose(*([time_dim] if has_time else []), *deep, *place.dims)
    if place.order is not None:
        array = array.isel({place.dims[1]: place.order})
    times = NO_TIMES if clock is None else time_coordinates.read_times(clock, source)
    if clock is not None and not has_time and clock.dims[0] != "one_time":
        times = NO_TIMES
    valid = unit_conversion.valid_limits(array)
    piece = VariableInFile(array, max(1, times.size), has_time, chosen.factor, valid)
    variable = SourceVariable(
        chosen.variable,
        (piece,),
        times.size > 0,
        place.mesh is not None,
        source,
        roms_shift or _stagger(dataset, place, chosen.role),
    )
    rotated = int(array.attrs.get("GRIB_uvRelativeToGrid", 0)) == 1
    return PlacedVariable(chosen, variable, place, times, rotated, layers)


def _stagger(dataset: Any, place: GridPlacement, role: str) -> tuple[int, int]:
    """Return the offset (rows, columns) of a velocity on the sides of NEMO's cells; else (0, 0)."""
    has_sides = all(n in dataset.variables for n in NEMO_U_COORDINATES)
    if not (has_sides and place.dims and "glamt" in place.key):
        return 0, 0
    return {sp.X_CURRENT: (0, 1), sp.Y_CURRENT: (1, 0)}.get(role, (0, 0))


def _at_roms_centres(dataset: Any, array: Any, role: str) -> tuple[Any, tuple[int, int] | None]:
    """Return a velocity of ROMS on the dimensions of the cell centres, and its offset.

    ROMS and CROCO give u on the inner east sides of cells and v on the inner north sides: one
    column or row less than there are centres. Other variables come back unchanged, with None.
    """
    if role not in (sp.X_CURRENT, sp.Y_CURRENT) or "lat_rho" not in dataset.variables:
        return array, None
    rows, columns = map(str, dataset["lat_rho"].dims) if dataset["lat_rho"].ndim == 2 else ("", "")
    sides = {d for d in map(str, array.dims) if d.startswith(("eta", "xi"))} - {rows, columns}
    if not (rows and columns and sides):
        return array, None
    names = {d: rows if d.startswith("eta") else columns for d in sides}
    centred = array.reset_coords(drop=True).drop_vars(sides, errors="ignore").rename(names)
    short = tuple(dataset.sizes[d] - centred.sizes.get(d, 0) for d in (rows, columns))
    expected = (0, 1) if role == sp.X_CURRENT else (1, 0)
    return (centred, expected) if short == expected else (array, None)


def _refuse_undated(array: Any, source: str) -> None:
    """Raise `DatasetError` for variables along a time axis without dates."""
    for dim in array.dims:
        name = str(dim).lower()
        if name in ("time", "t", "ocean_time", "time_counter") and array.sizes[dim] >= 1:
            raise DatasetError(
                f"{source}: the time axis {dim!r} of {array.name!r} has no dates.",
                "A time axis needs units such as 'hours since 2026-01-01T00:00Z'.",
                "Add the units to the file.",
                file=source,
                variable=str(array.name),
            )
