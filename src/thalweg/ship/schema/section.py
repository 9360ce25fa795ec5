"""`Section`: what all sections of a ship file have in common."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pydantic import BaseModel, ConfigDict, model_validator
from pydantic_core import PydanticCustomError


class Section(BaseModel):
    """A section of a ship file: its keys are checked, unknown keys are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)

    @model_validator(mode="before")
    @classmethod
    def _keys_have_values(cls, data: Any) -> Any:
        """Refuse keys without a value; None means "not given" in the typed sections only."""
        if isinstance(data, Mapping):
            for key, value in data.items():
                if value is None and key in cls.model_fields:
                    raise PydanticCustomError("no_value", "has no value", {"key": key})
        return data

    def plain(self) -> dict[str, Any]:
        """Return the keys that the file gives as plain data, with numbers as floats."""
        return self.model_dump(exclude_unset=True)

    def gives(self, *keys: str) -> bool:
        """Return whether the file gives any of these keys."""
        return not self.model_fields_set.isdisjoint(keys)
