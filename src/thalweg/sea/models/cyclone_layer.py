"""A sea around one real cyclone: its best track is observed, all fields are modelled from it."""

from __future__ import annotations

import csv
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib import resources
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from thalweg.core.bounding_box import WORLD, BoundingBox
from thalweg.core.errors import unknown_name_error
from thalweg.core.geodesy import MEAN_RADIUS
from thalweg.core.time import TimeLike, format_time, parse_time
from thalweg.core.types import FloatArray
from thalweg.core.units import KNOT
from thalweg.sea import standard_names as nm
from thalweg.sea.argument_checks import parse_time_step
from thalweg.sea.coverage import Coverage
from thalweg.sea.grids.triangle_mesh import Mesh
from thalweg.sea.layer import Samples
from thalweg.sea.models import cyclone_formulas as models

BEST_TRACK_FILES: Final = {"danielle-1998": "danielle_1998.csv"}
DEFAULT_STORM: Final = "danielle-1998"
TIME_STEP: Final = 3600.0  #: [s] step at which the moving storm is frozen
FULL_RADIUS: Final = 600e3  #: [m] the vortex is whole to here ...
OUTER_RADIUS: Final = 1200e3  #: [m] ... and faded smoothly into the ambient sea here
MAX_WIND_RADIUS: Final = (
    150e3  #: [m] largest radius of maximum wind of a storm turning extratropical
)
HALF_VELOCITY_INTERVAL: Final = (
    3.0 * 3600.0
)  #: [s] half the base over which forward velocity is taken
STORM_VARIABLES: Final = frozenset({*nm.WIND.pair, *nm.WAVES.pair, nm.WAVE_HEIGHT, nm.WAVE_PERIOD})


@dataclass(frozen=True, eq=False)
class AmbientSea:
    """The calm-ish sea a storm is set in, the same everywhere: an assumption, not data.

    Attributes
    ----------
    wind : tuple of float
        Wind (east, north) towards [m/s].
    wave_height : float
        Significant height [m].
    wave_to_deg : float
        Direction the waves travel towards [deg].
    wave_period : float
        Peak period [s].
    """

    wind: tuple[float, float] = (5.0, 1.5)
    wave_height: float = 1.5
    wave_to_deg: float = 75.0
    wave_period: float = 8.0


class VortexState(NamedTuple):
    """The vortex at some times; all arrays of one shape, SI."""

    centre: FloatArray  # unit vectors, last axis 3
    coriolis: FloatArray  # negative in the south
    radius: FloatArray
    deficit: FloatArray
    b: FloatArray
    maximum: FloatArray  # symmetric gradient wind
    added: tuple[FloatArray, FloatArray]  # wind from translation
    fetch: FloatArray

    def at(self, pick: Any) -> VortexState:
        """Return the state at some of the times."""
        added = (self.added[0][pick], self.added[1][pick])
        return VortexState(
            self.centre[pick],
            self.coriolis[pick],
            self.radius[pick],
            self.deficit[pick],
            self.b[pick],
            self.maximum[pick],
            added,
            self.fetch[pick],
        )


@dataclass(frozen=True, eq=False)
class BestTrack:
    """A best track.

    Attributes
    ----------
    name : str
        Name of the storm.
    time : float64 array
        Times [s since epoch].
    lat, lon : float64 array
        Centre [deg], longitude unwrapped.
    wind : float64 array
        Largest 10-min mean wind at 10 m [m/s].
    pressure : float64 array
        Central pressure [Pa].
    """

    name: str
    time: FloatArray
    lat: FloatArray
    lon: FloatArray
    wind: FloatArray
    pressure: FloatArray

    def position(self, time: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the centre (lat, lon) [deg] at times, linear between fixes."""
        return np.interp(time, self.time, self.lat), np.interp(time, self.time, self.lon)

    def velocity(self, time: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the forward velocity (east, north) [m/s] over six hours around each time."""
        before = np.maximum(time - HALF_VELOCITY_INTERVAL, self.time[0])
        after = np.minimum(time + HALF_VELOCITY_INTERVAL, self.time[-1])
        lat1, lon1 = self.position(before)
        lat2, lon2 = self.position(after)
        scale = np.radians(1.0) * MEAN_RADIUS / (after - before)
        shrink = np.cos(np.radians(0.5 * (lat1 + lat2)))
        return (lon2 - lon1) * shrink * scale, (lat2 - lat1) * scale


@dataclass(frozen=True, eq=False)
class StormLayer:
    """A cyclone moving along its track through an ambient sea.

    Attributes
    ----------
    track : Track
        Where and how strong.
    ambient : Ambient
        What lies around.
    time_step : float
        Step [s] at which it is frozen.
    """

    track: BestTrack
    ambient: AmbientSea = AmbientSea()
    time_step: float = TIME_STEP

    @property
    def variables(self) -> frozenset[str]:
        """Wind and waves."""
        return STORM_VARIABLES

    @property
    def area(self) -> BoundingBox:
        """The whole world: beyond the storm lies the ambient sea."""
        return WORLD

    @property
    def period(self) -> tuple[float, float]:
        """The life of the track."""
        return float(self.track.time[0]), float(self.track.time[-1])

    def sample(
        self, names: Sequence[str], time: FloatArray, lat: FloatArray, lon: FloatArray
    ) -> Samples:
        """Return values at points (N,); NaN outside the life of the track."""
        here, east, north = _local_axes(lat, lon)
        state = vortex_state(self.track, time)
        dot = np.einsum("ij,ij->i", here, state.centre)
        into_east = np.einsum("ij,ij->i", east, state.centre)
        into_north = np.einsum("ij,ij->i", north, state.centre)
        values = self._fields(dot, (into_east, into_north), state, np.arange(time.size))
        outside = (time < self.period[0]) | (time > self.period[1])
        return {n: np.where(outside, np.nan, values[n]) for n in names}

    def series(
        self, names: Sequence[str], times: FloatArray, lat: FloatArray, lon: FloatArray
    ) -> Samples:
        """Return values (S, T) at stations for all times."""
        here, east, north = _local_axes(lat, lon)
        state = vortex_state(self.track, times)
        dot = here @ state.centre.T
        column = np.broadcast_to(np.arange(times.size), dot.shape)
        values = self._fields(dot, (east @ state.centre.T, north @ state.centre.T), state, column)
        outside = (times < self.period[0]) | (times > self.period[1])
        if outside.any():
            for value in values.values():
                value[:, outside] = np.nan
        return {n: values[n] for n in names}

    def times(self, start: float, end: float) -> FloatArray:
        """Return whole steps over the window, its ends included, within the track's life."""
        start, end = max(start, self.period[0]), min(end, self.period[1])
        if end < start:
            return np.empty(0)
        first = np.ceil(start / self.time_step) * self.time_step
        return np.unique(np.concatenate([[start], np.arange(first, end, self.time_step), [end]]))

    def inside(self, lat: FloatArray, lon: FloatArray) -> NDArray[np.bool_]:
        """Return whether positions lie in the area."""
        return self.area.covers(lat, lon)

    def coverage(self) -> list[Coverage]:
        """Return one row per variable."""
        label = f"storm {self.track.name} (modelled)"
        return [
            Coverage(n, -90.0, 90.0, -180.0, 180.0, *self.period, self.time_step, None, label)
            for n in sorted(self.variables)
        ]

    def mesh(self) -> Mesh | None:
        """Formulas have no mesh."""
        return None

    def provenance(self) -> Mapping[str, Any]:
        """Return the storm, its period and the ambient sea."""
        return {
            "kind": "storm",
            "name": self.track.name,
            "period": [format_time(t) for t in self.period],
            "track": "IBTrACS v04 best track (NOAA), public domain",
            "fields": "modelled: Holland (1980) wind, Young and Vinoth (2013) waves; not observed",
            "ambient": vars(self.ambient),
            "variables": sorted(self.variables),
        }

    def _fields(
        self, dot: FloatArray, into: tuple[FloatArray, FloatArray], state: VortexState, column: Any
    ) -> Samples:
        """Return all fields: the ambient sea, and the vortex where it reaches.

        Waves are those of the local wind over the equivalent fetch; within the radius of maximum
        wind they keep the height they have at it, for seas do not fall in the eye as wind does.
        """
        values = self._ambient_fields(dot.shape)
        reach = dot > np.cos(OUTER_RADIUS / MEAN_RADIUS)
        if not reach.any():
            return values
        local = state.at(column[reach])
        sine = np.sqrt(np.maximum(1.0 - dot[reach] ** 2, 1e-18))
        inward = into[0][reach] / sine, into[1][reach] / sine
        radius = MEAN_RADIUS * np.arctan2(sine, dot[reach])
        wind, share = vortex_wind(radius, inward, local)
        height_wind = np.hypot(*wind)
        eye = np.flatnonzero(radius < local.radius)
        if eye.size:
            rim, towards = local.at(eye), (inward[0][eye], inward[1][eye])
            height_wind[eye] = np.hypot(*vortex_wind(rim.radius, towards, rim)[0])
        background = self.ambient.wind
        u = wind[0] + (1.0 - share) * background[0]
        v = wind[1] + (1.0 - share) * background[1]
        values[nm.EASTWARD_WIND][reach], values[nm.NORTHWARD_WIND][reach] = u, v
        height = models.wave_height_jonswap(height_wind, local.fetch)
        period = models.peak_period_young2006(height, np.maximum(height_wind, 1.0))
        self._add_waves(values, reach, height, period, wind)
        return values

    def _ambient_fields(self, shape: tuple[int, ...]) -> Samples:
        ambient, angle = self.ambient, np.radians(self.ambient.wave_to_deg)
        return {
            nm.EASTWARD_WIND: np.full(shape, ambient.wind[0]),
            nm.NORTHWARD_WIND: np.full(shape, ambient.wind[1]),
            nm.WAVE_HEIGHT: np.full(shape, ambient.wave_height),
            nm.WAVE_PERIOD: np.full(shape, ambient.wave_period),
            nm.WAVE_TO_EAST: np.full(shape, np.sin(angle)),
            nm.WAVE_TO_NORTH: np.full(shape, np.cos(angle)),
        }

    def _add_waves(
        self,
        values: Samples,
        reach: Any,
        height: FloatArray,
        period: FloatArray,
        wind: tuple[FloatArray, FloatArray],
    ) -> None:
        """Add the energy of the storm's waves to the ambient; direction and period by energy."""
        storm, rest = height**2, self.ambient.wave_height**2
        total = np.maximum(storm + rest, 1e-12)
        speed = np.maximum(np.hypot(*wind), 1e-9)
        values[nm.WAVE_HEIGHT][reach] = np.sqrt(storm + rest)
        values[nm.WAVE_PERIOD][reach] = (storm * period + rest * self.ambient.wave_period) / total
        angle = np.radians(self.ambient.wave_to_deg)
        east = storm * wind[0] / speed + rest * np.sin(angle)
        north = storm * wind[1] / speed + rest * np.cos(angle)
        length = np.maximum(np.hypot(east, north), 1e-12)
        values[nm.WAVE_TO_EAST][reach] = east / length
        values[nm.WAVE_TO_NORTH][reach] = north / length


def storm_layer(
    name: str = DEFAULT_STORM,
    *,
    start: TimeLike | None = None,
    ambient: AmbientSea | None = None,
    time_step: float = TIME_STEP,
) -> StormLayer:
    """Return the layer of an embedded storm (see `Sea.storm`)."""
    step = parse_time_step(time_step, least=1.0) or TIME_STEP
    track = load_best_track(name)
    if start is not None:
        moved = track.time - track.time[0] + parse_time(start)
        track = BestTrack(track.name, moved, track.lat, track.lon, track.wind, track.pressure)
    return StormLayer(track, ambient or AmbientSea(), step)


def load_best_track(name: str) -> BestTrack:
    """Return an embedded best track; winds become 10-min means (Harper et al. 2010)."""
    if name not in BEST_TRACK_FILES:
        raise unknown_name_error("storm", name, BEST_TRACK_FILES)
    text = (resources.files("thalweg.sea") / "data" / BEST_TRACK_FILES[name]).read_text("utf-8")
    rows = list(csv.DictReader(line for line in text.splitlines() if not line.startswith("#")))
    column = {key: np.array([float(r[key]) for r in rows]) for key in rows[0] if key != "time"}
    return BestTrack(
        name,
        np.array([parse_time(row["time"]) for row in rows]),
        column["lat"],
        np.unwrap(column["lon"], period=360.0),
        column["wind_kn"] * KNOT * models.TEN_MINUTE_FACTOR,
        column["pressure_hpa"] * 100.0,
    )


def vortex_state(track: BestTrack, time: FloatArray) -> VortexState:
    """Return the parameters of the vortex at times.

    Storms that turn extratropical have a deep centre and moderate wind: Holland's B would fall
    below its range. They are wide: there the radius of maximum wind grows until gradient balance
    holds between the track's pressure and wind at B = 1, but not beyond 150 km. In the end the
    wind of the track is trusted over its pressure: the deficit of the profile is the one that
    gives that wind at that radius (gradient balance, Holland 1980, eq. 4 at r = Rm).
    """
    lat, lon = track.position(time)
    wind = np.interp(time, track.time, track.wind)
    deficit = models.AMBIENT_PRESSURE - np.interp(time, track.time, track.pressure)
    east, north = track.velocity(time)
    added = models.translation_wind(east, north, lat)
    symmetric = np.maximum(wind - np.hypot(*added), 0.5 * wind) / models.SURFACE_FACTOR
    b = models.holland_b(symmetric, deficit)
    radius = models.radius_of_maximum_wind_willoughby2006(wind, lat)
    coriolis = models.coriolis_parameter(lat)
    turning = np.abs(coriolis) * np.maximum(symmetric, 1.0)
    surplus = b * deficit / (models.AIR_DENSITY * np.e) - symmetric**2
    radius = np.clip(
        surplus / np.maximum(turning, 1e-9), radius, np.maximum(radius, MAX_WIND_RADIUS)
    )
    fitted = models.AIR_DENSITY * np.e * (symmetric**2 + turning * radius) / b
    fetch = models.equivalent_fetch_young2013(wind, np.hypot(east, north), radius)
    centre = _local_axes(lat, lon)[0]
    return VortexState(centre, coriolis, radius, fitted, b, symmetric, added, fetch)


def vortex_wind(
    radius: FloatArray, inward: tuple[FloatArray, FloatArray], state: VortexState
) -> tuple[tuple[FloatArray, FloatArray], FloatArray]:
    """Return the storm's part of the 10 m wind.

    Parameters
    ----------
    radius : float64 array
        Distance from the centre [m].
    inward : tuple of float64 array
        Unit vector (east, north) towards the centre.
    state : State
        The vortex at each point's time.

    Returns
    -------
    wind : tuple of float64 array
        (east, north) towards [m/s].
    share : float64 array
        Local over maximum symmetric wind, 0 to 1: where it is 1 no ambient wind is left.
    """
    gradient = models.holland_gradient_wind(
        radius,
        radius_of_maximum=state.radius,
        pressure_deficit=state.deficit,
        b=state.b,
        coriolis=state.coriolis,
    )
    gradient = gradient * _taper(radius)
    share = np.clip(gradient / np.maximum(state.maximum, 1e-6), 0.0, 1.0)
    angle = models.inflow_angle(radius, state.radius)
    spin = np.where(state.coriolis >= 0.0, 1.0, -1.0)  # counter-clockwise in the north
    speed = gradient * models.SURFACE_FACTOR
    across, along = speed * np.cos(angle) * spin, speed * np.sin(angle)
    u = across * inward[1] + along * inward[0] + share * state.added[0]
    v = -across * inward[0] + along * inward[1] + share * state.added[1]
    return (u, v), share


def _taper(radius: FloatArray) -> FloatArray:
    """Return 1 within the full radius, falling smoothly to 0 at the outer radius."""
    x = np.clip((radius - FULL_RADIUS) / (OUTER_RADIUS - FULL_RADIUS), 0.0, 1.0)
    return 1.0 - x * x * (3.0 - 2.0 * x)


def _local_axes(lat: FloatArray, lon: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return unit vectors (N, 3) up, east and north at positions [deg]."""
    a, o = np.radians(lat), np.radians(lon)
    zero = np.zeros_like(a)
    up = np.stack([np.cos(a) * np.cos(o), np.cos(a) * np.sin(o), np.sin(a)], axis=-1)
    east = np.stack([-np.sin(o), np.cos(o), zero], axis=-1)
    north = np.stack([-np.sin(a) * np.cos(o), -np.sin(a) * np.sin(o), np.cos(a)], axis=-1)
    return up, east, north
