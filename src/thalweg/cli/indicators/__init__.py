"""The command for routes that differ, beside each other."""
