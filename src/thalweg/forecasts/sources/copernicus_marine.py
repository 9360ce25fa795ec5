"""Copernicus Marine: global forecasts of currents, water level and waves at 1/12 degree.

The client ``copernicusmarine`` is used; it reads the account from its own file or from
``COPERNICUSMARINE_SERVICE_USERNAME`` and ``_PASSWORD``. Its ``subset`` needs memory as large as the
request, so the dataset is opened and read in slices of time. The service stamps means with the
start of their interval (https://help.marine.copernicus.eu/en/articles/8656000): the fields written
here have the middle. Not tried against the live service by the tests.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.time import format_time, to_datetime64
from thalweg.core.units import HOUR
from thalweg.forecasts.box_cut import cut_to_box, join_pieces, longitude_spans
from thalweg.forecasts.download_client import DownloadClient, TransferError
from thalweg.forecasts.download_plan import DownloadPlan
from thalweg.forecasts.forecast_request import ForecastRequest

_SPACING: Final = 1.0 / 12.0
_SLICE: Final = 8  #: times read at once


@dataclass(frozen=True)
class _Product:
    """A dataset: its name, variables, time between fields [s], and whether it has depths.

    Attributes
    ----------
    first : Time of fields after the start of their interval: half of it for means [s].
    """

    dataset: str
    variables: tuple[str, ...]
    step: float
    first: float
    depth: bool = False


_PRODUCTS: Final = {
    "current": _Product(
        "cmems_mod_glo_phy_anfc_0.083deg_PT1H-m", ("uo", "vo", "zos"), HOUR, 0.5 * HOUR, True
    ),
    "waves": _Product(
        "cmems_mod_glo_wav_anfc_0.083deg_PT3H-i", ("VHM0", "VMDR", "VTPK"), 3 * HOUR, 0.0
    ),
}


def _open_dataset(**wanted: Any) -> Any:
    try:
        import copernicusmarine
    except ImportError as error:
        raise InputError(
            "Copernicus Marine needs its client.",
            "It uses a free account (copernicusmarine login).",
            "pip install copernicusmarine",
        ) from error
    return copernicusmarine.open_dataset(**wanted)


@dataclass(frozen=True)
class CopernicusMarine:
    """Copernicus Marine global analysis and forecast.

    Parameters
    ----------
    open_dataset : ``copernicusmarine.open_dataset``, or one with its arguments.
    """

    open_dataset: Callable[..., Any] = _open_dataset
    name: str = "copernicus"
    title: str = "Copernicus Marine global analysis and forecast, 1/12 degree"
    licence: str = "Copernicus Marine Service licence (free with attribution)"
    attribution: str = "Generated using E.U. Copernicus Marine Service Information"
    quantities: tuple[str, ...] = ("current", "waves")

    def plan(self, request: ForecastRequest, client: DownloadClient, now: float) -> DownloadPlan:
        """Return what is downloaded; see `ForecastSource.plan`."""
        if request.run is not None:
            raise InputError(
                "A run was requested.",
                f"{self.title} gives its latest fields only.",
                "Leave it out.",
            )
        products = [_PRODUCTS[q] for q in request.quantities]
        offsets = {product.first for product in products}
        step = max(request.step, *(product.step for product in products))
        if len(offsets) > 1:
            raise InputError(
                "Currents and waves were requested in one file.",
                "Currents are means over hours, at half past; waves are at full hours.",
                "Fetch them into two files; a sea opens both.",
            )
        (offset,) = offsets
        first = (request.start - offset) // step * step + offset
        count = int(np.ceil((request.end - first) / step)) + 1
        times = tuple(first + step * k for k in range(count))
        names = tuple(name for product in products for name in product.variables)
        size = 4.0 * request.values(_SPACING, len(names), count)
        return DownloadPlan((), size, None, times, names)

    def read(self, request: ForecastRequest, plan: DownloadPlan, files: list[Path]) -> list[Any]:
        """Return the fields, read in slices of time; see `ForecastSource.read`."""
        box = request.box
        pieces = []
        for product in (_PRODUCTS[q] for q in request.quantities):
            sides = [self._side(product, request, plan, span) for span in longitude_spans(box)]
            whole = sides[0] if len(sides) == 1 else _side_by_side(sides)
            pieces.append(cut_to_box(whole, box))
        return join_pieces(pieces)

    def _side(
        self,
        product: _Product,
        request: ForecastRequest,
        plan: DownloadPlan,
        span: tuple[float, float],
    ) -> Any:
        """Return the fields between two longitudes, loaded."""
        import xarray as xr

        margin = 2.0 * _SPACING
        wanted: dict[str, Any] = {
            "dataset_id": product.dataset,
            "variables": list(product.variables),
            "minimum_longitude": max(span[0] - margin, -180.0),
            "maximum_longitude": min(span[1] + margin, 180.0),
            "minimum_latitude": request.box.south - margin,
            "maximum_latitude": request.box.north + margin,
            "start_datetime": format_time(plan.times[0] - product.first),
            "end_datetime": format_time(plan.times[-1]),
        }
        if product.depth:
            wanted |= {"minimum_depth": 0.0, "maximum_depth": 1.0}
        with _transfer_of(product):
            remote = self.open_dataset(**wanted)
        if "depth" in remote.dims:
            remote = remote.isel(depth=0, drop=True)
        given = remote["time"].values.astype("datetime64[s]").astype(float)
        stamps = given // product.step * product.step + product.first
        remote = remote.assign_coords(time=to_datetime64(stamps))
        at = [k for k, stamp in enumerate(stamps) if np.min(np.abs(stamp - plan.times)) < 60.0]
        if not at:
            return remote.isel(time=[])
        with _transfer_of(product):
            slices = [
                remote.isel(time=at[k : k + _SLICE]).load() for k in range(0, len(at), _SLICE)
            ]
        return xr.concat(slices, "time")


@contextmanager
def _transfer_of(product: _Product) -> Iterator[None]:
    """Report what the client of Copernicus Marine raises as an error of the transfer."""
    try:
        yield
    except InputError:
        raise
    except Exception as error:
        raise TransferError(
            f"Copernicus Marine did not deliver {product.dataset}: {str(error)[:300]}.",
            "An account and a network are needed (copernicusmarine login).",
            "Log in again, or try later.",
        ) from error


def _side_by_side(sides: list[Any]) -> Any:
    """Return the fields on both sides of the antimeridian as one; a shared meridian once."""
    import xarray as xr

    east = sides[1].assign_coords(longitude=sides[1]["longitude"] + 360.0)
    return xr.concat([sides[0], east], "longitude").drop_duplicates("longitude")
