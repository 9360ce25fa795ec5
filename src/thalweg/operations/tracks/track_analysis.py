"""Analysis of measured tracks: activities, cycles, and speed models compared with measurements."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np

from thalweg.core.time import format_time, to_datetime64
from thalweg.core.types import FloatArray
from thalweg.core.units import HOUR, KNOT, NAUTICAL_MILE
from thalweg.operations.tracks.activities import (
    ACTIVITIES,
    SAILING_EMPTY,
    SAILING_FULL,
    UNSEEN,
    Activity,
    SegmentationRules,
    find_activities,
)
from thalweg.operations.tracks.predicted_speeds import (
    ordered_settings,
    predicted_speeds_through_water,
    speeds_at_measured_power,
)
from thalweg.operations.tracks.track_calibration import (
    AgreementStatistics,
    Calibration,
    agreement_statistics,
    calibrate,
    leg_speeds,
    mean_speeds,
    speeds_over_ground,
)
from thalweg.operations.tracks.track_cleaning import CleaningRules, TrackLog
from thalweg.operations.tracks.track_readers import TrackSource, read_tracks
from thalweg.operations.tracks.track_segments import (
    SAILING_KINDS,
    SEGMENT_DURATION,
    MeasuredSegments,
    cut_segments,
)
from thalweg.operations.tracks.work_areas import LOADING, UNLOADING, WAITING, WorkAreas

if TYPE_CHECKING:
    import pandas as pd

    from thalweg.sea import Sea
    from thalweg.ship import Ship

WEEK = 168.0 * HOUR


@dataclass(frozen=True, eq=False)
class TrackAnalysis:
    """The activities, segments and speed models of a track.

    Attributes
    ----------
    log : TrackLog
    areas : WorkAreas
    activities : tuple of Activity
    segments : MeasuredSegments
        Of all legs, without their ends.
    models : dict of str to float64 array (p,)
        Speed over ground of each model on every segment [m/s]; NaN where unknown.
    calibration : Calibration or None
        None without currents, or if the currents do not determine a factor.
    notes : tuple of str
        Assumptions, rows left out, and what could not be computed.
    """

    log: TrackLog
    areas: WorkAreas
    activities: tuple[Activity, ...]
    segments: MeasuredSegments
    models: dict[str, FloatArray]
    calibration: Calibration | None
    notes: tuple[str, ...]

    def spreads(self) -> dict[str, AgreementStatistics]:
        """Return the agreement of modelled with measured mean speeds of the legs, by model.

        Returns
        -------
        dict of str to AgreementStatistics
            By the name of the model.
        """
        measured = leg_speeds(self.segments, self.segments.speed)
        return {
            name: agreement_statistics(measured, leg_speeds(self.segments, model))
            for name, model in self.models.items()
        }

    def activity_frame(self) -> pd.DataFrame:
        """Return one row for each activity: times, hours, trip, and whether it is complete.

        Returns
        -------
        DataFrame
            Columns ``activity``, ``start``, ``end`` (datetime64, UTC), ``hours``,
            ``trip`` and ``whole``.
        """
        import pandas as pd

        rows = [
            {
                "activity": a.kind,
                "start": to_datetime64(a.start),
                "end": to_datetime64(a.end),
                "hours": a.duration / HOUR,
                "trip": a.trip,
                "whole": a.whole,
            }
            for a in self.activities
        ]
        return pd.DataFrame(rows)

    def leg_frame(self) -> pd.DataFrame:
        """Return one row for each sailed leg: measured and modelled speeds, distance, errors.

        ``rmse_rel`` of each model is taken over the segments of the leg (Schless 2023, Table 4.8).

        Returns
        -------
        DataFrame
            Columns ``trip``, ``activity``, ``start``, ``hours``, ``distance_nm``,
            ``speed_kn``, and two for each model.
        """
        import pandas as pd

        segments, rows = self.segments, []
        for trip in np.unique(segments.leg).tolist():
            here = segments.leg == trip
            part = segments.part(here)
            row = {
                "trip": trip,
                "activity": SAILING_KINDS[int(part.kind[0])],
                "start": to_datetime64(part.time[0] - 0.5 * part.duration[0]),
                "hours": part.duration.sum() / HOUR,
                "distance_nm": float(part.speed @ part.duration) / NAUTICAL_MILE,
                "speed_kn": float(leg_speeds(part, part.speed)[0]) / KNOT,
            }
            for name, model in self.models.items():
                row[f"{name} [kn]"] = float(leg_speeds(part, model[here])[0]) / KNOT
                row[f"{name} rmse_rel [%]"] = agreement_statistics(part.speed, model[here]).rmse_rel
            rows.append(row)
        return pd.DataFrame(rows)

    def cycle_frame(self) -> pd.DataFrame:
        """Return one row for each complete cycle, loading to loading: hours of each activity.

        Returns
        -------
        DataFrame
            Columns ``start`` (datetime64, UTC), the hours of each activity, and ``cycle
            [h]``.
        """
        import pandas as pd

        rows = []
        for first, last in _whole_cycles(self.activities):
            part = self.activities[first:last]
            row: dict[str, Any] = {"start": to_datetime64(part[0].start)}
            for kind in (LOADING, SAILING_FULL, UNLOADING, SAILING_EMPTY, WAITING):
                row[f"{kind} [h]"] = sum(a.duration for a in part if a.kind == kind) / HOUR
            row["cycle [h]"] = (part[-1].end - part[0].start) / HOUR
            rows.append(row)
        return pd.DataFrame(rows)

    def statistics(self) -> pd.DataFrame:
        """Return for each activity: count, hours (mean, median, deviation, sum), share of time.

        Mean, median and deviation are of complete activities only; sum and share of all.

        Returns
        -------
        DataFrame
            Columns ``activity``, ``count``, ``mean_h``, ``median_h``, ``std_h``,
            ``sum_h`` and ``share``.
        """
        import pandas as pd

        total = sum(a.duration for a in self.activities)
        rows = []
        for kind in ACTIVITIES:
            every = np.array([a.duration for a in self.activities if a.kind == kind])
            whole = np.array([a.duration for a in self.activities if a.kind == kind and a.whole])
            if not every.size:
                continue
            rows.append(
                {
                    "activity": kind,
                    "count": every.size,
                    "mean_h": whole.mean() / HOUR if whole.size else math.nan,
                    "median_h": float(np.median(whole)) / HOUR if whole.size else math.nan,
                    "std_h": whole.std(ddof=1) / HOUR if whole.size > 1 else math.nan,
                    "sum_h": every.sum() / HOUR,
                    "share": every.sum() / total,
                }
            )
        return pd.DataFrame(rows)

    def as_dict(self) -> dict[str, Any]:
        """Return the analysis as plain data for JSON.

        Returns
        -------
        dict
            Vessel, period, statistics of activities, cycles and speeds, calibration,
            and agreement of the models; None where unknown.
        """
        cycles, legs = self.cycle_frame(), self.leg_frame()
        mean_hours = float(cycles["cycle [h]"].mean()) if len(cycles) else None
        speeds = {
            kind: {"legs": len(part), "mean_kn": part.mean(), "std_kn": part.std()}
            for kind, part in (legs.groupby("activity").speed_kn if len(legs) else ())
        }
        data = {
            "vessel": self.log.vessel,
            "start": format_time(float(self.log.time[0])),
            "end": format_time(float(self.log.time[-1])),
            "positions": len(self.log),
            "notes": list(self.notes),
            "activities": self.statistics().to_dict("records"),
            "cycles": {
                "count": len(cycles),
                "per_week": WEEK / (mean_hours * HOUR) if mean_hours else 0.0,
                "mean_h": mean_hours,
            },
            "speeds": speeds,
            "calibration": None if self.calibration is None else asdict(self.calibration),
            "models": {name: asdict(s) for name, s in self.spreads().items()},
        }
        return dict(_json_value(data))


def analyse_tracks(
    source: TrackSource | TrackLog,
    areas: WorkAreas | str | PathLike[str] | Mapping[str, Any],
    *,
    sea: Sea | None = None,
    ship: Ship | None = None,
    speed_kn: float | None = None,
    cutting: SegmentationRules | None = None,
    cleaning: CleaningRules | None = None,
    segment_s: float = SEGMENT_DURATION,
    **reading: Any,
) -> TrackAnalysis:
    """Divide a track into activities, and compare speed models with the measured speeds.

    Parameters
    ----------
    source : path, DataFrame or TrackLog
        The track; see `thalweg.operations.tracks.track_readers.read_tracks`, whose ``columns``,
        ``vessel`` and ``time_format`` may be given too.
    areas : WorkAreas, path or GeoJSON mapping
        See `thalweg.operations.tracks.work_areas.WorkAreas.read`.
    sea : Sea, optional
        With currents: the models "currents" (of the sea) and "calibrated" (times the factor that
        fits best), both with their own mean speed through water, in addition to "still water".
    ship : Ship, optional
        With a sea: the model "ship", the ship's own speed in the conditions met, and "ship,
        calibrated"; with measured powers and a model with resistance, "ship, measured
        power".
    speed_kn : float, optional
        Ordered speed of the ship [kn]; default: its setting nearest to the measured speed.
    cutting : SegmentationRules, optional
    cleaning : CleaningRules, optional
    segment_s : float
        Length of the segments in which speeds are compared [s].

    Returns
    -------
    TrackAnalysis

    Raises
    ------
    InputError
        If the track or the areas cannot be used.
    MissingVariableError
        If the sea has no currents, or lacks data that the ship needs.
    """
    log = (
        source
        if isinstance(source, TrackLog)
        else read_tracks(source, cleaning=cleaning, **reading)
    )
    places = areas if isinstance(areas, WorkAreas) else WorkAreas.read(areas)
    activities = find_activities(log, places, rules=cutting)
    segments = cut_segments(log, activities, sea=sea, length=segment_s)
    notes = [*log.notes, *_coverage_notes(activities)]
    calibration = None
    models = {
        "still water": speeds_over_ground(
            _without_current(segments), mean_speeds(_without_current(segments), 0.0), 0.0
        )
    }
    if sea is not None:
        models["currents"] = speeds_over_ground(segments, mean_speeds(segments, 1.0), 1.0)
        calibration = calibrate(segments)
        notes += _calibration_notes(segments, calibration)
    if calibration is not None:
        factor = calibration.factor
        models["calibrated"] = speeds_over_ground(segments, mean_speeds(segments, factor), factor)
    if sea is not None and ship is not None:
        water = predicted_speeds_through_water(segments, ship, sea, speed_kn=speed_kn)
        models["ship"] = speeds_over_ground(segments, water, 1.0)
        notes += [
            f"The ship sails at its setting of {loaded.speeds[setting] / KNOT:.2f} kn while {kind}."
            for kind, (loaded, setting) in ordered_settings(
                segments, ship, speed_kn=speed_kn
            ).items()
        ]
        if calibration is not None:
            models["ship, calibrated"] = speeds_over_ground(segments, water, calibration.factor)
        powered = speeds_at_measured_power(log, segments, ship, sea)
        if powered is not None:
            models["ship, measured power"] = speeds_over_ground(segments, powered, 1.0)
    return TrackAnalysis(log, places, activities, segments, models, calibration, tuple(notes))


def _without_current(segments: MeasuredSegments) -> MeasuredSegments:
    return replace(segments, current=np.zeros(len(segments), dtype=np.complex128))


def _coverage_notes(activities: tuple[Activity, ...]) -> list[str]:
    """Return notes on gaps and on activities that are cut off."""
    cut = sum(1 for a in activities if not a.whole and a.kind != UNSEEN)
    unseen = [a.duration for a in activities if a.kind == UNSEEN]
    notes = []
    if unseen:
        notes.append(f"No positions for {sum(unseen) / HOUR:.1f} h in {len(unseen)} gaps.")
    if cut:
        notes.append(
            f"{cut} activities are cut off by gaps or the ends of the track; they count in sums, "
            "not in means."
        )
    return notes


def _calibration_notes(segments: MeasuredSegments, calibration: Calibration | None) -> list[str]:
    notes = []
    missing = int((~np.isfinite(segments.current)).sum())
    if missing:
        notes.append(
            f"The sea has no current at {missing} of {len(segments)} segments; legs with such a "
            "segment are left out of the comparison with models that need it."
        )
    if calibration is None:
        notes.append(
            "The factor on the currents is not determined: fewer than three legs with known "
            "currents, or currents that do not differ enough."
        )
    return notes


def _whole_cycles(activities: tuple[Activity, ...]) -> list[tuple[int, int]]:
    """Return (first, one past last) activity of every complete cycle, loading to loading."""
    starts = [i for i, a in enumerate(activities) if a.kind == LOADING]
    found = []
    for first, last in itertools.pairwise(starts):
        kinds = {a.kind for a in activities[first:last]}
        needed = {LOADING, SAILING_FULL, UNLOADING, SAILING_EMPTY}
        if needed <= kinds and all(a.whole for a in activities[first:last]):
            found.append((first, last))
    return found


def _json_value(value: Any) -> Any:
    """Return a value with numbers and texts that JSON accepts; None for unknown numbers."""
    if isinstance(value, dict):
        return {str(key): _json_value(v) for key, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [_json_value(v) for v in value]
    if isinstance(value, (np.integer, bool)):
        return int(value)
    if isinstance(value, (float, np.floating)):
        return float(value) if math.isfinite(value) else None
    return value
