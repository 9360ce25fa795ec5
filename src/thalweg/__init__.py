"""Thalweg: voyage optimisation for ships, with proof of how good the answer is."""

from __future__ import annotations

from typing import Any

from thalweg import deprecated_names
from thalweg.lazy_exports import lazy_exports

deprecated_names.install()
_exported, __all__ = lazy_exports(__name__, __path__[0])


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from importlib.metadata import version

        return version("thalweg")
    return _exported(name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
