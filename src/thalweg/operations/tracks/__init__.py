"""Analysis of measured tracks: reading, cleaning, activities, calibration."""

from thalweg.operations.tracks.activities import Activity, SegmentationRules, find_activities
from thalweg.operations.tracks.track_analysis import TrackAnalysis, analyse_tracks
from thalweg.operations.tracks.track_calibration import Calibration, calibrate
from thalweg.operations.tracks.track_cleaning import CleaningRules, TrackLog
from thalweg.operations.tracks.track_readers import read_tracks
from thalweg.operations.tracks.work_areas import WorkAreas

__all__ = [
    "Activity",
    "Calibration",
    "CleaningRules",
    "SegmentationRules",
    "TrackAnalysis",
    "TrackLog",
    "WorkAreas",
    "analyse_tracks",
    "calibrate",
    "find_activities",
    "read_tracks",
]
