"""Added resistance by wind and waves."""
