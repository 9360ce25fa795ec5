"""Kernels of the certificate: barrier functions of the arrival time on a mesh of triangles."""
