"""Kernels that build networks: lengths and courses, CSR, spaced points."""

import math

import numpy as np

from thalweg.core.ellipsoid import EQUATORIAL_RADIUS, FLATTENING
from thalweg.kernels.compilation.decorators import kernel_only
from thalweg.kernels.compilation.jit import jit

_B = EQUATORIAL_RADIUS * (1.0 - FLATTENING)
_EP2 = (EQUATORIAL_RADIUS * EQUATORIAL_RADIUS - _B * _B) / (_B * _B)


@jit
def fill_lengths_and_courses(lat, lon, first, second, length, course):
    """Fill geodesic length [m] and course at mid-edge [rad] of pairs of positions [deg].

    Vincenty (1975), "Direct and inverse solutions of geodesics on the ellipsoid", Survey Review
    23(176); the mid-edge course is exact on the auxiliary sphere. NaN where the iteration does
    not settle (nearly antipodal ends).
    """
    n = lat.shape[0]
    su = np.empty(n)
    cu = np.empty(n)
    for i in range(n):
        t = (1.0 - FLATTENING) * math.tan(math.radians(lat[i]))
        cu[i] = 1.0 / math.sqrt(1.0 + t * t)
        su[i] = t * cu[i]
    for e in range(first.shape[0]):
        p = first[e]
        q = second[e]
        delta = lon[q] - lon[p]
        delta -= 360.0 * math.floor((delta + 180.0) / 360.0)
        length[e], course[e] = _vincenty(su[p], cu[p], su[q], cu[q], math.radians(delta))


@kernel_only
def _vincenty(su1, cu1, su2, cu2, delta):
    lam = delta
    settled = False
    sin_s = cos_s = sigma = cos2_a = c2m = 0.0
    for _ in range(30):
        sl = math.sin(lam)
        cl = math.cos(lam)
        x = cu2 * sl
        y = cu1 * su2 - su1 * cu2 * cl
        sin_s = math.sqrt(x * x + y * y)
        if sin_s == 0.0:
            return 0.0, 0.0
        cos_s = su1 * su2 + cu1 * cu2 * cl
        sigma = math.atan2(sin_s, cos_s)
        sin_a = cu1 * cu2 * sl / sin_s
        cos2_a = 1.0 - sin_a * sin_a
        c2m = cos_s - 2.0 * su1 * su2 / cos2_a if cos2_a > 1e-14 else 0.0
        c = FLATTENING / 16.0 * cos2_a * (4.0 + FLATTENING * (4.0 - 3.0 * cos2_a))
        series = sigma + c * sin_s * (c2m + c * cos_s * (2.0 * c2m * c2m - 1.0))
        before = lam
        lam = delta + (1.0 - c) * FLATTENING * sin_a * series
        if abs(lam - before) < 1e-13:
            settled = True
            break
    if not settled:
        return math.nan, math.nan
    u2 = cos2_a * _EP2
    big_a = 1.0 + u2 / 16384.0 * (4096.0 + u2 * (-768.0 + u2 * (320.0 - 175.0 * u2)))
    big_b = u2 / 1024.0 * (256.0 + u2 * (-128.0 + u2 * (74.0 - 47.0 * u2)))
    inner = cos_s * (2.0 * c2m * c2m - 1.0) - big_b / 6.0 * c2m * (4.0 * sin_s * sin_s - 3.0) * (
        4.0 * c2m * c2m - 3.0
    )
    correction = big_b * sin_s * (c2m + big_b / 4.0 * inner)
    return _B * big_a * (sigma - correction), _mid_course(su1, cu1, su2, cu2, lam)


@jit(inline="always")
def _mid_course(su1, cu1, su2, cu2, lam):
    ch = math.cos(0.5 * lam)
    sh = math.sin(0.5 * lam)
    mx = (cu1 + cu2) * ch
    my = (cu2 - cu1) * sh
    mz = su1 + su2
    dx = (cu2 - cu1) * ch
    dy = (cu1 + cu2) * sh
    dz = su2 - su1
    rho2 = mx * mx + my * my
    east = (mx * dy - my * dx) * math.sqrt(rho2 + mz * mz)
    north = rho2 * dz - mz * (mx * dx + my * dy)
    course = math.atan2(east, north)
    return course if course >= 0.0 else course + 2.0 * math.pi


@jit
def directed_edges_of_pairs(n, first, second):
    """Return the CSR of a symmetric graph given one pair per edge and its opposite.

    Returns
    -------
    indptr : int64[n + 1], target : int32[2 P]
        The directed edges by tail.
    pair : int32[2 P], back : bool[2 P]
        The pair each edge comes from and whether it runs from ``second`` to ``first``.
    """
    count = first.shape[0]
    indptr = np.zeros(n + 1, np.int64)
    for e in range(count):
        indptr[first[e] + 1] += 1
        indptr[second[e] + 1] += 1
    for i in range(n):
        indptr[i + 1] += indptr[i]
    at = indptr[:-1].copy()
    target = np.empty(2 * count, np.int32)
    pair = np.empty(2 * count, np.int32)
    back = np.empty(2 * count, np.bool_)
    for e in range(count):
        p = first[e]
        q = second[e]
        k = at[p]
        target[k] = q
        pair[k] = e
        back[k] = False
        at[p] += 1
        k = at[q]
        target[k] = p
        pair[k] = e
        back[k] = True
        at[q] += 1
    return indptr, target, pair, back


@jit
def mirror_samples(pair, back, ptr, a, b, w, s):
    """Return the samples of directed edges from those of pairs, reversed where edges run back."""
    count = pair.shape[0]
    out_ptr = np.empty(count + 1, np.int64)
    out_ptr[0] = 0
    for e in range(count):
        h = pair[e]
        out_ptr[e + 1] = out_ptr[e] + ptr[h + 1] - ptr[h]
    total = out_ptr[count]
    out_a = np.empty(total, np.int32)
    out_b = np.empty(total, np.int32)
    out_w = np.empty(total, np.float32)
    out_s = np.empty(total, np.float32)
    for e in range(count):
        h = pair[e]
        size = ptr[h + 1] - ptr[h]
        for k in range(size):
            source = ptr[h] + (size - 1 - k if back[e] else k)
            v = out_ptr[e] + k
            out_a[v] = a[source]
            out_b[v] = b[source]
            out_w[v] = w[source]
            out_s[v] = np.float32(1.0) - s[source] if back[e] else s[source]
    return out_ptr, out_a, out_b, out_w, out_s


@jit
def keep_spaced_points(x, y, spacing, keep):
    """Select points in order that are farther than their spacing from all points selected before.

    Parameters
    ----------
    x, y : float64[N]
        Positions in a plane.
    spacing : float64[N]
        A point is selected if and only if its nearest selected point is (strictly) farther away.
    keep : bool[N]
        Filled.
    """
    n = x.shape[0]
    x0 = x.min()
    y0 = y.min()
    extent = max(x.max() - x0, y.max() - y0)
    cell = max(spacing.max(), extent / (2.0 * math.sqrt(n) + 8.0))
    if cell == 0.0:
        cell = 1.0
    wide = np.int64((x.max() - x0) / cell) + 1
    high = np.int64((y.max() - y0) / cell) + 1
    last = np.full(wide * high, -1, np.int64)
    before = np.full(n, -1, np.int64)
    for p in range(n):
        i = np.int64((x[p] - x0) / cell)
        j = np.int64((y[p] - y0) / cell)
        limit = spacing[p] * spacing[p]
        keep[p] = True
        for ci in range(max(0, i - 1), min(wide, i + 2)):
            for cj in range(max(0, j - 1), min(high, j + 2)):
                q = last[ci * high + cj]
                while q >= 0 and keep[p]:
                    if (x[q] - x[p]) ** 2 + (y[q] - y[p]) ** 2 <= limit:
                        keep[p] = False
                    q = before[q]
        if keep[p]:
            before[p] = last[i * high + j]
            last[i * high + j] = p
