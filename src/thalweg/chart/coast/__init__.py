"""Coastline: reading outlines, indexing them, testing legs against land, moving points to water."""
