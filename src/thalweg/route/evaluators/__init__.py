"""Quick evaluators: many tracks at once through a frozen raster of the sea."""
