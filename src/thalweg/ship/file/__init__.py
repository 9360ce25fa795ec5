"""Ship files: reader and builder."""
