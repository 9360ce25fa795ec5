"""Children of tracks: crossover, and the operators that change a track a little.

All displacements are made in the tangent plane of the place they are made at, in metres. Every
child has a stream of random numbers of its own (SplitMix64), so that a population is the same to
the bit in any number of threads.
"""

import math
from typing import Final

import numpy as np

from thalweg.kernels.bare import bare, inlined, inner
from thalweg.kernels.coast import leg_code
from thalweg.kernels.codes import OK
from thalweg.kernels.fitness import (
    COLUMNS,
    FIXED_TIME,
    HELD,
    KNOWN,
    LAT,
    LON,
    PIECES,
    SETTING,
    WAIT,
)

# Operators.
INSERT: Final = 0
TRANSLATE: Final = 1
DELETE: Final = 2
SPEED: Final = 3
SPLIT: Final = 4
MERGE: Final = 5
PAUSE: Final = 6
OPERATORS: Final = 7

# Habits: first a weight for each operator, then
CHANGES: Final = 7  # the scale of the number of changes is this over the number of legs
SHAPE: Final = 8  # of the region of inserted points: one of the following
INSERT_WIDTH: Final = 9  # its half width over its half length
RADIUS_LEAST: Final = 10  # of translations, as shares of the mean length of the legs beside;
RADIUS_MOST: Final = 11  # drawn between them evenly in the logarithm
CROSSOVER: Final = 12  # probability
MUTATION: Final = 13  # probability, of children of a crossover; others are always mutated
HABITS: Final = 14

RHOMBUS: Final = 0
ELLIPSE: Final = 1
GAUSSIAN: Final = 2

_RADIUS = 6371008.8
_RADIANS = math.pi / 180.0
_GAUSS_SIGMA = math.sqrt(1.0 / 5.991464547107982)  # 95 % within the unit circle
_TURN_FLOOR = 0.05  # added to turns [rad], so that points on straight tracks move too
_NEAREST = 3  # points of the other parent that a crossover tries
_CROSSINGS = 8  # points of the first parent that it tries
_TRIES = 4  # of a mutation, while its legs touch land


@inlined
def uniform(state):
    """Return the next random number of a stream, in [0, 1) (Steele, Lea & Flood 2014)."""
    z = state[0] + np.uint64(0x9E3779B97F4A7C15)
    state[0] = z
    z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    z = z ^ (z >> np.uint64(31))
    return float(z >> np.uint64(11)) * (1.0 / 9007199254740992.0)


@inner
def below(state, count):
    """Return a random integer in 0 to count - 1."""
    return min(int(uniform(state) * count), count - 1)


@inner
def draw_changes(scale, most, state):
    """Return a number of changes from 1 to ``most``: P(k) in proportion to exp(-k / scale)."""
    if most <= 1:
        return 1
    # the truncated geometric distribution by inversion: no draw is wasted
    floor = math.exp(-most / scale)
    k = 1 + int(-scale * math.log(1.0 - uniform(state) * (1.0 - floor)))
    return min(k, most)


@inner
def draw_offset(shape, a, b, state):
    """Return (x along, y across) of a point of a rhombus, an ellipse or a bell, half axes a, b."""
    u, v = uniform(state), uniform(state)
    if shape == RHOMBUS:
        return a * (u + v) - a, b * (u - v)
    angle = 2.0 * math.pi * v
    if shape == ELLIPSE:
        r = math.sqrt(u)
    else:
        r = _GAUSS_SIGMA * math.sqrt(-2.0 * math.log(1.0 - u))
    return r * a * math.cos(angle), r * b * math.sin(angle)


@inner
def moved(lat, lon, east, north):
    """Return the place [deg] that lies (east, north) [m] in the tangent plane of another."""
    d = math.sqrt(east * east + north * north)
    if d == 0.0:
        return lat, lon
    s, c = math.sin(d / _RADIUS), math.cos(d / _RADIUS)
    y, x = math.sin(lat * _RADIANS), math.cos(lat * _RADIANS)
    sine = min(max(y * c + x * s * north / d, -1.0), 1.0)
    turn = math.atan2(s * east / d, x * c - y * s * north / d)
    new = lon + turn / _RADIANS
    if not (new >= -180.0 and new < 180.0):
        new = (new + 180.0) % 360.0 - 180.0
    return math.asin(sine) / _RADIANS, new


@inner
def _middle(a, b):
    """Return (lat, lon, half length [m], east, north) of a leg's middle and direction there."""
    p, q = a[LAT] * _RADIANS, b[LAT] * _RADIANS
    u, v = a[LON] * _RADIANS, b[LON] * _RADIANS
    ax, ay, az = math.cos(p) * math.cos(u), math.cos(p) * math.sin(u), math.sin(p)
    bx, by, bz = math.cos(q) * math.cos(v), math.cos(q) * math.sin(v), math.sin(q)
    mx, my, mz = ax + bx, ay + by, az + bz
    ex, ey, ez = bx - ax, by - ay, bz - az
    lm, le = math.sqrt(mx * mx + my * my + mz * mz), math.sqrt(ex * ex + ey * ey + ez * ez)
    half = _RADIUS * math.atan2(le, lm)
    if le == 0.0 or lm == 0.0:
        return a[LAT], a[LON], half, 0.0, 1.0
    lat, lon = math.atan2(mz, math.sqrt(mx * mx + my * my)), math.atan2(my, mx)
    east = (ey * math.cos(lon) - ex * math.sin(lon)) / le
    flat = ex * math.cos(lon) + ey * math.sin(lon)
    north = (ez * math.cos(lat) - flat * math.sin(lat)) / le
    return lat / _RADIANS, lon / _RADIANS, half, east, north


@inlined
def _plane(a, b, scale):
    """Return b - a in degrees of latitude, ``scale`` the cosine of the latitude."""
    return ((b[LON] - a[LON] + 540.0) % 360.0 - 180.0) * scale, b[LAT] - a[LAT]


@inner
def _is_free(genes, p):
    """Return whether a point may be moved or left out."""
    before, here = genes[p - 1, FIXED_TIME], genes[p, FIXED_TIME]
    return genes[p, HELD] == 0.0 and before != before and here != here


@inner
def _turn(genes, p):
    """Return the angle by which a track turns at an interior point [rad]."""
    scale = math.cos(genes[p, LAT] * _RADIANS)
    x1, y1 = _plane(genes[p - 1], genes[p], scale)
    x2, y2 = _plane(genes[p], genes[p + 1], scale)
    return abs(math.atan2(x1 * y2 - y1 * x2, x1 * x2 + y1 * y2))


@inner
def _choose(weight, n, state):
    """Return a place drawn by weight, or -1 if all are zero."""
    total = 0.0
    for i in range(n):
        total += weight[i]
    if total <= 0.0:
        return -1
    left = uniform(state) * total
    last = -1
    for i in range(n):
        if weight[i] > 0.0:
            last = i
            left -= weight[i]
            if left < 0.0:
                break
    return last


@inner
def _mark(weight, n, k, state):
    """Draw k places without replacement; those drawn get the weight -1, the others 0."""
    drawn = 0
    while drawn < k:
        place = _choose(weight, n, state)
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


@inner
def _make_room(genes, count, p):
    """Double the point p: everything from it on moves up by one."""
    for q in range(count - 1, p - 1, -1):
        for c in range(COLUMNS):
            genes[q + 1, c] = genes[q, c]


@inner
def _drop(genes, count, p):
    """Leave out the point p; the leg before it is new."""
    for q in range(p, count - 1):
        for c in range(COLUMNS):
            genes[q, c] = genes[q + 1, c]
    genes[p - 1, KNOWN], genes[p - 1, PIECES] = 0.0, 0.0


@inner
def _new_point(genes, p, lat, lon):
    """Put a free point at p, just doubled; the legs on both sides are new."""
    genes[p, LAT], genes[p, LON] = lat, lon
    genes[p, WAIT], genes[p, HELD] = 0.0, 0.0
    for q in (p - 1, p):
        genes[q, KNOWN], genes[q, PIECES], genes[q, FIXED_TIME] = 0.0, 0.0, math.nan
    genes[p, SETTING] = genes[p - 1, SETTING]


@inner
def _weigh_legs(genes, count, weight):
    for p in range(count - 1):
        fixed = genes[p, FIXED_TIME]
        weight[p] = _middle(genes[p], genes[p + 1])[2] if fixed != fixed else 0.0


@inner
def insert(genes, count, habits, state, weight):
    """Insert points beside legs drawn by length; return the number of points."""
    legs = count - 1
    k = draw_changes(habits[CHANGES] / legs, min(legs, genes.shape[0] - count), state)
    if count >= genes.shape[0]:
        return count
    _weigh_legs(genes, count, weight)
    _mark(weight, legs, k, state)
    for p in range(legs - 1, -1, -1):
        if weight[p] < 0.0:
            lat, lon, a, east, north = _middle(genes[p], genes[p + 1])
            x, y = draw_offset(int(habits[SHAPE]), a, habits[INSERT_WIDTH] * a, state)
            lat, lon = moved(lat, lon, x * east - y * north, x * north + y * east)
            _make_room(genes, count, p + 1)
            _new_point(genes, p + 1, lat, lon)
            count += 1
    return count


@inner
def translate(genes, count, habits, state, weight):
    """Move free points, drawn by how the track turns there, inside a disc."""
    inside = count - 2
    if inside < 1:
        return False
    for p in range(1, count - 1):
        weight[p - 1] = _turn(genes, p) + _TURN_FLOOR if _is_free(genes, p) else 0.0
    k = draw_changes(habits[CHANGES] / (count - 1), inside, state)
    drawn = _mark(weight, inside, k, state)
    for p in range(1, count - 1):
        if weight[p - 1] < 0.0:
            beside = _middle(genes[p - 1], genes[p])[2] + _middle(genes[p], genes[p + 1])[2]
            low, high = math.log(habits[RADIUS_LEAST]), math.log(habits[RADIUS_MOST])
            radius = beside * math.exp(low + (high - low) * uniform(state))
            x, y = draw_offset(ELLIPSE, radius, radius, state)
            genes[p, LAT], genes[p, LON] = moved(genes[p, LAT], genes[p, LON], x, y)
            for q in (p - 1, p):
                genes[q, KNOWN], genes[q, PIECES] = 0.0, 0.0
    return drawn > 0


@inner
def delete(genes, count, habits, state, weight):
    """Leave out free points; the merged leg keeps the setting of the leg before."""
    inside = count - 2
    if inside < 1:
        return count
    for p in range(1, count - 1):
        weight[p - 1] = 1.0 if _is_free(genes, p) else 0.0
    k = draw_changes(habits[CHANGES] / (count - 1), inside, state)
    _mark(weight, inside, k, state)
    for p in range(count - 2, 0, -1):
        if weight[p - 1] < 0.0:
            _drop(genes, count, p)
            count -= 1
    return count


@inner
def _other_setting(now, settings, state):
    """Return a setting other than the present one; every second time the next up or down."""
    if uniform(state) < 0.5:
        step = 1 if uniform(state) < 0.5 else -1
        if not 0 <= now + step < settings:
            step = -step
        return now + step
    other = below(state, settings - 1)
    return other + 1 if other >= now else other


@inner
def change_speed(genes, count, settings, state):
    """Give a run of legs one new setting, other than the mean of theirs."""
    legs = count - 1
    if settings < 2:
        return False
    m = 1 + below(state, legs)
    first = below(state, legs - m + 1)
    total = 0.0
    for p in range(first, first + m):
        total += genes[p, SETTING]
    new = _other_setting(int(total / m + 0.5), settings, state)
    for p in range(first, first + m):
        genes[p, SETTING] = new
    return True


@inner
def split(genes, count, settings, state, weight):
    """Cut a leg, drawn by length, at a point of it, and give one part another setting."""
    if count >= genes.shape[0] or settings < 2:
        return count
    _weigh_legs(genes, count, weight)
    p = _choose(weight, count - 1, state)
    if p < 0:
        return count
    lat, lon, a, east, north = _middle(genes[p], genes[p + 1])
    x = a * (2.0 * uniform(state) - 1.0)
    lat, lon = moved(lat, lon, x * east, x * north)
    _make_room(genes, count, p + 1)
    _new_point(genes, p + 1, lat, lon)
    changed = p + below(state, 2)
    genes[changed, SETTING] = _other_setting(int(genes[p, SETTING]), settings, state)
    return count + 1


@inner
def merge(genes, count, state, weight):
    """Leave out a free point where the track turns little; the leg keeps either setting."""
    inside = count - 2
    if inside < 1:
        return count
    for p in range(1, count - 1):
        weight[p - 1] = 1.0 / (_turn(genes, p) + _TURN_FLOOR) if _is_free(genes, p) else 0.0
    p = 1 + _choose(weight, inside, state)
    if p < 1:
        return count
    if uniform(state) < 0.5:
        genes[p - 1, SETTING] = genes[p, SETTING]
    _drop(genes, count, p)
    return count - 1


@inner
def pause(genes, count, state, weight):
    """Lengthen, shorten or end one of the waits."""
    for p in range(count - 1):
        weight[p] = 1.0 if genes[p, WAIT] > 0.0 else 0.0
    p = _choose(weight, count - 1, state)
    if p < 0:
        return False
    genes[p, WAIT] *= 0.0 if uniform(state) < 0.2 else 2.0 * uniform(state)
    return True


@inner
def change(genes, count, operator, settings, habits, state, weight):
    """Apply one operator in place; return (points, whether anything changed)."""
    after, done = count, True
    if operator == INSERT:
        after = insert(genes, count, habits, state, weight)
        done = after != count
    elif operator == TRANSLATE:
        done = translate(genes, count, habits, state, weight)
    elif operator == DELETE:
        after = delete(genes, count, habits, state, weight)
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


@inner
def _copy(source, count, target):
    for p in range(count):
        for c in range(COLUMNS):
            target[p, c] = source[p, c]


@inner
def _clear(coast, genes, count):
    """Return whether the new legs of a track are clear of land and no-go zones."""
    for p in range(count - 1):
        if genes[p, KNOWN] == 0.0:
            a, b = genes[p], genes[p + 1]
            if leg_code(coast, a[LAT], a[LON], b[LAT], b[LON])[0] != OK:
                return False
    return True


@inner
def mutate(genes, count, coast, settings, habits, state, weight, spare):
    """Change a track in place by one operator drawn by weight; return its number of points."""
    known = True
    for p in range(count - 1):
        known &= genes[p, KNOWN] != 0.0
    _copy(genes, count, spare)
    before = count
    for attempt in range(_TRIES):
        operator = _choose(habits, OPERATORS, state)
        count, done = change(genes, before, operator, settings, habits, state, weight)
        if done and (not known or _clear(coast, genes, count)):
            break
        if attempt < _TRIES - 1:
            _copy(spare, before, genes)
            count = before
    return count


@inner
def _held(genes, first, last):
    total = 0
    for p in range(first, last):
        total += genes[p, HELD] != 0.0
    return total


@inner
def _nearest(a, genes, count, weight, tried):
    """Return the nearest interior point of a track that is not tried yet, or -1."""
    best, least = -1, math.inf
    scale = math.cos(a[LAT] * _RADIANS)
    for j in range(1, count - 1):
        fresh = True
        for k in range(tried):
            fresh &= weight[k] != j
        x, y = _plane(a, genes[j], scale)
        if fresh and x * x + y * y < least:
            best, least = j, x * x + y * y
    return best


@inner
def _joint(a, b, coast):
    """Return whether a leg between points of two parents has a length and is clear."""
    if abs(a[LAT] - b[LAT]) + abs(a[LON] - b[LON]) < 1e-9:
        return False
    return leg_code(coast, a[LAT], a[LON], b[LAT], b[LON])[0] == OK


@inner
def _spliced(head, i, tail, j, count, target):
    """Write head[..i - 1] + tail[j..] and return its number of points."""
    _copy(head, i, target)
    for p in range(j, count):
        for c in range(COLUMNS):
            target[i + p - j, c] = tail[p, c]
    target[i - 1, KNOWN], target[i - 1, PIECES] = 0.0, 0.0
    target[i - 1, FIXED_TIME] = math.nan
    return i + count - j


@inner
def cross(a, na, b, nb, coast, c, d, state, weight):
    """Cross two tracks at neighbouring waypoints; return points of the children, or (0, 0)."""
    room = c.shape[0]
    if na < 3 or nb < 3:
        return 0, 0
    for _ in range(_CROSSINGS):
        i = 1 + below(state, na - 2)
        for tried in range(min(_NEAREST, nb - 2)):
            j = _nearest(a[i], b, nb, weight, tried)
            weight[tried] = j
            if i + nb - j > room or j + na - i > room:
                continue
            if _held(a, 0, i) != _held(b, 0, j) or _held(a, i, na) != _held(b, j, nb):
                continue
            if _joint(a[i - 1], b[j], coast) and _joint(b[j - 1], a[i], coast):
                return _spliced(a, i, b, j, nb, c), _spliced(b, j, a, i, na, d)
    return 0, 0


@bare
def breed(count, genes, pairs, coast, settings, habits, states, born, young, work, weights):
    """Make two children of each pair of parents.

    Parameters
    ----------
    count : int64[N]
    genes : float64[N, M, COLUMNS]
        The parents.
    pairs : int64[K, 2]
        Which of them meet.
    coast : CoastArrays
        Land and no-go zones. New legs keep clear of them if a few tries find a way.
    settings : int
        Number of settings of the ship.
    habits : float64[HABITS]
    states : uint64[K, 1]
        A seed for each pair.
    born : int64[K, 2]
        Points of the children; filled.
    young : float64[K, 2, M, COLUMNS]
        The children; filled.
    work : float64[K, M, COLUMNS]
    weights : float64[K, 2 * M]
        Room to work in.
    """
    for k in range(pairs.shape[0]):
        first, second = pairs[k, 0], pairs[k, 1]
        state, weight, spare = states[k], weights[k], work[k]
        c, d = young[k, 0], young[k, 1]
        nc, nd = 0, 0
        if uniform(state) < habits[CROSSOVER]:
            nc, nd = cross(
                genes[first], count[first], genes[second], count[second], coast, c, d, state, weight
            )
        crossed = nc > 0
        if not crossed:
            nc, nd = count[first], count[second]
            _copy(genes[first], nc, c)
            _copy(genes[second], nd, d)
        if not crossed or uniform(state) < habits[MUTATION]:
            nc = mutate(c, nc, coast, settings, habits, state, weight, spare)
        if not crossed or uniform(state) < habits[MUTATION]:
            nd = mutate(d, nd, coast, settings, habits, state, weight, spare)
        born[k, 0], born[k, 1] = nc, nd
