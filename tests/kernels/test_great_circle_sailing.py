"""Great-circle legs: the times of polylines and of populations come from one integration."""

from __future__ import annotations

import numpy as np

from tests.evolution import jet
from thalweg.kernels.leg import population_sailing as columns
from thalweg.route.evaluators.time_evaluator import TrackBatch


def test_a_polyline_takes_the_time_of_the_same_track_to_the_bit():
    evaluator = jet.evaluator()
    tracks = evaluator.population([jet.straight(setting) for setting in (0, 5, 11)])
    tracks.genes[:, 1:-1, columns.LAT] += 5e-4 * np.arange(3)[:, None]
    tracks.genes[:, :, columns.IS_LOOKED_UP] = 0.0
    n = int(tracks.count[0])
    assert (tracks.count == n).all()
    pieces = np.tile(np.arange(3, n + 2), (3, 1))
    tracks.genes[:, : n - 1, columns.PIECES] = pieces
    scores, arrive = evaluator.sail(tracks)
    batch = TrackBatch(
        tracks.genes[:, :n, columns.LAT],
        tracks.genes[:, :n, columns.LON],
        np.full((3, n), -np.inf),
        tracks.genes[:, : n - 1, columns.SETTING].astype(np.int64),
        np.zeros(3),
    )
    times, last = evaluator.time_evaluator.sail(batch, pieces=pieces)
    assert (scores[:, columns.VIOLATION] == 0.0).all()
    assert np.ptp(scores[:, columns.TIME]) > 100.0
    np.testing.assert_array_equal(times, arrive[:, :n])
    np.testing.assert_array_equal(last, scores[:, columns.TIME])
