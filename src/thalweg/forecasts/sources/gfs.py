"""GFS and GFS-wave of the United States National Weather Service, 0.25 degrees.

Fields are cut out of the global files by the ranges of bytes that the ``.idx`` file beside each
lists (https://www.nco.ncep.noaa.gov/pmb/products/gfs/), or cut to the box by the server
(``nomads``: fewer bytes, but only the runs of the last ten days).
"""

from __future__ import annotations

import datetime
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final
from urllib.parse import urlencode

from thalweg.core.errors import InputError
from thalweg.core.time import format_time
from thalweg.core.units import HOUR
from thalweg.forecasts.box_cut import read_grib_files
from thalweg.forecasts.download_client import DownloadClient, DownloadPart
from thalweg.forecasts.download_plan import DownloadPlan
from thalweg.forecasts.forecast_request import ForecastRequest

LEAD_HOURS: Final = (*range(0, 120), *range(120, 385, 3))
_CYCLE: Final = 6 * HOUR
_BACK: Final = 6  #: runs that are tried
_BYTES_PER_VALUE: Final = 1.5  #: of packed GRIB fields, measured on fields of 0.25 degrees


@dataclass(frozen=True)
class _Field:
    """A field of a file: its names in the index, on the server, and after decoding."""

    index: str
    name: str
    level: str
    decoded: str


_WIND = (
    _Field("UGRD:10 m above ground", "UGRD", "lev_10_m_above_ground", "u10"),
    _Field("VGRD:10 m above ground", "VGRD", "lev_10_m_above_ground", "v10"),
)
_ATMOSPHERE: Final = {
    "wind": _WIND,
    "pressure": (_Field("PRMSL:mean sea level", "PRMSL", "lev_mean_sea_level", "prmsl"),),
    "ice": (_Field("ICEC:surface", "ICEC", "lev_surface", "siconc"),),
}
_WAVES: Final = {
    "waves": (
        _Field("HTSGW:surface", "HTSGW", "lev_surface", "swh"),
        _Field("PERPW:surface", "PERPW", "lev_surface", "perpw"),
        _Field("DIRPW:surface", "DIRPW", "lev_surface", "dirpw"),
    )
}


@dataclass(frozen=True)
class Gfs:
    """GFS (wind, pressure, ice) and GFS-wave.

    Parameters
    ----------
    server : {"nomads", "aws"}
        ``nomads`` cuts the box on the server; ``aws`` keeps runs since 2021 and gives whole fields.
    nomads, aws : Addresses of the servers.
    """

    server: str = "nomads"
    nomads: str = "https://nomads.ncep.noaa.gov"
    aws: str = "https://noaa-gfs-bdp-pds.s3.amazonaws.com"
    name: str = "gfs"
    title: str = "GFS and GFS-wave, 0.25 degrees, NOAA/NCEP"
    licence: str = "public domain (United States government)"
    attribution: str = "NOAA/NCEP Global Forecast System"
    quantities: tuple[str, ...] = ("wind", "waves", "pressure", "ice")

    def plan(self, request: ForecastRequest, client: DownloadClient, now: float) -> DownloadPlan:
        """Return what is downloaded; see `ForecastSource.plan`."""
        groups = {
            "atmosphere": [f for q in request.quantities for f in _ATMOSPHERE.get(q, ())],
            "waves": [f for q in request.quantities for f in _WAVES.get(q, ())],
        }
        run = self._run(request, client, now, waves=bool(groups["waves"]))
        hours = request.steps(run, LEAD_HOURS)
        parts: list[DownloadPart] = []
        for kind, fields in groups.items():
            for hour in hours if fields else ():
                label = f"{kind} at {format_time(run + hour * HOUR)}"
                parts.append(self._part(request, client, run, hour, kind, fields, label))
        fields = [field for group in groups.values() for field in group]
        size = sum(float(count) for part in parts for _, count in part.ranges)
        if self.server == "nomads":
            size = _BYTES_PER_VALUE * request.values(0.25, len(fields), len(hours))
        return DownloadPlan(
            tuple(parts),
            size,
            run,
            tuple(run + hour * HOUR for hour in hours),
            tuple(field.decoded for field in fields),
        )

    def read(self, request: ForecastRequest, plan: DownloadPlan, files: list[Path]) -> list[Any]:
        """Return the fields of downloaded files; see `ForecastSource.read`."""
        return read_grib_files(files, request.box)

    def _run(
        self, request: ForecastRequest, client: DownloadClient, now: float, *, waves: bool
    ) -> float:
        """Return the latest complete run that is not after the start of the period."""
        if request.run is not None:
            return request.run
        newest = min(now, request.start) // _CYCLE * _CYCLE
        for back in range(_BACK):
            run = newest - back * _CYCLE
            hour = min(request.steps(run, LEAD_HOURS)[-1], LEAD_HOURS[-1])
            kinds = ("atmosphere", "waves") if waves else ("atmosphere",)
            if all(client.text(self._file(run, hour, kind) + ".idx") for kind in kinds):
                return run
        raise InputError(
            f"No complete run of {self.title} was found on {self.server} for "
            f"{format_time(request.start)}.",
            "nomads keeps runs of about ten days, aws since 2021; runs start every 6 hours and are "
            "complete about 5 hours later.",
            "Choose another period, or give a run.",
        )

    def _file(self, run: float, hour: int, kind: str) -> str:
        """Return the address of a file on the server that lists it."""
        root = self.aws if self.server == "aws" else f"{self.nomads}/pub/data/nccf/com/gfs/prod"
        folder, file = _place(run, hour, kind)
        return f"{root}{folder}/{file}"

    def _part(
        self,
        request: ForecastRequest,
        client: DownloadClient,
        run: float,
        hour: int,
        kind: str,
        fields: list[_Field],
        label: str,
    ) -> DownloadPart:
        if self.server == "nomads":
            return DownloadPart(self._filtered(request, run, hour, kind, fields), (), label)
        url = self._file(run, hour, kind)
        index = client.text(url + ".idx")
        if index is None:
            raise InputError(
                f"The run of {format_time(run)} has no {label}.",
                "Runs are complete about 5 hours after their start.",
                "Choose an earlier run.",
            )
        return DownloadPart(url, byte_ranges(index, [field.index for field in fields]), label)

    def _filtered(
        self, request: ForecastRequest, run: float, hour: int, kind: str, fields: list[_Field]
    ) -> str:
        """Return the address of the fields in the box, cut by the server."""
        script = "filter_gfs_0p25.pl" if kind == "atmosphere" else "filter_gfswave.pl"
        folder, file = _place(run, hour, kind)
        box = request.box
        west = box.west % 360.0
        query = {
            "dir": folder,
            "file": file,
            **{f"var_{field.name}": "on" for field in fields},
            **{field.level: "on" for field in fields},
            "subregion": "",
            "toplat": f"{box.north + 0.25:g}",
            "leftlon": f"{west - 0.25:g}",
            "rightlon": f"{west + box.width + 0.25:g}",
            "bottomlat": f"{box.south - 0.25:g}",
        }
        return f"{self.nomads}/cgi-bin/{script}?{urlencode(query)}"


def _place(run: float, hour: int, kind: str) -> tuple[str, str]:
    """Return the folder and the name of a file."""
    start = datetime.datetime.fromtimestamp(run, datetime.UTC)
    cycle = f"{start:%H}"
    folder = f"/gfs.{start:%Y%m%d}/{cycle}"
    if kind == "atmosphere":
        return f"{folder}/atmos", f"gfs.t{cycle}z.pgrb2.0p25.f{hour:03d}"
    return f"{folder}/wave/gridded", f"gfswave.t{cycle}z.global.0p25.f{hour:03d}.grib2"


def byte_ranges(index: str, wanted: list[str]) -> tuple[tuple[int, int], ...]:
    """Return the ranges of bytes of fields that an ``.idx`` file lists.

    Parameters
    ----------
    index : Lines ``number:first byte:d=run:NAME:level:lead time:``.
    wanted : ``NAME:level`` of each field.

    Returns
    -------
    tuple of (int, int) : First byte and number of bytes; adjacent ranges are joined. The last field
        of a file has no stated end; its range is -1.

    Raises
    ------
    InputError : If a field is not listed.
    """
    lines = [line.split(":") for line in index.splitlines() if line.count(":") >= 5]
    starts = sorted({int(line[1]) for line in lines} | {0})
    ranges: dict[str, tuple[int, int]] = {}
    for line in lines:
        key = f"{line[3]}:{line[4]}"
        if key in wanted and key not in ranges:
            first = int(line[1])
            after = [start for start in starts if start > first]
            ranges[key] = (first, after[0] - first if after else -1)
    missing = [key for key in wanted if key not in ranges]
    if missing:
        raise InputError(
            f"The index of the file does not list {', '.join(missing)}.",
            "It lists " + ", ".join(sorted({f"{line[3]}" for line in lines})[:20]) + ".",
            "Choose other quantities or another run.",
        )
    return joined_ranges(list(ranges.values()))


def joined_ranges(ranges: list[tuple[int, int]]) -> tuple[tuple[int, int], ...]:
    """Return ranges of bytes in order, with adjacent ones joined.

    Parameters
    ----------
    ranges : list of (int, int)
        First byte and number of bytes; -1: to the end.

    Returns
    -------
    tuple of (int, int)
    """
    joined: list[tuple[int, int]] = []
    for first, count in sorted(set(ranges)):
        before = joined[-1] if joined else None
        if before is not None and before[0] + before[1] == first:
            joined[-1] = (before[0], -1 if count < 0 else before[1] + count)
        else:
            joined.append((first, count))
    return tuple(joined)
