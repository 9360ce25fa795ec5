"""Plans and evaluations as jobs: kept on disk, each in a process of its own."""
