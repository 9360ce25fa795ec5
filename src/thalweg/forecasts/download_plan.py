"""What a source downloads for a request, and the protocol of sources."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Protocol

from thalweg.forecasts.download_client import DownloadClient, DownloadPart
from thalweg.forecasts.forecast_request import ForecastRequest


@dataclass(frozen=True)
class DownloadPlan:
    """What is downloaded for a request.

    Attributes
    ----------
    bytes : Size of the download [bytes]; an estimate where the server does not state it.
    run : Start of the forecast run [s since 1970]; None where the source names none.
    times : Times that the result must have [s since 1970].
    variables : Names of the variables that the result must have.
    """

    parts: tuple[DownloadPart, ...]
    bytes: float
    run: float | None
    times: tuple[float, ...]
    variables: tuple[str, ...]
    notes: tuple[str, ...] = field(default=())


class ForecastSource(Protocol):
    """A public source of forecasts."""

    @property
    def name(self) -> str:
        """Short name on the command line."""
        ...

    @property
    def title(self) -> str:
        """Full name."""
        ...

    @property
    def licence(self) -> str:
        """Terms of use."""
        ...

    @property
    def attribution(self) -> str:
        """Words that the terms require."""
        ...

    @property
    def quantities(self) -> tuple[str, ...]:
        """What it has, of `thalweg.forecasts.QUANTITIES`."""
        ...

    def plan(self, request: ForecastRequest, client: DownloadClient, now: float) -> DownloadPlan:
        """Return what is downloaded; only indexes are read.

        Parameters
        ----------
        now : The present [s since 1970].

        Raises
        ------
        InputError : If the source does not have what is requested.
        """
        ...

    def read(self, request: ForecastRequest, plan: DownloadPlan, files: list[Path]) -> list[Any]:
        """Return the fields of downloaded files, one dataset per grid, cut to the box.

        Parameters
        ----------
        files : One per part of the plan.

        Returns
        -------
        list of xarray.Dataset
            With ``time``, ``latitude`` and ``longitude``, and ``number`` for ensembles.
        """
        ...


Progress = Callable[[str], None]
