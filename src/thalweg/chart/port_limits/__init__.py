"""Limits of ports that lines and tables of the World Port Index do not have."""
