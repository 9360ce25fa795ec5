"""What a reader of the tables of a study has to know, once for all of its voyages."""

from __future__ import annotations

import pandas as pd

from thalweg.studies.row_runner import UNREAD
from thalweg.studies.study import Study


def study_notes(study: Study, frame: pd.DataFrame) -> list[str]:
    """Return notes on the voyages of a study.

    Parameters
    ----------
    frame : Of `study_rows`.
    """
    return [*_unread_weather(frame), *_speed_blocks(study, frame)]


def _unread_weather(frame: pd.DataFrame) -> list[str]:
    """Return a note on waves and wind that leave the speed of the ship as it is, with the first."""
    if UNREAD not in frame or not frame[UNREAD].notna().any():
        return []
    texts = frame[UNREAD].dropna()
    count = "all" if len(texts) == len(frame) else f"{len(texts)} of {len(frame)}"
    return [
        f"On the routes of {count} voyages there is weather that does not change the speed of the "
        f"ship; on the first of them: {texts.iloc[0]}"
    ]


def _speed_blocks(study: Study, frame: pd.DataFrame) -> list[str]:
    if not study.without_speed_blocks or "front" not in frame or frame["front"].isna().all():
        return []
    return [
        "No speed is held for a least time in this comparison of methods, since the method exact "
        "has no such blocks: a plan by the other methods has blocks of 6 h. speed_block_h under "
        "voyage gives all methods one length."
    ]
