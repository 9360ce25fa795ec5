"""The operators that change a track a little.

All displacements are made in the tangent plane of the place they are made at, in metres.
"""

import math
from typing import Final

from thalweg.core.ellipsoid import MEAN_RADIUS
from thalweg.kernels.codes import OK
from thalweg.kernels.compilation.decorators import inlined, kernel_only
from thalweg.kernels.evolution.random_numbers import (
    ELLIPSE,
    draw_change_count,
    draw_offset,
    random_below,
    random_uniform,
)
from thalweg.kernels.geometry.coast_index import leg_code
from thalweg.kernels.leg.population_sailing import (
    FIXED_TIME,
    GENE_COLUMNS,
    IS_LOOKED_UP,
    IS_REQUIRED,
    LAT,
    LON,
    PIECES,
    SETTING,
    WAITING_TIME,
)

# Operators.
INSERT: Final = 0
TRANSLATE: Final = 1
DELETE: Final = 2
SPEED: Final = 3
SPLIT: Final = 4
MERGE: Final = 5
PAUSE: Final = 6
OPERATOR_COUNT: Final = 7

# Variation settings: first a weight for each operator, then
CHANGE_SCALE: Final = 7  # the scale of the number of changes is this over the number of legs
OFFSET_SHAPE: Final = (
    8  # of the region of inserted points, of `thalweg.kernels.evolution.random_numbers`
)
INSERT_WIDTH: Final = 9  # its half width over its half length
RADIUS_MIN: Final = 10  # of translations, as fractions of the mean length of the adjacent legs;
RADIUS_MAX: Final = 11  # drawn between them evenly in the logarithm
CROSSOVER_PROBABILITY: Final = 12  # probability
MUTATION_PROBABILITY: Final = (
    13  # probability, of children of a crossover; others are always mutated
)
VARIATION_SETTING_COUNT: Final = 14

RADIANS = math.pi / 180.0
_MIN_TURN_WEIGHT = 0.05  # added to turns [rad], so that points on straight tracks move too
_MAX_TRIES = 4  # of a mutation, while its legs touch land


@kernel_only
def offset_position(lat, lon, east, north):
    """Return the position [deg] displaced by (east, north) [m] in the tangent plane of another."""
    d = math.sqrt(east * east + north * north)
    if d == 0.0:
        return lat, lon
    s, c = math.sin(d / MEAN_RADIUS), math.cos(d / MEAN_RADIUS)
    y, x = math.sin(lat * RADIANS), math.cos(lat * RADIANS)
    sine = min(max(y * c + x * s * north / d, -1.0), 1.0)
    turn = math.atan2(s * east / d, x * c - y * s * north / d)
    new = lon + turn / RADIANS
    if not (new >= -180.0 and new < 180.0):
        new = (new + 180.0) % 360.0 - 180.0
    return math.asin(sine) / RADIANS, new


@kernel_only
def _middle(a, b):
    """Return (lat, lon, half length [m], east, north) of a leg's middle and direction there."""
    p, q = a[LAT] * RADIANS, b[LAT] * RADIANS
    u, v = a[LON] * RADIANS, b[LON] * RADIANS
    ax, ay, az = math.cos(p) * math.cos(u), math.cos(p) * math.sin(u), math.sin(p)
    bx, by, bz = math.cos(q) * math.cos(v), math.cos(q) * math.sin(v), math.sin(q)
    mx, my, mz = ax + bx, ay + by, az + bz
    ex, ey, ez = bx - ax, by - ay, bz - az
    lm, le = math.sqrt(mx * mx + my * my + mz * mz), math.sqrt(ex * ex + ey * ey + ez * ez)
    half = MEAN_RADIUS * math.atan2(le, lm)
    if le == 0.0 or lm == 0.0:
        return a[LAT], a[LON], half, 0.0, 1.0
    lat, lon = math.atan2(mz, math.sqrt(mx * mx + my * my)), math.atan2(my, mx)
    east = (ey * math.cos(lon) - ex * math.sin(lon)) / le
    flat = ex * math.cos(lon) + ey * math.sin(lon)
    north = (ez * math.cos(lat) - flat * math.sin(lat)) / le
    return lat / RADIANS, lon / RADIANS, half, east, north


@inlined
def planar_difference(a, b, scale):
    """Return b - a in degrees of latitude, ``scale`` the cosine of the latitude."""
    return ((b[LON] - a[LON] + 540.0) % 360.0 - 180.0) * scale, b[LAT] - a[LAT]


@kernel_only
def _is_free(genes, p):
    """Return whether a point may be moved or left out."""
    before, here = genes[p - 1, FIXED_TIME], genes[p, FIXED_TIME]
    return genes[p, IS_REQUIRED] == 0.0 and before != before and here != here


@kernel_only
def _turn(genes, p):
    """Return the angle by which a track turns at an interior point [rad]."""
    scale = math.cos(genes[p, LAT] * RADIANS)
    x1, y1 = planar_difference(genes[p - 1], genes[p], scale)
    x2, y2 = planar_difference(genes[p], genes[p + 1], scale)
    return abs(math.atan2(x1 * y2 - y1 * x2, x1 * x2 + y1 * y2))


@kernel_only
def _draw_by_weight(weight, n, state):
    """Return a place drawn by weight, or -1 if all are zero."""
    total = 0.0
    for i in range(n):
        total += weight[i]
    if total <= 0.0:
        return -1
    left = random_uniform(state) * total
    last = -1
    for i in range(n):
        if weight[i] > 0.0:
            last = i
            left -= weight[i]
            if left < 0.0:
                break
    return last


@kernel_only
def _draw_without_replacement(weight, n, k, state):
    """Draw k places without replacement; those drawn get the weight -1, the others 0."""
    drawn = 0
    while drawn < k:
        place = _draw_by_weight(weight, n, state)
        if place < 0:
            break
        weight[place] = 0.0
        weight[n + drawn] = place
        drawn += 1
    for i in range(n):
        weight[i] = 0.0
    for j in range(drawn):
        weight[int(weight[n + j])] = -1.0
    return drawn


@kernel_only
def _duplicate_point(genes, count, p):
    """Double the point p: everything from it on moves up by one."""
    for q in range(count - 1, p - 1, -1):
        for c in range(GENE_COLUMNS):
            genes[q + 1, c] = genes[q, c]


@kernel_only
def _remove_point(genes, count, p):
    """Leave out the point p; the leg before it is new."""
    for q in range(p, count - 1):
        for c in range(GENE_COLUMNS):
            genes[q, c] = genes[q + 1, c]
    genes[p - 1, IS_LOOKED_UP], genes[p - 1, PIECES] = 0.0, 0.0


@kernel_only
def _set_free_point(genes, p, lat, lon):
    """Put a free point at p, just doubled; the legs on both sides are new."""
    genes[p, LAT], genes[p, LON] = lat, lon
    genes[p, WAITING_TIME], genes[p, IS_REQUIRED] = 0.0, 0.0
    for q in (p - 1, p):
        genes[q, IS_LOOKED_UP], genes[q, PIECES], genes[q, FIXED_TIME] = 0.0, 0.0, math.nan
    genes[p, SETTING] = genes[p - 1, SETTING]


@kernel_only
def _weight_legs_by_length(genes, count, weight):
    for p in range(count - 1):
        fixed = genes[p, FIXED_TIME]
        weight[p] = _middle(genes[p], genes[p + 1])[2] if fixed != fixed else 0.0


@kernel_only
def insert(genes, count, variation_settings, state, weight):
    """Insert points near legs drawn by length; return the number of points."""
    legs = count - 1
    k = draw_change_count(
        variation_settings[CHANGE_SCALE] / legs, min(legs, genes.shape[0] - count), state
    )
    if count >= genes.shape[0]:
        return count
    _weight_legs_by_length(genes, count, weight)
    _draw_without_replacement(weight, legs, k, state)
    for p in range(legs - 1, -1, -1):
        if weight[p] < 0.0:
            lat, lon, a, east, north = _middle(genes[p], genes[p + 1])
            x, y = draw_offset(
                int(variation_settings[OFFSET_SHAPE]),
                a,
                variation_settings[INSERT_WIDTH] * a,
                state,
            )
            lat, lon = offset_position(lat, lon, x * east - y * north, x * north + y * east)
            _duplicate_point(genes, count, p + 1)
            _set_free_point(genes, p + 1, lat, lon)
            count += 1
    return count


@kernel_only
def translate(genes, count, variation_settings, state, weight):
    """Move free points, drawn by how the track turns there, inside a disc."""
    inside = count - 2
    if inside < 1:
        return False
    for p in range(1, count - 1):
        weight[p - 1] = _turn(genes, p) + _MIN_TURN_WEIGHT if _is_free(genes, p) else 0.0
    k = draw_change_count(variation_settings[CHANGE_SCALE] / (count - 1), inside, state)
    drawn = _draw_without_replacement(weight, inside, k, state)
    for p in range(1, count - 1):
        if weight[p - 1] < 0.0:
            beside = _middle(genes[p - 1], genes[p])[2] + _middle(genes[p], genes[p + 1])[2]
            low, high = (
                math.log(variation_settings[RADIUS_MIN]),
                math.log(variation_settings[RADIUS_MAX]),
            )
            radius = beside * math.exp(low + (high - low) * random_uniform(state))
            x, y = draw_offset(ELLIPSE, radius, radius, state)
            genes[p, LAT], genes[p, LON] = offset_position(genes[p, LAT], genes[p, LON], x, y)
            for q in (p - 1, p):
                genes[q, IS_LOOKED_UP], genes[q, PIECES] = 0.0, 0.0
    return drawn > 0


@kernel_only
def delete(genes, count, variation_settings, state, weight):
    """Remove free points; the merged leg has the setting of the leg before."""
    inside = count - 2
    if inside < 1:
        return count
    for p in range(1, count - 1):
        weight[p - 1] = 1.0 if _is_free(genes, p) else 0.0
    k = draw_change_count(variation_settings[CHANGE_SCALE] / (count - 1), inside, state)
    _draw_without_replacement(weight, inside, k, state)
    for p in range(count - 2, 0, -1):
        if weight[p - 1] < 0.0:
            _remove_point(genes, count, p)
            count -= 1
    return count


@kernel_only
def _other_setting(now, settings, state):
    """Return a setting other than the present one; every second time the next up or down."""
    if random_uniform(state) < 0.5:
        step = 1 if random_uniform(state) < 0.5 else -1
        if not 0 <= now + step < settings:
            step = -step
        return now + step
    other = random_below(state, settings - 1)
    return other + 1 if other >= now else other


@kernel_only
def change_speed(genes, count, settings, state):
    """Give a run of legs one new setting, other than the mean of theirs."""
    legs = count - 1
    if settings < 2:
        return False
    m = 1 + random_below(state, legs)
    first = random_below(state, legs - m + 1)
    total = 0.0
    for p in range(first, first + m):
        total += genes[p, SETTING]
    new = _other_setting(int(total / m + 0.5), settings, state)
    for p in range(first, first + m):
        genes[p, SETTING] = new
    return True


@kernel_only
def split(genes, count, settings, state, weight):
    """Split a leg, drawn by length, at a random point, and give one part another setting."""
    if count >= genes.shape[0] or settings < 2:
        return count
    _weight_legs_by_length(genes, count, weight)
    p = _draw_by_weight(weight, count - 1, state)
    if p < 0:
        return count
    lat, lon, a, east, north = _middle(genes[p], genes[p + 1])
    x = a * (2.0 * random_uniform(state) - 1.0)
    lat, lon = offset_position(lat, lon, x * east, x * north)
    _duplicate_point(genes, count, p + 1)
    _set_free_point(genes, p + 1, lat, lon)
    changed = p + random_below(state, 2)
    genes[changed, SETTING] = _other_setting(int(genes[p, SETTING]), settings, state)
    return count + 1


@kernel_only
def merge(genes, count, state, weight):
    """Remove a free point where the track turns little; the leg has one of both settings."""
    inside = count - 2
    if inside < 1:
        return count
    for p in range(1, count - 1):
        weight[p - 1] = 1.0 / (_turn(genes, p) + _MIN_TURN_WEIGHT) if _is_free(genes, p) else 0.0
    p = 1 + _draw_by_weight(weight, inside, state)
    if p < 1:
        return count
    if random_uniform(state) < 0.5:
        genes[p - 1, SETTING] = genes[p, SETTING]
    _remove_point(genes, count, p)
    return count - 1


@kernel_only
def pause(genes, count, state, weight):
    """Lengthen, shorten or end one of the waits."""
    for p in range(count - 1):
        weight[p] = 1.0 if genes[p, WAITING_TIME] > 0.0 else 0.0
    p = _draw_by_weight(weight, count - 1, state)
    if p < 0:
        return False
    genes[p, WAITING_TIME] *= 0.0 if random_uniform(state) < 0.2 else 2.0 * random_uniform(state)
    return True


@kernel_only
def apply_operator(genes, count, operator, settings, variation_settings, state, weight):
    """Apply one operator in place; return (points, whether anything changed)."""
    after, done = count, True
    if operator == INSERT:
        after = insert(genes, count, variation_settings, state, weight)
        done = after != count
    elif operator == TRANSLATE:
        done = translate(genes, count, variation_settings, state, weight)
    elif operator == DELETE:
        after = delete(genes, count, variation_settings, state, weight)
        done = after != count
    elif operator == SPEED:
        done = change_speed(genes, count, settings, state)
    elif operator == SPLIT:
        after = split(genes, count, settings, state, weight)
        done = after != count
    elif operator == MERGE:
        after = merge(genes, count, state, weight)
        done = after != count
    else:
        done = pause(genes, count, state, weight)
    return after, done


@kernel_only
def copy_genes(source, count, target):
    """Copy the points of a track."""
    for p in range(count):
        for c in range(GENE_COLUMNS):
            target[p, c] = source[p, c]


@kernel_only
def _clear(coast, genes, count):
    """Return whether the new legs of a track are clear of land and no-go zones."""
    for p in range(count - 1):
        if genes[p, IS_LOOKED_UP] == 0.0:
            a, b = genes[p], genes[p + 1]
            if leg_code(coast, a[LAT], a[LON], b[LAT], b[LON])[0] != OK:
                return False
    return True


@kernel_only
def mutate(genes, count, coast, settings, variation_settings, state, weight, spare):
    """Change a track in place by one operator drawn by weight; return its number of points."""
    known = True
    for p in range(count - 1):
        known &= genes[p, IS_LOOKED_UP] != 0.0
    copy_genes(genes, count, spare)
    before = count
    for attempt in range(_MAX_TRIES):
        operator = _draw_by_weight(variation_settings, OPERATOR_COUNT, state)
        count, done = apply_operator(
            genes, before, operator, settings, variation_settings, state, weight
        )
        if done and (not known or _clear(coast, genes, count)):
            break
        if attempt < _MAX_TRIES - 1:
            copy_genes(spare, before, genes)
            count = before
    return count
