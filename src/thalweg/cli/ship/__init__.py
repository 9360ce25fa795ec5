"""``thalweg ship``: the ships of the library and their sheets."""
