"""Planned voyages as activities of OpenCLSim."""
