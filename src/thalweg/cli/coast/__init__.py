"""Options and tables for coasts: layered networks, motions and comfort."""
