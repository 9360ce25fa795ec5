"""Coefficients of the Wageningen B-series, for `thalweg.ship.methods.propulsion.b_series`.

Source: M.W.C. Oosterveld and P. van Oossanen, "Further computer-analyzed data of the Wageningen
B-screw series", International Shipbuilding Progress 22 (1975) 251-262; in the data file
``b_series_coefficients.csv``.
"""

from __future__ import annotations

import csv
from functools import cache
from importlib import resources
from typing import Literal

import numpy as np

from thalweg.core.types import FloatArray

SeriesQuantity = Literal["thrust", "torque", "thrust_reynolds", "torque_reynolds"]
_COLUMNS = ("coefficient", "advance_ratio", "pitch_ratio", "area_ratio", "blades", "log_reynolds")


@cache
def polynomial_terms(quantity: SeriesQuantity) -> FloatArray:
    """Return the terms of one polynomial of the B-series.

    Parameters
    ----------
    quantity : {"thrust", "torque", "thrust_reynolds", "torque_reynolds"}
        K_T or K_Q at Rn = 2e6, or the Reynolds correction of one of them.

    Returns
    -------
    ndarray
        Shape ``(terms, 6)``: the coefficient, and the powers of J, P/D, A_E/A_0, Z and
        log10(Rn) - 0.301; read-only.
    """
    file = resources.files("thalweg.ship.methods").joinpath("data", "b_series_coefficients.csv")
    lines = file.read_text(encoding="utf-8").splitlines()
    rows = [row for row in csv.DictReader(lines) if row["quantity"] == quantity]
    terms = np.array([[float(row[column]) for column in _COLUMNS] for row in rows])
    terms.flags.writeable = False
    return terms
