"""Studies: many voyages over departures, ships, speeds, routes or samples, and their statistics.

A `Study` is read from a file (`load_study`), run on one computer or a cluster (`run_study`), and
summarised (`summarise_study`). Every voyage is a row; a study that was stopped goes on where it
was.
"""

from thalweg.lazy_exports import lazy_exports

__getattr__, __all__ = lazy_exports(__name__, __path__[0])
