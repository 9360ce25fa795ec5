"""The global network: a geodesic grid refined at coasts and straits."""
