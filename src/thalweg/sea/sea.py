"""`Sea`: wind, waves, currents, level and depth, from any number of sources, as one thing."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.errors import InputError
from thalweg.core.time import TimeLike, parse_time
from thalweg.sea import inspection
from thalweg.sea import standard_names as nm
from thalweg.sea.argument_checks import parse_area, parse_period, parse_time_step
from thalweg.sea.ensemble_layer import ensemble_layers
from thalweg.sea.fill_policies import CALM_VALUES, fill_values
from thalweg.sea.freeze import FreezableSea
from thalweg.sea.inspection import Inspection
from thalweg.sea.layer import Layer
from thalweg.sea.models import cyclone_layer
from thalweg.sea.models import function_layer as formulas
from thalweg.sea.models.wind_sea import WindSeaLayer

if TYPE_CHECKING:
    from thalweg.sea.tides.constituents import Constituents
    from thalweg.sea.tides.harmonic_analysis import TideAnalysis


@dataclass(frozen=True, eq=False)
class Sea(FreezableSea):
    """Met-ocean fields from layers by priority; never changed, never guessed.

    Make one with `Sea.open`, `Sea.from_functions`, `Sea.storm` or `Sea.calm`; put one over another
    with ``+`` (the left one first). For each variable the first layer that knows a value wins; both
    components of a vector come from the same layer. What no layer knows is NaN.

    Attributes
    ----------
    layers : tuple of Layer
        Sources, first one first.
    assumptions : tuple of str
        What was assumed on the user's word (see `filled`).
    """

    @classmethod
    def open(
        cls,
        *paths: str | os.PathLike[str] | Any,
        mapping: Mapping[str, str] | None = None,
        draught_m: float | None = None,
    ) -> Sea:
        """Open files of met-ocean data; nothing is loaded until it is asked for.

        Reads NetCDF (classic, netCDF-4), GRIB 1 and 2, and Zarr: regular, rectilinear and
        curvilinear grids, projected grids, and UGRID meshes with values at nodes or faces. Of
        files with one layout that follow each other in time one layer is made; otherwise the first
        file goes before the second. Of vertical levels the one nearest to the surface is taken, of
        wind the one at 10 m. A dimension of members (number, realization, ...) makes an ensemble.

        Variables are recognised by CF standard name, else by the spellings of ECMWF, GFS, CMEMS,
        MET Norway, DHI, 52North, NEMO, COADS and Delft3D-FM; units are converted to SI; speed and
        direction become components before anything is interpolated; components along a grid are
        turned to true east and north. NEMO's velocities on cell sides are averaged to the centres
        where the file has the positions of both, else taken to lie at the positions given.

        Between times values are linear, but a step more than 2.5 times as long as both its
        neighbours is a hole and stays unknown. A single time holds at that instant only. Fields
        without a time hold always. Beyond the first and last row and column nothing is known.

        Parameters
        ----------
        *paths : path-like or xarray.Dataset
            Files (or Zarr folders), the most trusted first.
        mapping : mapping of str to str, optional
            Where the file does not say it clearly: canonical name to name in the file
            (``{"sea_surface_wave_from_direction": "p107"}``), for any file that has it. The key
            "crs" gives the projection of a file that does not name it (``"EPSG:32611"``). Other
            keys make plain variables that a ship's function may read.
        draught_m : float, optional
            Average currents given in sigma or z layers from the surface down to this draught [m];
            by default the layer nearest to the surface is taken.

        Returns
        -------
        Sea

        Raises
        ------
        InputError
            If a file is missing or the mapping names variables that are in no file.
        DatasetError
            If a file is damaged, cut, not data, ambiguous, in impossible units, or laid out in a
            way that cannot be sailed on (points, lines, climatologies); the message says why.
        """
        from thalweg.sea.files.file_opener import open_layers

        return cls(tuple(open_layers(paths, mapping, draught_m)))

    @classmethod
    def ensemble(
        cls,
        *members: Sea | str | os.PathLike[str] | Sequence[str | os.PathLike[str]],
        mapping: Mapping[str, str] | None = None,
        draught_m: float | None = None,
    ) -> Sea:
        """Return one sea in several versions, each as likely as the others.

        A file with a dimension for its members needs no more than `Sea.open`. An ensemble has no
        values of its own: take `member` 0 to ``members - 1``, or score a route in all of them with
        `thalweg.route.evaluate_members`. Put over or under other seas with ``+``, its members
        share those.

        Parameters
        ----------
        *members : Sea, path-like or sequence of path-like
            Two or more; what is no Sea is opened, each by itself.
        mapping, draught_m
            For the files, as in `open`.

        Raises
        ------
        InputError
            If members differ in variables, grid, times or area, or there are fewer than two.
        """

        def opened(paths: Any) -> Sea:
            several = paths if isinstance(paths, (list, tuple)) else (paths,)
            return cls.open(*several, mapping=mapping, draught_m=draught_m)

        seas = [one if isinstance(one, Sea) else opened(one) for one in members]
        told = tuple(dict.fromkeys(text for sea in seas for text in sea.assumptions))
        return cls(ensemble_layers(seas), told)

    @classmethod
    def from_functions(
        cls,
        functions: Mapping[str, formulas.FieldFunction],
        *,
        time_step: float | None = None,
        area: tuple[float, float, float, float] | None = None,
        period: tuple[TimeLike, TimeLike] | None = None,
    ) -> Sea:
        """Return a sea given by formulas.

        Parameters
        ----------
        functions : mapping of str to callable
            ``f(time_s, lat, lon) -> array``: seconds since 1970-01-01T00:00Z and degrees, as
            float64 arrays of one shape; the answer has that shape or is one number, in SI units,
            NaN where unknown. Names are CF standard names: components
            (``eastward_sea_water_velocity``, ...), or speed and direction [deg]
            (``wind_speed`` + ``wind_from_direction``; ``sea_water_speed`` +
            ``sea_water_velocity_to_direction``), ``sea_surface_wave_from_direction`` or
            ``..._to_direction``, any ``sea_floor_depth_below_...`` and
            ``sea_surface_height_above_...``. The depth below the *moving* surface
            (``sea_floor_depth_below_sea_surface``) is turned into depth below datum by subtracting
            the water level, if that is given too. Other names are kept as plain variables.
        time_step : float, optional
            Step [s] at which kernels get the formulas (linear between); 0 for fields that never
            change. By default ``min(600 s, window / 200)``, at most 2000 steps.
        area : tuple of float, optional
            (south, north, west, east) [deg] outside which nothing is known.
        period : tuple of time, optional
            (start, end) outside which nothing is known.

        Returns
        -------
        Sea

        Raises
        ------
        InputError
            If one half of a vector is missing, a variable is given twice, or (when sampled) a
            function returns something of another shape.
        """
        layer = formulas.layer_of_functions(
            dict(functions),
            area=parse_area(area),
            period=parse_period(period),
            time_step=parse_time_step(time_step),
        )
        return cls((layer,))

    @classmethod
    def calm(cls) -> Sea:
        """Return a sea without wind, waves and currents, everywhere and always.

        Waves of height zero travel north with a placeholder peak period of 8 s, so that models
        which look at angle and period can be asked; it knows no water level and no depth.
        """
        return cls(
            (formulas.constant_layer(CALM_VALUES, "calm"),),
            ("no wind, waves and currents anywhere",),
        )

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

        The track (6-hourly positions, winds and pressures of Hurricane Danielle, 24 August to
        8 September 1998, which ran along the lane between New York and the English Channel) is
        observed; the fields are not: Holland (1980) gradient wind with radius of maximum wind by
        Willoughby et al. (2006), brought to a 10-min mean at 10 m, turned by Bretschneider's
        inflow angle, asymmetric by Lin and Chavas (2012); waves by the equivalent fetch of Young
        and Vinoth (2013), scaled with the local wind and travelling with it. Beyond 1200 km lies a
        uniform ambient sea. There are no currents and no land: for demonstrations and tests, not
        for navigation.

        Parameters
        ----------
        name : str
            Name of an embedded storm.
        start : time, optional
            When the track shall begin; its true dates by default. Outside the life of the track
            nothing is known.
        ambient : Ambient, optional
            The sea around; by default 5.2 m/s of wind and 1.5 m of waves from the west.
        time_step : float, optional
            Step [s] at which kernels get the storm, 1 or more; one hour by default.
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
            A sea opened from a model run, analysed at every node (what never changes, such as the
            depth, is kept); or constants at three nodes or more, or at one that holds for ``area``.
        constituents : sequence of str, optional
            Names to analyse (by default all that the length of the run can tell apart), or to
            take of the constants given (by default all).
        area : tuple of float, optional
            (south, north, west, east) [deg] for a single station.
        rayleigh : float
            How many cycles two constituents must part over the run.
        progress : callable, optional
            Called with nodes done and nodes in all.
        cache : bool
            Whether the analysis is kept on disk and taken from there.

        Raises
        ------
        InputError
            If the run is too short for the constituents (it says which need how long), or has no
            currents and levels over time; or if an area is given for more than one station.
        """
        from thalweg.sea.tides.tidal_layer import tidal_sea

        return tidal_sea(
            source,
            constituents=constituents,
            area=None if area is None else parse_area(area),
            rayleigh=rayleigh,
            progress=progress,
            cache=cache,
        )

    @classmethod
    def layered(cls, *seas: Sea) -> Sea:
        """Return one sea from several, the first one first."""
        layers = tuple(layer for sea in seas for layer in sea.layers)
        return cls(layers, tuple(dict.fromkeys(a for sea in seas for a in sea.assumptions)))

    def __add__(self, other: Sea) -> Sea:
        return Sea.layered(self, other) if isinstance(other, Sea) else NotImplemented

    def filled(self, **policies: float | tuple[float, float] | str) -> Sea:
        """Return a sea in which what is unknown takes a named value, on the user's word.

        Parameters
        ----------
        **policies
            ``currents`` and ``wind``: 0.0 or (east, north) [m/s]; ``waves``: significant height
            [m] (0.0, or a height with direction north and period 8 s), or ``"wind"`` for the waves
            that the known wind raises (`thalweg.sea.models.wind_sea.carter_1982`); ``water_level``
            [m]; ``ice`` [fraction]. The value holds wherever and whenever no layer knows better.

        Returns
        -------
        Sea
            With one more layer of lowest priority; each policy is told in ``assumptions``.
        """
        values: dict[str, float] = {}
        told: list[str] = []
        by_wind = policies.get("waves") == "wind"
        for policy, value in policies.items():
            if not (by_wind and policy == "waves"):
                values.update(fill_values(policy, value))  # type: ignore[arg-type]
                told.append(f"where unknown, {policy.replace('_', ' ')} = {value}")
        for vector in (nm.WIND, nm.CURRENT):
            if vector.east in values and {vector.east, vector.speed} & self.variables == {
                vector.speed
            }:
                told.append(f"the data's {vector.speed}, without direction, is not used")
        layers: list[Layer] = list(self.layers)
        if values:
            layers.append(formulas.constant_layer(values, "filled"))
        if by_wind:
            layers.append(Sea(tuple(layers))._wind_sea())
            told.append(
                "where unknown, waves are those that the wind raises (Carter 1982, 500 km of "
                "fetch, 24 h)"
            )
        return Sea(tuple(layers), (*self.assumptions, *told))

    def _wind_sea(self) -> WindSeaLayer:
        """Return a layer of the waves of this sea's wind."""
        if not set(nm.WIND.pair) <= self.variables:
            raise InputError(
                "Waves are to be taken from the wind, but the sea holds no wind.",
                f"The sea holds: {', '.join(sorted(self.variables)) or 'nothing'}.",
                "Add wind, or fill waves with a height.",
            )
        return WindSeaLayer(Sea(self.layers))

    def describe(self) -> Inspection:
        """Return what was recognised in the files, what not and why, coverage and gaps."""
        return inspection.inspect_sea(self)

    def draw(
        self,
        path: str | os.PathLike[str],
        *,
        time: TimeLike | None = None,
        area: tuple[float, float, float, float] | None = None,
        coastline: Sequence[tuple[ArrayLike, ArrayLike]] = (),
    ) -> None:
        """Draw a map of each main quantity to one PNG file.

        Parameters
        ----------
        path : path-like
            File to write.
        time : time, optional
            When; by default when the waves (else the wind, the current) are largest.
        area : tuple of float, optional
            (south, north, west, east) [deg]; by default that of the smallest layer of files.
        coastline : sequence of (lat, lon), optional
            Lines [deg] drawn on top.
        """
        from thalweg.sea.sea_maps import draw_maps

        when = None if time is None else parse_time(time)
        box = None if area is None else parse_area(area)
        lines = [(np.asarray(a, np.float64), np.asarray(o, np.float64)) for a, o in coastline]
        draw_maps(self, path, time=when, area=box, coastline=lines)
