"""The network on the triangles of a hydrodynamic model."""
