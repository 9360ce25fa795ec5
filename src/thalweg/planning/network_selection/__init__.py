"""Choice of the network of a voyage and of route alternatives by canals."""
