from thalweg.core.bounding_box import BoundingBox
from thalweg.sea.coverage import Coverage
from thalweg.sea.frozen_fields import GridFields, StationFields
from thalweg.sea.sea import Sea
from thalweg.sea.triangle_mesh import Mesh

__all__ = ["BoundingBox", "Coverage", "GridFields", "Mesh", "Sea", "StationFields"]
