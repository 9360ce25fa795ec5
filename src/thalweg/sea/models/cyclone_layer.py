"""A layer of wind and waves around one cyclone: fields modelled from its observed best track."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from thalweg.core.bounding_box import WORLD, BoundingBox
from thalweg.core.geodesy import MEAN_RADIUS, local_axes
from thalweg.core.time import TimeLike, format_time, parse_time
from thalweg.core.types import BoolArray, FloatArray
from thalweg.core.units import HOUR
from thalweg.sea import standard_names as nm
from thalweg.sea.argument_checks import parse_time_step
from thalweg.sea.coverage import Coverage
from thalweg.sea.layer import Samples
from thalweg.sea.models import cyclone_formulas as formulas
from thalweg.sea.models.cyclone_track import BestTrack, load_best_track
from thalweg.sea.models.cyclone_vortex import (
    OUTER_RADIUS,
    VortexState,
    vortex_state,
    vortex_wind,
)
from thalweg.sea.triangle_mesh import Mesh

DEFAULT_STORM: Final = "danielle-1998"
TIME_STEP: Final = HOUR  #: [s] step at which the moving storm is frozen
STORM_VARIABLES: Final = frozenset({*nm.WIND.pair, *nm.WAVES.pair, nm.WAVE_HEIGHT, nm.WAVE_PERIOD})


@dataclass(frozen=True, eq=False)
class AmbientSea:
    """The uniform sea around a storm: an assumption, not data.

    Attributes
    ----------
    wind : Wind (east, north) towards [m/s].
    wave_height : Significant height [m].
    wave_to_deg : Direction the waves travel towards [deg].
    wave_period : Peak period [s].
    """

    wind: tuple[float, float] = (5.0, 1.5)
    wave_height: float = 1.5
    wave_to_deg: float = 75.0
    wave_period: float = 8.0


@dataclass(frozen=True, eq=False)
class StormLayer:
    """A cyclone moving along its track through an ambient sea.

    Attributes
    ----------
    track : Positions, winds and pressures.
    ambient : The surrounding sea.
    time_step : Step [s] at which it is frozen.
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
        """The whole world; beyond the storm the ambient sea."""
        return WORLD

    @property
    def period(self) -> tuple[float, float]:
        """First and last time of the track [s since epoch]."""
        return float(self.track.time[0]), float(self.track.time[-1])

    def sample(
        self, names: Sequence[str], time: FloatArray, lat: FloatArray, lon: FloatArray
    ) -> Samples:
        """Return values at points (N,); NaN outside the period of the track."""
        here, east, north = local_axes(lat, lon)
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
        here, east, north = local_axes(lat, lon)
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
        """Return whole steps over the window, its ends included, within the period of the track."""
        start, end = max(start, self.period[0]), min(end, self.period[1])
        if end < start:
            return np.empty(0)
        first = np.ceil(start / self.time_step) * self.time_step
        return np.unique(np.concatenate([[start], np.arange(first, end, self.time_step), [end]]))

    def inside(self, lat: FloatArray, lon: FloatArray) -> BoolArray:
        """Return whether positions are in the area."""
        return self.area.covers(lat, lon)

    def coverage(self) -> list[Coverage]:
        """Return one row per variable."""
        label = f"storm {self.track.name} (modelled)"
        return [
            Coverage(n, -90.0, 90.0, -180.0, 180.0, *self.period, self.time_step, None, label)
            for n in sorted(self.variables)
        ]

    def mesh(self) -> Mesh | None:
        """Return None: formulas have no mesh."""
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
        """Return all fields: the ambient sea, and the vortex within its outer radius.

        Waves are those of the local wind over the equivalent fetch. Within the radius of maximum
        wind they have the height at that radius, because waves do not decay in the eye as the
        wind does.
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
        height = formulas.wave_height_jonswap(height_wind, local.fetch)
        period = formulas.peak_period_young2006(height, np.maximum(height_wind, 1.0))
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
    """Return the layer of an embedded storm (see `Sea.storm`).

    Parameters
    ----------
    start : First time of the track; its true date by default.
    ambient : The surrounding sea.
    time_step : Step of frozen times [s], 1 or more.

    Raises
    ------
    InputError : If there is no storm of that name, or the step is too small.
    """
    step = parse_time_step(time_step, least=1.0) or TIME_STEP
    track = load_best_track(name)
    if start is not None:
        track = track.starting_at(parse_time(start))
    return StormLayer(track, ambient or AmbientSea(), step)
