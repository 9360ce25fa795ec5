"""The regional network: a lattice on a conformal projection, refined at coasts."""
