"""What ``thalweg inspect`` prints of a file of the sea."""

import numpy as np
import pytest
import xarray as xr

from thalweg.cli.main import main


@pytest.mark.parametrize(
    ("empty", "text"),
    [
        (slice(None), "EMPTY: no value at the positions and times that were read"),
        (slice(0, 1), "no value at 25.0 % of the positions"),
        (slice(0, 0), None),
    ],
)
def test_an_empty_variable_is_called_empty(tmp_path, capsys, empty, text):
    height = np.full((2, 4, 3), 1.5)
    height[:, empty] = np.nan
    xr.Dataset(
        {
            "swh": (
                ("time", "latitude", "longitude"),
                height,
                {"units": "m", "standard_name": "sea_surface_wave_significant_height"},
            )
        },
        {
            "time": np.array(["2026-01-01", "2026-01-02"], "datetime64[ns]"),
            "latitude": ("latitude", [50.0, 51.0, 52.0, 53.0], {"units": "degrees_north"}),
            "longitude": ("longitude", [1.0, 2.0, 3.0], {"units": "degrees_east"}),
        },
    ).to_netcdf(tmp_path / "waves.nc")
    assert main(["inspect", str(tmp_path / "waves.nc")]) == 0
    out = capsys.readouterr().out
    values = out[out.index("Coverage") :]
    line = next(line for line in values.splitlines() if "sea_surface_wave" in line)
    assert ("no value" in line) == (text is not None)
    assert text is None or text in line
