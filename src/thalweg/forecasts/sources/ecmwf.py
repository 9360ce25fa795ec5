"""Open data of ECMWF: the IFS with waves, and its ensemble, 0.25 degrees.

Fields are cut out of global files by the ranges of bytes in the ``.index`` file beside each
(https://confluence.ecmwf.int/display/DAC/ECMWF+open+data). Runs of 00 and 12 UTC.
"""

from __future__ import annotations

import datetime
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from thalweg.core.errors import InputError
from thalweg.core.time import format_time
from thalweg.core.units import HOUR
from thalweg.forecasts.box_cut import read_grib_files
from thalweg.forecasts.download_client import DownloadClient, DownloadPart
from thalweg.forecasts.download_plan import DownloadPlan
from thalweg.forecasts.forecast_request import ForecastRequest
from thalweg.forecasts.sources.gfs import joined_ranges

LEAD_HOURS: Final = (*range(0, 144, 3), *range(144, 361, 6))
_CYCLE: Final = 12 * HOUR
_BACK: Final = 4
_MOST_MEMBERS: Final = 50
#: Parameter in the index and variable after decoding, by quantity.
_ATMOSPHERE: Final = {
    "wind": (("10u", "u10"), ("10v", "v10")),
    "pressure": (("msl", "msl"),),
}
_WAVES: Final = {"waves": (("swh", "swh"), ("mwd", "mwd"), ("pp1d", "pp1d"))}
_STREAMS: Final = {"atmosphere": ("oper", "enfo"), "waves": ("wave", "waef")}


@dataclass(frozen=True)
class EcmwfOpenData:
    """Open data of ECMWF; with ``members`` the perturbed members of the ensemble.

    Parameters
    ----------
    root : Address of the server.
    """

    root: str = "https://data.ecmwf.int/forecasts"
    name: str = "ecmwf"
    title: str = "ECMWF open data, IFS 0.25 degrees"
    licence: str = "CC BY 4.0, with the ECMWF terms of use"
    attribution: str = "Contains ECMWF open data (www.ecmwf.int), modified"
    quantities: tuple[str, ...] = ("wind", "waves", "pressure")

    def plan(self, request: ForecastRequest, client: DownloadClient, now: float) -> DownloadPlan:
        """Return what is downloaded; see `ForecastSource.plan`."""
        if request.members > _MOST_MEMBERS:
            raise InputError(
                f"{request.members} members were requested.",
                f"The ensemble has {_MOST_MEMBERS} perturbed members.",
                "Give a smaller number.",
            )
        groups = {
            "atmosphere": [f for q in request.quantities for f in _ATMOSPHERE.get(q, ())],
            "waves": [f for q in request.quantities for f in _WAVES.get(q, ())],
        }
        used = {kind: fields for kind, fields in groups.items() if fields}
        run = self._run(request, client, now, list(used))
        hours = request.steps(run, LEAD_HOURS)
        parts = []
        for kind, fields in used.items():
            for hour in hours:
                label = f"{kind} at {format_time(run + hour * HOUR)}"
                url = self._file(run, hour, kind, request.members)
                names = [name for name, _ in fields]
                index = client.text(url.removesuffix(".grib2") + ".index")
                parts.append(
                    DownloadPart(url, _ranges(index, names, request.members, label), label)
                )
        return DownloadPlan(
            tuple(parts),
            float(sum(count for part in parts for _, count in part.ranges)),
            run,
            tuple(run + hour * HOUR for hour in hours),
            tuple(decoded for fields in used.values() for _, decoded in fields),
        )

    def read(self, request: ForecastRequest, plan: DownloadPlan, files: list[Path]) -> list[Any]:
        """Return the fields of downloaded files; see `ForecastSource.read`."""
        return read_grib_files(files, request.box)

    def _run(
        self, request: ForecastRequest, client: DownloadClient, now: float, kinds: list[str]
    ) -> float:
        """Return the latest complete run that is not after the start of the period."""
        if request.run is not None:
            return request.run
        newest = min(now, request.start) // _CYCLE * _CYCLE
        for back in range(_BACK):
            run = newest - back * _CYCLE
            hour = request.steps(run, LEAD_HOURS)[-1]
            last = (self._file(run, hour, kind, request.members) for kind in kinds)
            if all(client.text(url.removesuffix(".grib2") + ".index") for url in last):
                return run
        raise InputError(
            f"No complete run of {self.title} was found for {format_time(request.start)}.",
            "The server keeps runs of about four days; those of 00 and 12 UTC reach 15 days and "
            "are complete about 8 hours after their start.",
            "Choose another period, or give a run.",
        )

    def _file(self, run: float, hour: int, kind: str, members: int) -> str:
        start = datetime.datetime.fromtimestamp(run, datetime.UTC)
        stream = _STREAMS[kind][1 if members else 0]
        suffix = "ef" if members else "fc"
        return (
            f"{self.root}/{start:%Y%m%d}/{start:%H}z/ifs/0p25/{stream}/"
            f"{start:%Y%m%d%H}0000-{hour}h-{stream}-{suffix}.grib2"
        )


def _ranges(
    index: str | None, names: list[str], members: int, label: str
) -> tuple[tuple[int, int], ...]:
    """Return the ranges of bytes of the fields that an ``.index`` file lists."""
    numbers = {str(number) for number in range(1, members + 1)} or {"0"}
    wanted = {(name, number) for name in names for number in numbers}
    ranges: dict[tuple[str, str], tuple[int, int]] = {}
    for line in (index or "").splitlines():
        try:
            entry = json.loads(line)
            place = int(entry["_offset"]), int(entry["_length"])
            key = str(entry["param"]), str(entry.get("number", "0"))
        except (ValueError, KeyError, TypeError):
            continue
        if key in wanted and entry.get("levtype", "sfc") == "sfc":
            ranges[key] = place
    missing = sorted(wanted - set(ranges))
    if missing:
        which = ", ".join(f"{name} of member {number}" for name, number in missing[:5])
        raise InputError(
            f"The index of {label} does not list {which}"
            f"{' and others' if len(missing) > 5 else ''}.",
            "A run is complete about 8 hours after its start.",
            "Choose an earlier run, other quantities or fewer members.",
        )
    return joined_ranges(list(ranges.values()))
