"""Plain data as text by which equal data are recognised."""

from __future__ import annotations

import json
from typing import Any


def canonical_json(value: Any) -> str:
    """Return JSON that is the same for equal data.

    Parameters
    ----------
    value : plain data

    Returns
    -------
    str
    """
    return json.dumps(value, sort_keys=True, separators=(",", ":"), allow_nan=False)
