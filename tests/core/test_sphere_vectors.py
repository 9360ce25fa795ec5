"""Unit vectors on a sphere: arcs of chords, and positions."""

from __future__ import annotations

import numpy as np
import pytest

from thalweg.core.arrays.sphere_vectors import arc_of_chord, spherical_positions


def test_arcs_of_chords():
    arcs = np.array([0.0, 1e-9, 0.5, 0.5 * np.pi, np.pi])
    assert arc_of_chord(2.0 * np.sin(0.5 * arcs)) == pytest.approx(arcs, rel=1e-12)
    assert arc_of_chord(np.array([2.0 + 1e-15, np.inf])) == pytest.approx(np.pi)
    assert np.isnan(arc_of_chord(np.array([np.nan])))


def test_positions_of_vectors_of_any_length():
    vectors = np.array([[1.0, 0.0, 0.0], [0.0, -3.0, 0.0], [0.0, 0.0, 2.0], [-1.0, 0.0, 1.0]])
    lat, lon = spherical_positions(vectors)
    assert lat == pytest.approx([0.0, 0.0, 90.0, 45.0])
    assert lon == pytest.approx([0.0, -90.0, 0.0, 180.0])
