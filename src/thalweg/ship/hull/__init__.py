"""Hull particulars: checks and estimates by published regressions."""
