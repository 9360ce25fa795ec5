"""The work of a study in its child process; finished voyages survive the end of the process."""

from __future__ import annotations

import json
import signal
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from thalweg.core.file_writing import write_text
from thalweg.core.interrupt import held_interrupt
from thalweg.service.jobs.child_messages import MessageWriter
from thalweg.service.jobs.job_order import STUDY_FOLDER, JobOrder, StageMessages

if TYPE_CHECKING:
    import pandas as pd

    from thalweg.studies import Study, StudyProgress

#: Figures of a voyage, beside the axes of its study.
VOYAGE_FIGURES: Final = (
    "time_h", "distance_nm", "fuel_t", "co2_t", "waiting_h", "cost", "saved_time_h", "saved_fuel_t",
    "max_significant_wave_height_m", "max_wind_speed_ms", "feasible", "refusal", "reason",
)  # fmt: skip
_PARTS: Final = 60  # events of a study, about


def plan_study(
    order: JobOrder, messages: MessageWriter, stages: StageMessages
) -> tuple[str, dict[str, Any]]:
    """Plan the voyages of a study that have no result yet, and write its files.

    Returns
    -------
    state : str
        ``done``, or ``cancelled`` with what was planned until then.
    summary : dict
    """
    from thalweg.studies import Study, run_study

    folder = Path(order.workspace) / STUDY_FOLDER
    with held_interrupt() as stopped:
        study = Study.from_dict(order.with_paths(order.request["study"]), Path(order.workspace))

    def progress(state: StudyProgress) -> None:
        messages.send(
            "progress",
            {
                "done": state.done,
                "total": state.total,
                "refused": state.refused,
                "left_s": state.seconds_left,
                "rows": [_row_facts(row, study, order) for row in state.rows],
            },
        )

    stages(f"planning {study.size} voyages")
    state = "done"
    try:
        if stopped.is_set() or order.stopped:
            raise KeyboardInterrupt
        with _stop_at_once():
            chunk = min(20, max(1, study.size // _PARTS))
            run_study(study, folder, chunk=chunk, progress=progress)
    except KeyboardInterrupt:
        if not any(folder.glob("parts/part-*")):
            raise
        state = "cancelled"
    with held_interrupt():
        stages("writing the files")
        return state, _write_study(order, study, folder, stages, cancelled=state == "cancelled")


@contextmanager
def _stop_at_once() -> Iterator[None]:
    """Let the signal to stop end the voyage being planned, which is then no result.

    With the usual handler a search would return its best route so far, as if it were the result.
    """

    def stop(*_: Any) -> None:
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGINT, stop)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def _row_facts(row: Mapping[str, Any], study: Study, order: JobOrder) -> dict[str, Any]:
    """Return a voyage as the page shows it while the study runs."""
    names = [*_labels(study), *VOYAGE_FIGURES]
    facts = {name: row[name] for name in names if name in row}
    found: dict[str, Any] = json.loads(order.without_paths(json.dumps(facts, allow_nan=False)))
    return found


def _labels(study: Study) -> list[str]:
    drawn = [name for name in study.sample if name not in ("count", "seed")]
    return [*study.axes, *drawn]


def _write_study(
    order: JobOrder, study: Study, folder: Path, stages: StageMessages, *, cancelled: bool
) -> dict[str, Any]:
    from thalweg.studies import study_rows, summarise_study

    frame, summary = study_rows(folder), summarise_study(folder)
    labels = [name for name in _labels(study) if name in frame]
    columns = [*labels, *(name for name in VOYAGE_FIGURES if name in frame and name not in labels)]
    order.write_json(
        "study.json",
        {
            "study": order.request["study"],
            "axes": labels,
            "columns": columns,
            "rows": _records(frame[columns], "values"),
            "total": study.size,
            "groups": _records(summary.table, "records"),
            "refusals": _records(summary.refusals, "records"),
            "best": _records(summary.best, "records"),
        },
    )
    for path in summary.write(order.path):
        if path.suffix == ".csv":
            write_text(path, order.without_paths(path.read_text("utf-8")))
    write_text(order.path / "voyages.csv", order.without_paths(frame.to_csv(index=False)))
    over_limit = frame["feasible"].eq(False) if "feasible" in frame else False
    refused = int((frame["refusal"].notna() | over_limit).sum())
    return {
        "title": study.name,
        "feasible": refused < len(frame),
        "cancelled": cancelled,
        "seconds": stages.seconds(),
        "voyages": len(frame),
        "total": study.size,
        "refused": refused,
    }


def _records(frame: pd.DataFrame, form: Any) -> Any:
    """Return a table as plain data; unknown is None."""
    return json.loads(frame.to_json(orient=form, double_precision=6))
