"""A YAML loader for plain data only: no tags, no references, no key given twice."""

from __future__ import annotations

from typing import Any

import yaml


class StrictLoader(yaml.SafeLoader):
    """`yaml.SafeLoader` that refuses references and repeated keys."""

    def compose_node(self, parent: Any, index: Any) -> Any:
        """Refuse references, which can blow a small file up."""
        if self.check_event(yaml.AliasEvent):
            event = self.peek_event()
            raise yaml.composer.ComposerError(
                None, None, "references (*name) are not allowed", event.start_mark
            )
        return super().compose_node(parent, index)

    def construct_mapping(self, node: Any, deep: bool = False) -> Any:
        """Refuse keys that are given twice."""
        seen: set[str] = set()
        for key, _ in node.value:
            word = key.value if isinstance(key.value, str) else None
            if word is not None and word in seen:
                raise yaml.constructor.ConstructorError(
                    None, None, f"the key {word[:80]!r} is given twice", key.start_mark
                )
            if word is not None:
                seen.add(word)
        return super().construct_mapping(node, deep=deep)
