"""Random numbers in kernels: streams of their own (SplitMix64), and what is drawn from them."""

import math
from typing import Final

import numpy as np

from thalweg.kernels.compilation.decorators import inlined, kernel_only

# Shapes of regions that places are drawn from.
RHOMBUS: Final = 0
ELLIPSE: Final = 1
GAUSSIAN: Final = 2

_GAUSS_SIGMA = math.sqrt(1.0 / 5.991464547107982)  # 95 % within the unit circle


@inlined
def random_uniform(state):
    """Return the next random number of a stream, in [0, 1) (Steele, Lea & Flood 2014)."""
    z = state[0] + np.uint64(0x9E3779B97F4A7C15)
    state[0] = z
    z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    z = z ^ (z >> np.uint64(31))
    return float(z >> np.uint64(11)) * (1.0 / 9007199254740992.0)


@kernel_only
def random_below(state, count):
    """Return a random integer in 0 to count - 1."""
    return min(int(random_uniform(state) * count), count - 1)


@kernel_only
def draw_change_count(scale, most, state):
    """Return a number of changes from 1 to ``most``: P(k) in proportion to exp(-k / scale)."""
    if most <= 1:
        return 1
    # the truncated geometric distribution by inversion: no draw is wasted
    floor = math.exp(-most / scale)
    k = 1 + int(-scale * math.log(1.0 - random_uniform(state) * (1.0 - floor)))
    return min(k, most)


@kernel_only
def draw_offset(shape, a, b, state):
    """Return (x along, y across) of a point of a rhombus, an ellipse or a bell, half axes a, b."""
    u, v = random_uniform(state), random_uniform(state)
    if shape == RHOMBUS:
        return a * (u + v) - a, b * (u - v)
    angle = 2.0 * math.pi * v
    if shape == ELLIPSE:
        r = math.sqrt(u)
    else:
        r = _GAUSS_SIGMA * math.sqrt(-2.0 * math.log(1.0 - u))
    return r * a * math.cos(angle), r * b * math.sin(angle)
