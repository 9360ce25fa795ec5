"""Wind that raises known waves."""

import numpy as np
import pytest

from thalweg import InputError, Sea
from thalweg.core.errors import MissingVariableError
from thalweg.planning.request.requirements import check_variables
from thalweg.sea import standard_names as nm
from thalweg.sea.models.wind_of_waves import carter_1982_wind
from thalweg.sea.models.wind_sea import carter_1982
from thalweg.ship import Ship

HEIGHT = {nm.WAVE_HEIGHT: lambda t, y, x: np.where(y > 50.0, np.nan, 4.0) + 0.0 * t}
WAVES = {**HEIGHT, "sea_surface_wave_from_direction": lambda t, y, x: 270.0 + 0.0 * y}
KWON = "handysize-bulker"


@pytest.mark.parametrize(("fetch", "duration"), [(5e5, 86400.0), (1e5, 86400.0), (1e7, 21600.0)])
def test_wind_and_waves_are_inverse(fetch, duration):
    wind = np.linspace(0.0, 40.0, 81)
    height, _ = carter_1982(wind, fetch=fetch, duration=duration)
    assert carter_1982_wind(height, fetch=fetch, duration=duration) == pytest.approx(wind)
    assert float(carter_1982_wind(4.0)) == pytest.approx(13.46, abs=0.01)  # of the duration
    assert float(carter_1982_wind(2.48)) == pytest.approx(10.0)  # fully developed


def test_the_wind_blows_with_the_waves_and_is_unknown_where_they_are():
    sea = Sea.from_functions(WAVES).filled(wind="waves")
    got = sea.sample(list(nm.WIND.pair), 0.0, np.array([45.0, 55.0]), np.zeros(2))
    assert got[nm.EASTWARD_WIND][0] == pytest.approx(13.46, abs=0.01)
    assert got[nm.NORTHWARD_WIND][0] == pytest.approx(0.0, abs=1e-9)
    assert all(np.isnan(values[1]) for values in got.values())
    assert any("the wind is that which raises the known waves" in text for text in sea.assumptions)


def test_known_wind_has_priority_and_still_water_has_none():
    known = {nm.EASTWARD_WIND: lambda t, y, x: 3.0, nm.NORTHWARD_WIND: lambda t, y, x: 4.0}
    sea = Sea.from_functions({**WAVES, **known}).filled(wind="waves")
    assert sea.sample([nm.EASTWARD_WIND], 0.0, 45.0, 0.0)[nm.EASTWARD_WIND] == 3.0
    calm = Sea.from_functions(WAVES | {nm.WAVE_HEIGHT: lambda t, y, x: 0.0}).filled(wind="waves")
    assert calm.sample([nm.EASTWARD_WIND], 0.0, 45.0, 0.0)[nm.EASTWARD_WIND] == 0.0


def test_waves_without_direction_give_no_wind():
    for sea in (Sea.from_functions(HEIGHT), Sea.from_functions(HEIGHT).filled(waves="head_seas")):
        with pytest.raises(InputError, match="no direction of the waves"):
            sea.filled(wind="waves")
    with pytest.raises(InputError, match="holds no waves"):
        Sea.from_functions({}).filled(wind="waves")


@pytest.mark.parametrize(
    ("functions", "remedy"),
    [
        (WAVES, "--fill wind=waves (that which raises the known waves)."),
        (HEIGHT, "--fill wind=EAST,NORTH (towards, in m/s; the known waves have no direction"),
    ],
)
def test_calm_wind_is_not_advised_beside_known_waves(functions, remedy):
    """It was: the ship then sailed in 4 m waves as in a calm."""
    with pytest.raises(MissingVariableError) as found:
        check_variables(Ship.load(KWON), Sea.from_functions(functions))
    assert remedy in found.value.remedy and "wind=0" not in found.value.remedy
