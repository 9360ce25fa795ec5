"""One passage between two points for one objective, and why none was found."""
