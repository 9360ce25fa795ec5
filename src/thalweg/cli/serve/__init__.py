"""``thalweg serve``."""
