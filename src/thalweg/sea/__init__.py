"""The sea: met-ocean fields from files and formulas, sampled and frozen for kernels."""

from thalweg.sea.frozen_fields import Area, Coverage, GridFields, Mesh, StationFields
from thalweg.sea.sea import Sea

__all__ = ["Area", "Coverage", "GridFields", "Mesh", "Sea", "StationFields"]
