"""The process that decodes one GRIB file: ``python grib_worker.py FILE FOLDER``.

It imports no module of Thalweg and none that uses PROJ. It writes one array per variable into the
folder, and ``listing.json`` last.
"""

from __future__ import annotations

import json
import os
import sys
import warnings
from pathlib import Path
from typing import Any

import numpy as np

#: kinds of levels above the sea surface; their fields are not decoded
UPPER_AIR = {"isobaricInhPa", "isobaricInPa", "hybrid", "theta", "potentialVorticity", "sigma"}


def main(source: str, folder: Path) -> None:
    """Decode a file into arrays in a folder."""
    warnings.simplefilter("ignore")
    import cfgrib

    parts = cfgrib.open_datasets(source, backend_kwargs={"indexpath": "", "errors": "raise"})
    parts = [part for part in parts if not UPPER_AIR & set(map(str, part.coords))]
    listing = [write_arrays(part, k, folder) for k, part in enumerate(parts)]
    (folder / "listing.tmp").write_text(json.dumps(listing), "utf-8")
    os.replace(folder / "listing.tmp", folder / "listing.json")


def write_arrays(dataset: Any, number: int, folder: Path) -> dict[str, Any]:
    """Write the arrays of a dataset and return their names, dimensions and attributes."""
    dataset = with_valid_time(dataset)
    contents: dict[str, Any] = {"fields": {}, "coords": {}, "attrs": json_attributes(dataset.attrs)}
    for name, array in dataset.variables.items():
        values = np.asarray(array.values)
        is_time = values.dtype.kind == "M"
        if values.dtype.kind == "m":
            continue
        if is_time:
            values = values.astype("datetime64[ns]").astype(np.int64)
        file = f"{number}-{len(contents['fields']) + len(contents['coords'])}.npy"
        np.save(folder / file, values)
        entry = {
            "file": file,
            "dims": [str(d) for d in array.dims],
            "attrs": json_attributes(array.attrs),
            "is_time": is_time,
        }
        contents["coords" if name in dataset.coords else "fields"][str(name)] = entry
    return contents


def with_valid_time(dataset: Any) -> Any:
    """Return a dataset whose time axis is the valid time of its fields.

    A forecast run has one ``time`` and many ``step``: these become ``valid_time``.
    """
    if "step" in dataset.dims and "time" not in dataset.dims:
        return dataset.swap_dims({"step": "valid_time"}).drop_vars(
            ["step", "time"], errors="ignore"
        )
    if "step" in dataset.dims and "time" in dataset.dims:
        flat = dataset.stack(when=("time", "step")).reset_index("when", drop=True)
        flat = flat.swap_dims({"when": "valid_time"})
        return flat.sortby("valid_time").transpose("valid_time", ...)
    if "time" in dataset.dims and "valid_time" in dataset.coords and "step" in dataset.coords:
        return dataset.swap_dims({"time": "valid_time"}).drop_vars("time")
    return dataset


def json_attributes(attributes: dict[str, Any]) -> dict[str, Any]:
    """Return attributes that JSON can hold."""
    kept = {}
    for key, value in attributes.items():
        value = value.item() if isinstance(value, np.generic) else value
        if isinstance(value, (str, int, float, bool)):
            kept[str(key)] = value
    return kept


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]))
