"""``thalweg ship``: the ships of the library, their sheets and motions."""
