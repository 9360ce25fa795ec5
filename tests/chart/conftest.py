"""Charts that several test modules share."""

from __future__ import annotations

import pytest

from thalweg.chart import Chart


@pytest.fixture(scope="session")
def world() -> Chart:
    return Chart.gshhg("i")
