"""Alternative paths round land: homotopy classes, their shortest paths, string pulling."""
