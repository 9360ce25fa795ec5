"""The results of a study on disk: Parquet files, each written whole or not at all."""

from __future__ import annotations

import hashlib
import io
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pandas as pd

import thalweg
from thalweg.core.errors import DatasetError, InputError
from thalweg.core.file_writing import make_folder, write_bytes, write_text
from thalweg.studies.study import Study

_PARTS = "parts"
_STUDY = "study.json"


def require_parquet() -> None:
    """Raise `InputError` if the package that writes Parquet is not installed."""
    try:
        import pyarrow  # noqa: F401
    except ImportError as error:
        raise InputError(
            "Results of studies are Parquet files, which need the package pyarrow.",
            "Single voyages are planned without it.",
            "pip install 'thalweg[studies]'",
        ) from error


def write_study(study: Study, folder: Path) -> None:
    """Write what is studied beside its results."""
    make_folder(folder)
    data = {"version": thalweg.__version__, "folder": str(study.folder), "study": study.to_dict()}
    write_text(folder / _STUDY, json.dumps(data, indent=2, allow_nan=False) + "\n")


def read_study(folder: str | Path) -> Study:
    """Return the study of a folder with results.

    Raises
    ------
    InputError
        If the folder has no study.
    """
    path = Path(folder) / _STUDY
    if not path.is_file():
        raise InputError(
            f"The folder {str(folder)!r} has no study.",
            "thalweg study run STUDY.yaml --out DIR makes one.",
            "Check the path.",
            file=str(path),
        )
    data = json.loads(path.read_text("utf-8"))
    return Study.from_dict(data["study"], Path(data["folder"]))


def write_part(rows: Sequence[dict[str, Any]], folder: Path) -> Path:
    """Write results as one file, named after the rows in it.

    Parameters
    ----------
    folder : Of the study.
    """
    require_parquet()
    parts = make_folder(folder / _PARTS)
    digest = hashlib.blake2b(digest_size=12)
    for row in sorted(str(row["id"]) for row in rows):
        digest.update(row.encode())
    table = io.BytesIO()
    frame = pd.DataFrame(rows)
    for name in map(str, frame.columns):
        if frame[name].dropna().map(type).nunique() > 1:  # an axis of names and numbers
            frame[name] = frame[name].map(lambda value: None if value is None else str(value))
    frame.to_parquet(table, compression="zstd", index=False)
    path = parts / f"part-{digest.hexdigest()}.parquet"
    write_bytes(path, table.getvalue())
    return path


def read_parts(folder: str | Path, columns: Sequence[str] | None = None) -> pd.DataFrame:
    """Return all results of a study; a row that was done twice is there once.

    Parameters
    ----------
    columns : Only these.

    Returns
    -------
    pandas.DataFrame
        Empty if there are none.

    Raises
    ------
    DatasetError
        If a file cannot be read.
    """
    require_parquet()
    frames = []
    for path in sorted((Path(folder) / _PARTS).glob("part-*.parquet")):
        try:
            frames.append(pd.read_parquet(path, columns=None if columns is None else list(columns)))
        except (OSError, ValueError) as error:
            raise DatasetError(
                f"{path.name} cannot be read: {error}.",
                "Parts are written whole or not at all.",
                "Remove this file; the next run does its rows again.",
                file=str(path),
            ) from error
    if not frames:
        return pd.DataFrame({"id": pd.Series(dtype=str)})
    frames = [frame.dropna(axis="columns", how="all") for frame in frames]
    whole = pd.concat(frames, ignore_index=True).drop_duplicates("id", ignore_index=True)
    if columns is None:
        for name in ("refusal", "reason"):
            if name not in whole:
                whole[name] = pd.Series(None, index=whole.index, dtype=object)
    return whole
