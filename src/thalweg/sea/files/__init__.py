"""Files of met-ocean data: opening, recognising variables and grids, checking values."""
