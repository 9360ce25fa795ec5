"""The line that no route of a front is below: by least ways, fair currents and barriers."""
