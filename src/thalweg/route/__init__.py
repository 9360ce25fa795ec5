"""The room route."""
