"""Made-up seas and tracks for tests, tutorials and examples."""
