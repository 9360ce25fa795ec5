"""Schema of the ship file: sections, types of values, error messages."""
