"""Wind resistance and published coefficient curves.

Angles of the relative wind are those between the bow and where the wind comes from, 0 for a head
wind, pi for a following one; port and starboard are equal. Coefficients C_AA refer to the frontal
area above the water and are positive where the wind resists.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.file_reading import table_rows
from thalweg.core.types import FloatArray

AIR_DENSITY: Final = 1.226  #: at 15 degC and 1013 hPa [kg/m3]


def wind_resistance(
    relative_speed: ArrayLike,
    coefficient: ArrayLike,
    *,
    frontal_area: ArrayLike,
    density: float = AIR_DENSITY,
) -> FloatArray:
    r"""Wind resistance, negative where the wind pushes.

    .. math:: R_{AA} = \frac{1}{2} \rho_A A_{XV} V_{WR}^2 C_{AA}(\psi)

    Parameters
    ----------
    relative_speed : Relative wind [m/s].
    coefficient : C_AA at the angle of the relative wind.
    frontal_area : A_XV [m2].
    density : Of air [kg/m3].

    Returns
    -------
    ndarray [N]

    References
    ----------
    ISO 15016:2015, Annex C; ITTC 7.5-04-01-01.1. A trial curve without the resistance of calm air
    adds its term, - V_G^2 C_AA(0); resistance formulas for deep calm water do not contain it.
    """
    pressure = 0.5 * density * np.asarray(frontal_area, dtype=float)
    squared = np.asarray(relative_speed, dtype=float) ** 2
    return np.asarray(pressure * squared * np.asarray(coefficient))


def fold_angle_off_bow(angle: ArrayLike) -> FloatArray:
    """Angle from the bow folded to 0 ... pi, so that port and starboard are equal [rad]."""
    return np.asarray(
        np.abs(np.remainder(np.asarray(angle, dtype=float) + np.pi, 2 * np.pi) - np.pi)
    )


@dataclass(frozen=True)
class FujiwaraShip:
    """Above-water particulars for `fujiwara_2006`.

    Attributes
    ----------
    length_overall, breadth : L_OA and B [m].
    frontal_area, lateral_area, deck_area : float
        Frontal area A_XV, lateral area A_YV, and lateral area A_OD of superstructures on deck [m2].
    superstructure_height : h_BR, top of the superstructure above the water [m].
    area_centre_forward : C_MC, centre of A_YV forward of midships [m].
    area_centre_height : h_C, centre of A_YV above the water [m].
    """

    length_overall: float
    breadth: float
    frontal_area: float
    lateral_area: float
    deck_area: float
    superstructure_height: float
    area_centre_forward: float
    area_centre_height: float


def _fujiwara(angle: FloatArray, parts: tuple[float, float, float]) -> FloatArray:
    linear, induced, along = parts
    sine, cosine = np.sin(angle), np.cos(angle)
    return np.asarray(
        linear * cosine
        + induced * (sine - 0.5 * sine * cosine**2) * sine * cosine
        + along * sine * cosine**3
    )


def fujiwara_2006(wind_angle: ArrayLike, ship: FujiwaraShip) -> FloatArray:
    r"""C_AA of Fujiwara, Ueno and Ikeda (2005, 2006), as in ITTC 7.5-04-01-01.1 and ISO 15016.

    .. math::
        C_{AA} = C_{LF} \cos\psi + C_{XLI} \left(\sin\psi - \frac{1}{2} \sin\psi
            \cos^2\psi\right) \sin\psi \cos\psi + C_{ALF} \sin\psi \cos^3\psi \\
        \psi < 90^\circ: C_{LF} = 0.922 - 0.507 \frac{A_{YV}}{L_{OA} B} - 1.162
            \frac{C_{MC}}{L_{OA}}, \quad C_{XLI} = -0.458 - 3.245 \frac{A_{YV}}{L_{OA}
            h_{BR}} + 2.313 \frac{A_{XV}}{B h_{BR}}, \\
        C_{ALF} = 0.585 + 0.906 \frac{A_{OD}}{A_{YV}} - 3.239 \frac{B}{L_{OA}} \\
        \psi > 90^\circ: C_{LF} = -0.018 + 5.091 \frac{B}{L_{OA}} - 10.367
            \frac{h_C}{L_{OA}} + 3.011 \frac{A_{OD}}{L_{OA}^2} + 0.341 \frac{A_{XV}}{B^2},
            \\
        C_{XLI} = 1.901 - 12.727 \frac{A_{YV}}{L_{OA} h_{BR}} - 24.407 \frac{A_{XV}}{A_{YV}}
            + 40.310 \frac{B}{L_{OA}} + 5.481 \frac{A_{XV}}{B h_{BR}}, \quad C_{ALF} = 0.314
            + 1.117 \frac{A_{OD}}{A_{YV}}

    Parameters
    ----------
    wind_angle : array_like
        Angle of the relative wind [rad].
    ship : FujiwaraShip
        Above-water particulars.

    Returns
    -------
    ndarray
        The head branch up to 80 degrees, the stern branch from 100 degrees, and a straight line
        between: at 90 degrees the mean of both, as in the procedure.

    References
    ----------
    T. Fujiwara, M. Ueno, Y. Ikeda (2005, 2006); ITTC 7.5-04-01-01.1; ISO 15016:2015, Annex C.
    """
    length, breadth = ship.length_overall, ship.breadth
    lateral, frontal, deck = ship.lateral_area, ship.frontal_area, ship.deck_area
    side, front = lateral / (length * ship.superstructure_height), breadth / length
    face = frontal / (breadth * ship.superstructure_height)
    head = (
        0.922 - 0.507 * lateral / (length * breadth) - 1.162 * ship.area_centre_forward / length,
        -0.458 - 3.245 * side + 2.313 * face,
        0.585 + 0.906 * deck / lateral - 3.239 * front,
    )
    stern = (
        -0.018
        + 5.091 * front
        - 10.367 * ship.area_centre_height / length
        + 3.011 * deck / length**2
        + 0.341 * frontal / breadth**2,
        1.901 - 12.727 * side - 24.407 * frontal / lateral + 40.310 * front + 5.481 * face,
        0.314 + 1.117 * deck / lateral,
    )
    angle = fold_angle_off_bow(wind_angle)
    first, last = np.radians(80.0), np.radians(100.0)
    before = _fujiwara(np.minimum(angle, first), head)
    after = _fujiwara(np.maximum(angle, last), stern)
    part = np.clip((angle - first) / (last - first), 0.0, 1.0)
    return np.asarray((1.0 - part) * before + part * after)


@dataclass(frozen=True)
class BlendermannType:
    """Coefficients of one type of ship (Blendermann 1994).

    Attributes
    ----------
    transverse : CD_t.
    bow, stern : CD_l on the frontal area, for winds from ahead and from astern.
    cross_force : delta.
    """

    transverse: float
    bow: float
    stern: float
    cross_force: float


BLENDERMANN: Final = MappingProxyType(
    {
        "car_carrier": BlendermannType(0.95, 0.55, 0.60, 0.80),
        "cargo_loaded": BlendermannType(0.85, 0.65, 0.55, 0.40),
        "container_loaded": BlendermannType(0.90, 0.55, 0.55, 0.40),
        "ferry": BlendermannType(0.90, 0.45, 0.50, 0.80),
        "lng_tanker": BlendermannType(0.70, 0.60, 0.65, 0.50),
        "offshore_supply": BlendermannType(0.90, 0.55, 0.80, 0.55),
        "cruise": BlendermannType(0.90, 0.40, 0.40, 0.80),
        "research": BlendermannType(0.85, 0.55, 0.65, 0.60),
        "tanker_loaded": BlendermannType(0.70, 0.90, 0.55, 0.40),
        "tanker_ballast": BlendermannType(0.70, 0.75, 0.55, 0.40),
    }
)


def blendermann_1994(
    wind_angle: ArrayLike,
    *,
    frontal_area: ArrayLike,
    lateral_area: ArrayLike,
    ship_type: BlendermannType,
) -> FloatArray:
    r"""C_AA of W. Blendermann, "Parameter identification of wind loads on ships" (1994).

    .. math::
        C_{AA} = \frac{C_{Dl,AF} \cos\epsilon}{1 - \frac{\delta}{2} \left(1 -
            \frac{C_{Dl}}{C_{Dt}}\right) \sin^2 2\epsilon}, \quad C_{Dl} = C_{Dl,AF} A_F /
            A_L

    C_AA = CD_l,AF cos e / [1 - delta/2 (1 - CD_l / CD_t) sin^2 2e], CD_l = CD_l,AF A_F / A_L.

    Parameters
    ----------
    wind_angle : Angle of the relative wind [rad].
    frontal_area, lateral_area : A_F and A_L [m2].
    ship_type : One of `BLENDERMANN`.

    References
    ----------
    W. Blendermann, "Parameter identification of wind loads on ships", J. Wind Engineering and
    Industrial Aerodynamics 51 (1994) 339-351.
    """
    angle = fold_angle_off_bow(wind_angle)
    drag = np.where(angle <= 0.5 * np.pi, ship_type.bow, ship_type.stern)
    ratio = np.asarray(frontal_area, dtype=float) / np.asarray(lateral_area)
    slack = 0.5 * ship_type.cross_force * (1.0 - drag * ratio / ship_type.transverse)
    return np.asarray(drag * np.cos(angle) / (1.0 - slack * np.sin(2.0 * angle) ** 2))


def _ittc_curves() -> Mapping[str, tuple[FloatArray, FloatArray]]:
    curves: dict[str, list[tuple[float, float]]] = {}
    for row in table_rows("thalweg.ship.methods", "ittc_wind_curves.csv"):
        point = float(row["angle_deg"]), float(row["coefficient"])
        curves.setdefault(row["curve"], []).append(point)
    return {name: (*np.array(points).T,) for name, points in curves.items()}


#: Angles [deg] and C_AA of the data sets of ISO 15016:2015 and ITTC 7.5-04-01-01.1. The curves
#: ``tanker_laden``, ``general_cargo`` and ``container_laden_no_boxes`` agree within 0.04 between
#: two independent transcriptions; ``tanker_ballast`` and ``container_laden`` are one reading of
#: the printed charts and unverified; the other curves of the standard were not found.
ITTC_CURVES: Final = MappingProxyType(_ittc_curves())


def ittc_curve(wind_angle: ArrayLike, *, curve: str = "tanker_laden") -> FloatArray:
    """C_AA of the data sets of ISO 15016:2015 and ITTC 7.5-04-01-01.1, linear between their points.

    Parameters
    ----------
    wind_angle : Angle of the relative wind [rad].
    curve : Key of `ITTC_CURVES`: tanker of 280 kDWT with a conventional bow (laden, in ballast),
        general cargo, and a container ship of 6800 TEU (laden with boxes, and laden without boxes
        but with lashing bridges).
    """
    degrees, values = ITTC_CURVES[curve]
    return np.asarray(np.interp(fold_angle_off_bow(wind_angle), np.radians(degrees), values))


def yu_2021_area(breadth: ArrayLike, *, draught_aft: ArrayLike) -> FloatArray:
    """Frontal area 0.8 B T_A of Yu (2021) [m2]; a rule of thumb, it uses the draught.

    Parameters
    ----------
    breadth : Breadth B [m].
    draught_aft : Draught aft T_A [m].

    Returns
    -------
    ndarray : Area [m2].
    """
    return np.asarray(0.8 * np.asarray(breadth, dtype=float) * np.asarray(draught_aft))


def yu_2021_coefficient(wind_angle: ArrayLike) -> FloatArray:
    """Constant-coefficient rule of Yu (2021): C = 0.7, here with the cosine of the wind angle.

    The thesis multiplies the wind by the step on the grid and so loses its sign; the projection
    used here is what was meant. Its air density is 1.29 kg/m3.
    """
    return np.asarray(0.7 * np.cos(np.asarray(wind_angle, dtype=float)))
