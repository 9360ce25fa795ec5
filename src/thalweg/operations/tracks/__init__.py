"""Analysis of recorded tracks: reading, cleaning, activities, calibration."""
