"""Ship files: schema, reader and builder."""
