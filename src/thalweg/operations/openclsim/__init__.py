"""Planned voyages as activities of OpenCLSim; `plugin` needs ``thalweg[openclsim]``."""

from thalweg.operations.openclsim.leg_planner import LegPlanner

__all__ = ["LegPlanner"]
