"""How kernels are compiled, cached on disk and compiled ahead of their first use."""
