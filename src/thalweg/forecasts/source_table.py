"""The sources by name."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

from thalweg.forecasts.download_plan import ForecastSource
from thalweg.forecasts.sources.copernicus_marine import CopernicusMarine
from thalweg.forecasts.sources.ecmwf import EcmwfOpenData
from thalweg.forecasts.sources.era5 import Era5
from thalweg.forecasts.sources.gfs import Gfs
from thalweg.forecasts.sources.matroos import Matroos
from thalweg.forecasts.sources.open_meteo import OpenMeteo
from thalweg.forecasts.sources.rws_station import RwsStation

SOURCES: Final[Mapping[str, ForecastSource]] = MappingProxyType(
    {
        source.name: source
        for source in (
            Gfs(),
            EcmwfOpenData(),
            OpenMeteo(),
            Matroos(),
            RwsStation(),
            CopernicusMarine(),
            Era5(),
        )
    }
)

_USUAL: Final[Mapping[str, tuple[str, ...]]] = {
    "matroos": ("current",),
    "rws": ("level",),
    "copernicus": ("current",),
}


def usual_quantities(source: str) -> tuple[str, ...]:
    """Return what is fetched from a source where nothing is chosen.

    Parameters
    ----------
    source : Name of the source.
    """
    return _USUAL.get(source, ("wind", "waves"))
