"""The sources of forecasts; each plans its downloads and reads what arrives."""
