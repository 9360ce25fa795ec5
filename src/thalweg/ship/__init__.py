"""The room ship."""
