"""Alternative paths around land: homotopy classes, their shortest paths, string pulling."""

import sys

from thalweg.deprecated_names import CallableModule

sys.modules[__name__].__class__ = CallableModule  # `alternatives` was once a function
