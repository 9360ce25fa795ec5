"""The ends of the legs of a line."""

import numpy as np

from thalweg.core.arrays.leg_ends import leg_ends


def test_each_leg_ends_where_the_next_begins():
    lat, lon = np.array([1.0, 2.0, 3.0]), np.array([4.0, 5.0, 6.0])
    assert [part.tolist() for part in leg_ends(lat, lon)] == [[1, 2], [4, 5], [2, 3], [5, 6]]
    assert all(part.size == 0 for part in leg_ends(lat[:1], lon[:1]))
