"""Where the values of a sea come from: plain facts, and a hash of them."""

from __future__ import annotations

import hashlib
import json
from typing import Any, Protocol

from thalweg.sea.layer import Layer


class HasSources(Protocol):
    """What has layers and assumptions, as a sea does."""

    @property
    def layers(self) -> tuple[Layer, ...]:
        """Sources, in order of priority."""
        ...

    @property
    def assumptions(self) -> tuple[str, ...]:
        """Values that were assumed at the user's request."""
        ...


def sea_provenance(sea: HasSources) -> dict[str, Any]:
    """Return plain facts about every layer and assumption, for JSON.

    Returns
    -------
    dict
        ``layers`` (one dict for each), ``assumptions`` and ``fingerprint``.
    """
    return {
        "layers": [dict(layer.provenance()) for layer in sea.layers],
        "assumptions": list(sea.assumptions),
        "fingerprint": sea_fingerprint(sea),
    }


def sea_fingerprint(sea: HasSources) -> str:
    """Return a hash that changes when a file, its variables or an assumption changes.

    Returns
    -------
    str
        32 hexadecimal digits.
    """
    facts = [dict(layer.provenance()) for layer in sea.layers]
    text = json.dumps([facts, sea.assumptions], sort_keys=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()[:32]
