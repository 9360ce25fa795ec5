"""Exact land tests of legs with a grid of coast edges on the faces of a cube.

A position becomes the unit vector of its geocentric latitude, so the plane through two of them
intersects the ellipsoid in a great ellipse. On a cube face (gnomonic) such arcs are straight lines,
poles and the antimeridian need no special treatment, and a leg is followed from cell to cell, or
over several cells where the distance to the coast is known.

The geodesic leaves the plane of its great ellipse by an offset ``d``. To first order in the
flattening the plane's section has geodesic curvature ``-2 f n_z r_z`` and Jacobi's equation
``d'' + d = -2 f n_z (m_z cos t + e_z sin t)`` with ``d = 0`` at both ends gives

    d(t) = -f n_z [m_z (t sin t - T tan T cos t) + e_z (T sin t / tan T - t cos t)],

t counted from the middle of the leg, T half its length [rad]. Measured against Karney's geodesics
the remaining error is below 1.4 f^2 L^2 / 8R: 3 mm at 100 km, 0.3 m at 1000 km. `leg_code`
therefore calls a long leg "unsure" when it passes the coast nearer than that.

Coast edges are straight in longitude and latitude, split so that the arc between their ends is
at most `BULGE` from them; where that matters an edge is split further.
"""

from math import asin, atan2, ceil, hypot, sqrt
from typing import Final, NamedTuple

import numpy as np

from thalweg.core.ellipsoid import AXIS_RATIO_SQUARED, FLATTENING
from thalweg.kernels.codes import LAND, NO_DATA, NO_GO, OFFING, OK
from thalweg.kernels.compilation.decorators import allocation_free, kernel_only
from thalweg.kernels.geometry.arc_edges import arc_frame, edges_of_cell_touched
from thalweg.kernels.geometry.cube_sphere import (
    DEGREE,
    FIRST_ROW,
    IndexArrays,
    column_of,
    face_components,
    face_of,
    inside,
    unit_vector,
)
from thalweg.kernels.geometry.geodesic_arc import geodesic_point
from thalweg.kernels.geometry.offing_along_legs import (
    KEPT,
    NO_OFFING,
    TOO_NEAR,
    OffingArrays,
    gate_crossed,
    offing_along,
    offing_kept_at,
)

REACH: Final = 3.0e-5  # a cell answers for points this far outside it, on the face
LONGEST_ARC: Final = 0.125  # longer legs are split into such arcs [rad]
SHORTEST_ARC: Final = 1.0e-9  # shorter legs are points [rad]
SURE_CHORD: Final = 0.025  # legs below 159 km are never unsure
LONGEST_CHORD: Final = 1.2  # legs above 8,200 km always are


class CoastArrays(NamedTuple):
    """What a leg must not touch: land, no-go zones, the world outside an area, water near land.

    ``area`` is float64[4]: south, north, west [deg] and width [deg]; width 360 and latitudes
    +-90 mean the whole world.
    """

    land: IndexArrays
    zones: IndexArrays
    area: np.ndarray
    offing: OffingArrays = NO_OFFING


@kernel_only
def _column_exit(direction, side, column, mu, eu, mw, ew, tau):
    """Return where the leg leaves a column of cells, as the tangent of the angle; or infinity."""
    if direction == 0.0:
        return np.inf
    if direction > 0.0:
        border = 2.0 * (column + 1) / side - 1.0 + REACH
    else:
        border = 2.0 * column / side - 1.0 - REACH
    out = (border * mw - mu) / (eu - border * ew)
    return out if out > tau else np.inf  # not above tau: it is behind the back of the cube


@kernel_only
def cell_exit(m, e, face, i, j, side, tau):
    """Return where an arc leaves cell (i, j) of a face, as the tangent of the angle."""
    mu, mv, mw = face_components(m[0], m[1], m[2], face)
    eu, ev, ew = face_components(e[0], e[1], e[2], face)
    out_u = _column_exit(eu * mw - mu * ew, side, i, mu, eu, mw, ew, tau)
    out_v = _column_exit(ev * mw - mv * ew, side, j, mv, ev, mw, ew, tau)
    return min(out_u, out_v)


@kernel_only
def _arc_touched(index, m, e, tan_half, unsure):
    """Walk an arc of at most `LONGEST_ARC`: 0 clear, 1 touched, 2 unsure."""
    side, cell = index.side, index.cell
    arc, near = arc_frame(m, e, tan_half)
    near += unsure
    big = min(3.0 / side, 0.1)
    answer = 0
    tau = -tan_half
    while tau < tan_half:
        x, y, z = m[0] + tau * e[0], m[1] + tau * e[1], m[2] + tau * e[2]
        face = face_of(x, y, z)
        u, v, w = face_components(x, y, z, face)
        i, j = column_of(u / w, side), column_of(v / w, side)
        value = cell[(face * side + j) * side + i]
        if value > big:
            tau = (tau + value) / (1.0 - tau * value)
            continue
        if value < 0.0:
            if value > FIRST_ROW:
                return 1
            row = int(FIRST_ROW - value)
            touched = edges_of_cell_touched(index, row, arc, near, unsure)
            if touched == 1:
                return 1
            answer = max(answer, touched)
        tau = cell_exit(m, e, face, i, j, side, tau)
    return answer


@kernel_only
def _is_whole_globe(area):
    return area[0] <= -90.0 and area[1] >= 90.0 and area[3] >= 360.0


@kernel_only
def _position_in_area(area, lat, lon):
    """Return whether a position [deg] is in an area, borders included."""
    east = (lon - area[2]) % 360.0
    return area[0] <= lat <= area[1] and (east <= area[3] or east >= 360.0 - 1e-9)


@kernel_only
def leg_in_area(area, lat1, lon1, lat2, lon2):
    """Return whether the geodesic between two positions [deg] stays in an area.

    It may not run round the back of a wide area, nor bulge over its northern or southern border.
    """
    if not (_position_in_area(area, lat1, lon1) and _position_in_area(area, lat2, lon2)):
        return False
    start = (lon1 - area[2] + 1e-9) % 360.0
    end = start + (lon2 - lon1 + 540.0) % 360.0 - 180.0
    if area[3] < 360.0 and not 0.0 <= end <= area[3] + 2e-9:
        return False
    ax, ay, az = unit_vector(lat1, lon1)
    bx, by, bz = unit_vector(lat2, lon2)
    nx, ny, nz = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
    if (nx * ay - ny * ax) * (nx * by - ny * bx) >= 0.0:  # no highest point between a and b
        return True
    top = atan2(hypot(nx, ny), AXIS_RATIO_SQUARED * abs(nz)) / DEGREE
    return top <= area[1] if az + bz > 0.0 else -top >= area[0]


@kernel_only
def _vector_code(coast, lat, lon, x, y, z):
    """Return OK, LAND or NO_GO for a position given in degrees and as a vector."""
    if inside(coast.land, x, y, z):
        return LAND
    if not _is_whole_globe(coast.area) and not _position_in_area(coast.area, lat, lon):
        return NO_GO
    if coast.zones.side > 1 and inside(coast.zones, x, y, z):
        return NO_GO
    return OK


@kernel_only
def _offing_code(coast, x, y, z):
    """Return OFFING for a direction in water nearer to land than is required, else OK."""
    if coast.offing.distance > 0.0 and not offing_kept_at(coast.land, coast.offing, x, y, z):
        return OFFING
    return OK


@kernel_only
def point_code(coast, lat, lon):
    """Return OK, LAND, NO_GO (a no-go zone or outside the area) or OFFING for a position [deg]."""
    if not (abs(lat) <= 90.0 and abs(lon) < 1e6):
        return NO_DATA
    x, y, z = unit_vector(lat, lon)
    code = _vector_code(coast, lat, lon, x, y, z)
    return code if code != OK else _offing_code(coast, x, y, z)


@kernel_only
def _arc_between(a, b):
    """Return the middle direction, the direction along and the tangent of half the angle."""
    mx, my, mz = a[0] + b[0], a[1] + b[1], a[2] + b[2]
    ex, ey, ez = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    lm, le = sqrt(mx * mx + my * my + mz * mz), sqrt(ex * ex + ey * ey + ez * ez)
    return (mx / lm, my / lm, mz / lm), (ex / le, ey / le, ez / le), le / lm


@kernel_only
def _touched(index, a, b, chord, unsure):
    """Walk the leg from a to b in arcs: 0 clear, 1 touched, 2 unsure."""
    if chord < LONGEST_ARC:
        m, e, tan_half = _arc_between(a, b)
        return _arc_touched(index, m, e, tan_half, unsure)
    arcs = ceil(2.0 * asin(min(0.5 * chord, 1.0)) / LONGEST_ARC)
    answer = 0
    p = a
    for i in range(arcs):
        q = b if i == arcs - 1 else geodesic_point(a, b, (i + 1.0) / arcs)
        m, e, tan_half = _arc_between(p, q)
        touched = _arc_touched(index, m, e, tan_half, unsure)
        if touched == 1:
            return 1
        answer = max(answer, touched)
        p = q
    return answer


@allocation_free
def leg_code(coast, lat1, lon1, lat2, lon2):
    """Return why a geodesic leg may not be sailed, and whether that is unsure.

    Parameters
    ----------
    coast : CoastArrays
    lat1, lon1, lat2, lon2 : float
        Ends of the leg [deg]. Split legs above 8,000 km first: they are always unsure.

    Returns
    -------
    code : OK, LAND, NO_GO (a zone, or outside the area), OFFING (nearer to land than the offing, or
        on it) or NO_DATA (a position that is none).
    unsure : The leg passes so near that the first-order geodesic cannot decide; ``code`` is then
        the blocked one.
    """
    if not (abs(lat1) <= 90.0 and abs(lon1) < 1e6 and abs(lat2) <= 90.0 and abs(lon2) < 1e6):
        return NO_DATA, False
    a, b = unit_vector(lat1, lon1), unit_vector(lat2, lon2)
    code = _vector_code(coast, lat1, lon1, a[0], a[1], a[2])
    if code != OK:
        return code, False
    x, y, z = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    chord = sqrt(x * x + y * y + z * z)
    if chord < SHORTEST_ARC:
        code = _vector_code(coast, lat2, lon2, b[0], b[1], b[2])
        return (code if code != OK else _offing_code(coast, b[0], b[1], b[2])), False
    far = chord > LONGEST_CHORD
    unsure = 0.0
    if chord > SURE_CHORD:
        unsure = 0.3 * (FLATTENING * chord) ** 2
    off_land = TOO_NEAR
    if coast.offing.distance > 0.0:
        off_land = offing_along(coast.land, coast.offing, a, b, chord)
        if off_land == TOO_NEAR:
            return OFFING, far
    land = 0 if off_land == KEPT else _touched(coast.land, a, b, chord, unsure)
    if land > 0:
        return LAND, far or land == 2
    if not _is_whole_globe(coast.area) and not leg_in_area(coast.area, lat1, lon1, lat2, lon2):
        return NO_GO, False
    if coast.zones.side > 1:
        zone = _touched(coast.zones, a, b, chord, unsure)
        if zone > 0:
            return NO_GO, far or zone == 2
    if len(coast.offing.gate) > 0 and gate_crossed(coast.offing, a, b):
        return NO_GO, False
    return OK, far


@allocation_free
def leg_blocked(coast, lat1, lon1, lat2, lon2):
    """Return whether a geodesic leg [deg] touches land or a no-go zone or leaves the area."""
    return leg_code(coast, lat1, lon1, lat2, lon2)[0] != OK


@allocation_free
def leg_codes(coast, lat1, lon1, lat2, lon2, code, unsure):
    """Fill ``code`` (int8) and ``unsure`` (bool) for many legs; see `leg_code`."""
    for i in range(len(code)):
        code[i], unsure[i] = leg_code(coast, lat1[i], lon1[i], lat2[i], lon2[i])


@allocation_free
def point_codes(coast, lat, lon, code):
    """Fill ``code`` (int8) for many positions [deg]; see `point_code`."""
    for i in range(len(code)):
        code[i] = point_code(coast, lat[i], lon[i])


@kernel_only
def outline_touched(index, a, b):
    """Return whether a leg between unit vectors may touch an outline; long ones may."""
    x, y, z = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    chord = sqrt(x * x + y * y + z * z)
    if SHORTEST_ARC < chord < LONGEST_ARC:
        return _touched(index, a, b, chord, 0.3 * (FLATTENING * chord) ** 2) > 0
    return not chord < LONGEST_ARC


@allocation_free
def outlines_touched(index, lat1, lon1, lat2, lon2, touched):
    """Fill ``touched`` (bool) with whether legs [deg] may touch an outline; long ones may."""
    for i in range(len(touched)):
        a, b = unit_vector(lat1[i], lon1[i]), unit_vector(lat2[i], lon2[i])
        touched[i] = outline_touched(index, a, b)
