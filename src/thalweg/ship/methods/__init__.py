"""Ship physics: one plain function per formula, each with its source, in SI units."""
