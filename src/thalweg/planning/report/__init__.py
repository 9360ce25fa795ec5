"""What is written about a plan: output files, provenance, warnings."""
