"""The room sea."""
