"""The sea: met-ocean fields from files and formulas, sampled and frozen for kernels."""

from __future__ import annotations

import warnings

from thalweg.core.bounding_box import BoundingBox
from thalweg.sea.coverage import Coverage
from thalweg.sea.frozen_fields import GridFields, StationFields
from thalweg.sea.sea import Sea
from thalweg.sea.triangle_mesh import Mesh

__all__ = ["BoundingBox", "Coverage", "GridFields", "Mesh", "Sea", "StationFields"]


def __getattr__(name: str) -> type[BoundingBox]:
    if name == "Area":
        warnings.warn(
            "thalweg.sea.Area is deprecated; use thalweg.core.bounding_box.BoundingBox.",
            DeprecationWarning,
            stacklevel=2,
        )
        return BoundingBox
    raise AttributeError(f"module 'thalweg.sea' has no attribute {name!r}")
