"""The old name of the class of boxes."""

from __future__ import annotations

import pytest

import thalweg.sea
from thalweg.core.bounding_box import BoundingBox


def test_the_old_name_of_the_box_still_works_and_names_the_new_one():
    with pytest.warns(DeprecationWarning, match=r"core\.bounding_box\.BoundingBox"):
        assert thalweg.sea.Area is BoundingBox


def test_an_unknown_name_is_refused():
    with pytest.raises(AttributeError, match="has no attribute 'Nothing'"):
        _ = thalweg.sea.Nothing
