"""Best tracks of cyclones: observed positions, winds and pressures."""

from __future__ import annotations

import csv
from dataclasses import dataclass, replace
from importlib import resources
from typing import Final

import numpy as np

from thalweg.core.errors import unknown_name_error
from thalweg.core.geodesy import MEAN_RADIUS
from thalweg.core.time import parse_time
from thalweg.core.types import FloatArray
from thalweg.core.units import HOUR, KNOT
from thalweg.sea.models.cyclone_formulas import TEN_MINUTE_FACTOR

BEST_TRACK_FILES: Final = {"danielle-1998": "danielle_1998.csv"}
HALF_VELOCITY_INTERVAL: Final = 3.0 * HOUR  #: [s] forward velocity is a mean over twice this


@dataclass(frozen=True, eq=False)
class BestTrack:
    """The best track of one cyclone.

    Attributes
    ----------
    name : Name of the storm.
    time : Times [s since epoch].
    lat, lon : Centre [deg], longitude unwrapped.
    wind : Largest 10-min mean wind at 10 m [m/s].
    pressure : Central pressure [Pa].
    """

    name: str
    time: FloatArray
    lat: FloatArray
    lon: FloatArray
    wind: FloatArray
    pressure: FloatArray

    def starting_at(self, start: float) -> BestTrack:
        """Return the track with its times shifted to start at a time [s since epoch]."""
        return replace(self, time=self.time - self.time[0] + start)

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


def load_best_track(name: str) -> BestTrack:
    """Return an embedded best track; its 1-min winds are converted to 10-min means.

    Parameters
    ----------
    name : Name of an embedded storm.

    Raises
    ------
    InputError : If there is no storm of that name.

    References
    ----------
    .. [1] Harper, B.A., Kepert, J.D., Ginger, J.D. (2010). *Guidelines for converting between
       various wind averaging periods in tropical cyclone conditions*, WMO/TD-No. 1555, Table 1.1.
    """
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
        column["wind_kn"] * KNOT * TEN_MINUTE_FACTOR,
        column["pressure_hpa"] * 100.0,
    )
