"""`Sea`: wind, waves, currents, water level and depth from any number of sources."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from thalweg.core.delegation import delegated
from thalweg.core.time import TimeLike
from thalweg.deprecated_names import renamed_attributes
from thalweg.sea import ensemble_layer, freeze, layer_stack, sea_maps
from thalweg.sea.argument_checks import parse_area
from thalweg.sea.fill_policies import CALM_VALUES, FillValue, layers_filled
from thalweg.sea.inspection import inspect_layers
from thalweg.sea.layer import Layer
from thalweg.sea.models import cyclone_layer
from thalweg.sea.models.function_layer import FieldFunction, constant_layer, layer_of_functions
from thalweg.sea.models.lipschitz_bounds import parse_lipschitz
from thalweg.sea.models.quasi_static_layer import quasi_static_sea, sea_sampled
from thalweg.sea.opening import layers_of_sources
from thalweg.sea.tides.constituents import Constituents
from thalweg.sea.tides.harmonic_analysis import TideAnalysis
from thalweg.sea.tides.tidal_layer import tidal_layers
from thalweg.sea.value_sources import sea_fingerprint, sea_provenance


@dataclass(frozen=True, eq=False)
class Sea:
    """Met-ocean fields from layers in order of priority; immutable.

    Make one with `Sea.open`, `Sea.from_functions`, `Sea.storm`, `Sea.from_tides` or `Sea.calm`;
    combine two with ``+`` (the left one has priority). For each variable the first layer that knows
    a value wins; both components of a vector come from the same layer. A value that no layer knows
    is NaN. Layers may hold an ensemble; then only its members have values.

    Attributes
    ----------
    layers : tuple of Layer
        Sources, in order of priority.
    assumptions : tuple of str
        Values that were assumed at the user's request (see `filled`).
    """

    layers: tuple[Layer, ...]
    assumptions: tuple[str, ...] = ()

    if not TYPE_CHECKING:
        __getattr__ = renamed_attributes(knows="provides")

    def __post_init__(self) -> None:
        ensemble_layer.member_count(self.layers)

    @classmethod
    def open(
        cls,
        *paths: str | os.PathLike[str] | Any,
        mapping: Mapping[str, str] | None = None,
        draught_m: float | None = None,
    ) -> Sea:
        """Open files of met-ocean data; values are read when they are needed.

        Reads NetCDF (classic, netCDF-4), GRIB 1 and 2, and Zarr: regular, rectilinear and
        curvilinear grids, projected grids, and UGRID meshes with values at nodes or faces. Files
        with the same layout that follow each other in time become one layer; otherwise the first
        file has priority over the second. Of vertical levels the one nearest to the surface is
        used, of wind the one at 10 m. A dimension of members makes an ensemble. Constituents at
        three nodes or more give the tide at any date; those of one station, its record or its tide
        table hold in a box [deg]: ``FILE@SOUTH,NORTH,WEST,EAST``.

        Variables are recognised by CF standard name, otherwise by the names that ECMWF, GFS, CMEMS,
        MET Norway, DHI, 52North, NEMO, COADS, Delft3D-FM, SCHISM, FVCOM and ROMS use. Units are
        converted to SI. Speed and direction are converted to components before interpolation.
        Components along a grid are rotated to true east and north. Velocities of NEMO and ROMS on
        cell sides are averaged to the cell centres where the file has the positions of both.

        Values are linear in time, but a step more than 2.5 times as long as both its neighbours
        is a gap and stays unknown. A single time is valid at that instant only. Fields without a
        time hold at all times. Beyond the first and last row and column values are unknown.

        Parameters
        ----------
        *paths : path-like or xarray.Dataset
            Files (or Zarr folders), in order of priority.
        mapping : mapping of str to str, optional
            For variables that the file does not identify: canonical name to name in the file
            (``{"sea_surface_wave_from_direction": "p107"}``), for any file that has it. The key
            "crs" gives the projection of a file that does not name it (``"EPSG:32611"``). Other
            keys make plain variables that a ship's function may read.
        draught_m : float, optional
            Average currents given in sigma or z layers from the surface down to this draught [m];
            by default the layer nearest to the surface is used.

        Returns
        -------
        Sea

        Raises
        ------
        InputError
            If a file is missing or the mapping names variables that are in no file.
        DatasetError
            If a file is damaged, truncated, not data, ambiguous, in impossible units, or has a
            layout that cannot be used (points, lines, climatologies); the message gives the reason.
        """
        return cls(*layers_of_sources(paths, mapping, draught_m))

    @classmethod
    def ensemble(
        cls,
        *members: Sea | str | os.PathLike[str] | Sequence[str | os.PathLike[str]],
        mapping: Mapping[str, str] | None = None,
        draught_m: float | None = None,
    ) -> Sea:
        """Return one sea in several versions, each as likely as the others.

        For a file with members use `Sea.open`. An ensemble has no values itself: select `member` 0
        to ``members - 1``, or evaluate a route in all with `thalweg.route.evaluate_members`.
        Combined with other seas by ``+``, the members share those.

        Parameters
        ----------
        *members : Sea, path-like or sequence of path-like
            Two or more; paths are opened, one sea for each argument.
        mapping, draught_m
            For the files, as in `open`.

        Returns
        -------
        Sea

        Raises
        ------
        InputError
            If members differ in variables, grid, times or area, or there are fewer than two.
        """

        def opened(paths: Any) -> Sea:
            several = paths if isinstance(paths, (list, tuple)) else (paths,)
            return cls.open(*several, mapping=mapping, draught_m=draught_m)

        seas = [one if isinstance(one, Sea) else opened(one) for one in members]
        return cls(
            ensemble_layer.ensemble_layers([sea.layers for sea in seas]), _assumptions_of(seas)
        )

    @classmethod
    def from_functions(
        cls,
        functions: Mapping[str, FieldFunction],
        *,
        time_step: float | None = None,
        area: tuple[float, float, float, float] | None = None,
        period: tuple[TimeLike, TimeLike] | None = None,
        lipschitz: Mapping[str, tuple[float, float]] | None = None,
    ) -> Sea:
        """Return a sea given by formulas.

        Parameters
        ----------
        functions : mapping of str to callable
            ``f(time_s, lat, lon) -> array``: seconds since 1970-01-01T00:00Z and degrees, as
            float64 arrays of one shape; the result has that shape or is one number, in SI units,
            NaN where unknown. Names are CF standard names: components
            (``eastward_sea_water_velocity``, ...), or speed and direction [deg] (``wind_speed`` +
            ``wind_from_direction``; ``sea_water_speed`` + ``sea_water_velocity_to_direction``),
            ``sea_surface_wave_from_direction`` or ``..._to_direction``, any
            ``sea_floor_depth_below_...`` and ``sea_surface_height_above_...``. From the depth below
            the *moving* surface (``sea_floor_depth_below_sea_surface``) the water level is
            subtracted if it is given too. Other names are stored as plain variables.
        time_step : float, optional
            Step [s] at which kernels receive the formulas (linear in between); 0 for fields that
            never change. By default ``min(600 s, window / 200)``, at most 2000 steps.
        area : tuple of float, optional
            (south, north, west, east) [deg]; values are unknown outside.
        period : tuple of time, optional
            (start, end); values are unknown outside.
        lipschitz : mapping of str to pair of float, optional
            Greatest change of a function a metre and a second, in its unit; not of directions of
            wind and current. With those of all functions that a ship needs, and without area and
            period, bounds of plans hold for the functions, and not only for their samples.

        Returns
        -------
        Sea

        Raises
        ------
        InputError
            If a Lipschitz bound is not possible, half of a vector is missing, a variable is given
            twice, or (when sampled) a function returns an array of another shape.
        """
        layer = layer_of_functions(functions, area=area, period=period, time_step=time_step)
        return cls((replace(layer, lipschitz=parse_lipschitz(lipschitz, functions)),))

    @classmethod
    def calm(cls) -> Sea:
        """Return a sea without wind, waves and currents at all places and times.

        Waves of height zero travel north with a peak period of 8 s; level and depth are unknown.

        Returns
        -------
        Sea
            Its ``assumptions`` state that it is calm.
        """
        layer = constant_layer(CALM_VALUES, "calm")
        return cls((layer,), ("A calm sea is assumed: no wind, waves and currents anywhere.",))

    @classmethod
    def storm(
        cls,
        name: str = cyclone_layer.DEFAULT_STORM,
        *,
        start: TimeLike | None = None,
        ambient: cyclone_layer.AmbientSea | None = None,
        time_step: float = cyclone_layer.TIME_STEP,
    ) -> Sea:
        """Return wind and waves of a real cyclone, **modelled** from its best track.

        The track of Hurricane Danielle (24 August to 8 September 1998, along the route between New
        York and the English Channel) is observed. The fields are not: the wind follows Holland
        (1980), the waves Young and Vinoth (2013), with the formulas of
        `thalweg.sea.models.cyclone_formulas`. Beyond 1200 km the ambient sea is uniform. There are
        no currents and no land: for demonstrations and tests, not for navigation.

        Parameters
        ----------
        name : str
            Name of an embedded storm.
        start : time, optional
            First time of the track, its true date by default; unknown outside its period.
        ambient : AmbientSea, optional
            The surrounding sea; by default 5.2 m/s of wind and 1.5 m of waves from the west.
        time_step : float, optional
            Step [s] at which kernels receive the storm, 1 or more; one hour by default.

        Returns
        -------
        Sea
        """
        layer = cyclone_layer.storm_layer(name, start=start, ambient=ambient, time_step=time_step)
        return cls((layer,))

    @classmethod
    def from_tides(
        cls,
        source: Sea | Constituents | TideAnalysis,
        *,
        constituents: Sequence[str] | None = None,
        area: tuple[float, float, float, float] | None = None,
        rayleigh: float = 1.0,
        progress: Callable[[int, int], None] | None = None,
        cache: bool = True,
    ) -> Sea:
        """Return currents and water level of the tide, at any date, on the nodes of the source.

        Parameters
        ----------
        source : Sea, Constituents or TideAnalysis
            A sea opened from a model run, which is analysed at every node (fields without time,
            such as the depth, are kept); or constants at three nodes or more; or constants at one
            node that apply to ``area``.
        constituents : sequence of str, optional
            Names to analyse (by default all that the run can separate) or select (by default all).
        area : tuple of float, optional
            (south, north, west, east) [deg] for a single station.
        rayleigh : float
            Rayleigh criterion: the least difference of two constituents [cycles] over the run.
        progress : callable, optional
            Called with the number of nodes done and in total.
        cache : bool
            Whether the analysis is stored on disk and read from there.

        Returns
        -------
        Sea

        Raises
        ------
        InputError
            If the run is too short for the constituents (the message gives the lengths needed),
            or has no currents and levels over time; or if an area is given for several stations.
        """
        layers = tidal_layers(
            source.layers if isinstance(source, Sea) else source,
            constituents=constituents,
            area=None if area is None else parse_area(area),
            rayleigh=rayleigh,
            progress=progress,
            cache=cache,
        )
        return cls(layers, source.assumptions if isinstance(source, Sea) else ())

    @classmethod
    def layered(cls, *seas: Sea) -> Sea:
        """Return one sea from several, in order of priority.

        Parameters
        ----------
        *seas : Sea
            The first one that knows a value gives it.

        Returns
        -------
        Sea
            With the layers and the assumptions of all.

        Raises
        ------
        InputError
            If several are ensembles of different sizes.
        """
        layers = tuple(layer for sea in seas for layer in sea.layers)
        return cls(layers, _assumptions_of(seas))

    def __add__(self, other: Sea) -> Sea:
        return Sea.layered(self, other) if isinstance(other, Sea) else NotImplemented

    def filled(self, **policies: FillValue) -> Sea:
        """Return a sea in which unknown values take a value that the user names.

        Parameters
        ----------
        **policies
            ``currents``, ``wind``: 0.0 or (east, north) [m/s]; ``wind`` also ``"waves"``, that of
            known waves (`WindOfWavesLayer`); ``waves``: significant height [m] (0.0, or a height
            with direction north and period 8 s), ``"wind"`` for those of the known wind
            (`thalweg.sea.models.wind_sea.carter_1982`), ``"head_seas"`` where direction or period
            is unknown (`HeadSeasLayer`); ``water_level`` [m]; ``ice`` [-]. It holds where no layer
            knows one. ``"nearest:25"`` takes the nearest known value within 25 nm, for waves
            ``"coastal_shelter"`` with 0.8 of the height, a `CoastalFetch` those of the local wind.

        Returns
        -------
        Sea
            With one more layer of lowest priority; ``assumptions`` states each policy.

        Raises
        ------
        InputError
            If a policy is unknown or its value is impossible.
        """
        layers, assumptions = layers_filled(self.layers, policies)
        return Sea(layers, (*self.assumptions, *assumptions))

    @property
    def members(self) -> int:
        """Number of members of the sea as an ensemble; 0 for a single sea."""
        return ensemble_layer.member_count(self.layers)

    def member(self, index: int) -> Sea:
        """Return one member of an ensemble, as a single sea.

        Parameters
        ----------
        index : int
            From 0 to ``members - 1``.

        Returns
        -------
        Sea
            The layers that all members share, and those of this member.

        Raises
        ------
        InputError
            If the sea is not an ensemble or has no such member.
        """
        return replace(self, layers=ensemble_layer.select_member(self.layers, index))

    check_single = delegated(ensemble_layer.check_not_ensemble, "layers")
    quasi_static = delegated(quasi_static_sea)
    sampled = delegated(sea_sampled)

    @property
    def variables(self) -> frozenset[str]:
        """Canonical names of all variables of the layers (vectors as components)."""
        return layer_stack.stack_variables(self.layers)

    provides = delegated(layer_stack.stack_provides, "layers")
    sample = delegated(layer_stack.sample_stack, "layers")
    series = delegated(layer_stack.series_of_stack, "layers")
    why_missing = delegated(layer_stack.missing_reason, "layers")
    period_of = delegated(layer_stack.stack_period, "layers")
    times = delegated(layer_stack.stack_times, "layers")
    mesh = delegated(layer_stack.first_mesh, "layers")
    coverage = delegated(layer_stack.coverage_of_layers, "layers")
    freeze_stations = delegated(freeze.freeze_station_fields, "layers")
    freeze_grid = delegated(freeze.freeze_grid_fields, "layers")
    describe = delegated(inspect_layers, "layers")
    draw = delegated(sea_maps.draw_maps, "layers")
    provenance = delegated(sea_provenance)
    fingerprint = delegated(sea_fingerprint)


def _assumptions_of(seas: Sequence[Sea]) -> tuple[str, ...]:
    """Return the assumptions of all seas, each once."""
    return tuple(dict.fromkeys(text for sea in seas for text in sea.assumptions))
