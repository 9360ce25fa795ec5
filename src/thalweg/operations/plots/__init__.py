"""Pictures of dredging projects, track analyses and waiting studies."""
