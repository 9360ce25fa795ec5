"""The room chart."""
