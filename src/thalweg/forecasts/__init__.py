"""Forecasts from public servers, cut to a box and written as one file that a sea opens.

`fetch_forecast` downloads; the sources are in `thalweg.forecasts.sources`.
"""

from thalweg.forecasts.fetching import FetchedForecast, estimate_forecast, fetch_forecast
from thalweg.forecasts.forecast_request import QUANTITIES, ForecastRequest

__all__ = [
    "QUANTITIES",
    "FetchedForecast",
    "ForecastRequest",
    "estimate_forecast",
    "fetch_forecast",
]
