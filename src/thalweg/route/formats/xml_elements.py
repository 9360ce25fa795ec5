"""XML of route files: read without entities, found by name in any namespace, written at once."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from thalweg.core.errors import InputError
from thalweg.core.file_writing import write_bytes

_HEAD = "<?xml version='1.0' encoding='utf-8'?>\n"
_SPECIAL = re.compile(r'[&<>"\r\n\t]')
_ESCAPES = {
    "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "\r": "&#13;", "\n": "&#10;",
    "\t": "&#09;",
}  # fmt: skip


class NamespaceTreeBuilder(ElementTree.TreeBuilder):
    """Builds a tree, and keeps which prefixes its elements declare.

    Attributes
    ----------
    declared : By element, the namespaces that it declares by prefix; '' is that of names without.
    """

    def __init__(self) -> None:
        super().__init__()
        self.declared: dict[ElementTree.Element, dict[str, str]] = {}
        self._next: dict[str, str] = {}

    def start_ns(self, prefix: str | None, uri: str | None) -> None:
        """Note a namespace that the next element declares."""
        self._next[prefix or ""] = uri or ""

    def end_ns(self, prefix: str | None) -> None:
        """Do nothing: the end of an element ends its declarations."""

    def start(self, tag: str, attrs: dict[str, str]) -> ElementTree.Element:  # type: ignore[override]
        """Begin an element."""
        element = super().start(tag, attrs)
        if self._next:
            self.declared[element], self._next = self._next, {}
        return element


def parse_xml(
    data: bytes | str, what: str, builder: NamespaceTreeBuilder | None = None
) -> ElementTree.Element:
    """Return the root element of an XML text that declares no entities.

    Parameters
    ----------
    what : The format, for messages.
    builder : Keeps the prefixes of namespaces.

    Raises
    ------
    InputError : If it is not XML, or declares entities.
    """
    from defusedxml import DefusedXmlException
    from defusedxml.ElementTree import DefusedXMLParser

    try:
        parser = DefusedXMLParser(target=builder)
        parser.feed(data)
        root: ElementTree.Element = parser.close()
    except (ElementTree.ParseError, DefusedXmlException, ValueError, LookupError) as error:
        entities = isinstance(error, DefusedXmlException)
        raise InputError(
            f"The {what} cannot be read: {'it declares entities' if entities else error}.",
            "The file must be well-formed XML without entities.",
            "Check that the file is complete.",
        ) from None
    return root


@lru_cache(maxsize=256)
def _without_namespace(tag: Any) -> str:
    return str(tag).rpartition("}")[2]


def local_name(element: ElementTree.Element) -> str:
    """Return the name of an element without its namespace."""
    return _without_namespace(element.tag)


def children(element: ElementTree.Element, name: str) -> Iterator[ElementTree.Element]:
    """Return the children of an element by name, whatever their namespace."""
    return iter([child for child in element if _without_namespace(child.tag) == name])


def escaped(text: str) -> str:
    """Return a text as it stands in an attribute or an element."""
    return _SPECIAL.sub(lambda found: _ESCAPES[found[0]], text)


def add_text(parent: ElementTree.Element, name: str, text: str) -> None:
    """Add an element that holds a text."""
    ElementTree.SubElement(parent, name).text = text


def xml_text(
    name: str, attributes: Mapping[str, str], inside: Iterable[str] = (), depth: int = 0
) -> str:
    """Return an element as a line of XML, or as more with what is inside.

    Parameters
    ----------
    inside : Texts of the elements in it, indented.
    depth : Of the element in the tree: it is indented by two spaces for each.
    """
    if _SPECIAL.search("".join(attributes.values())):
        attributes = {key: escaped(text) for key, text in attributes.items()}
    given = "".join([f' {key}="{text}"' for key, text in attributes.items()])
    within = "\n".join(inside)
    edge = "  " * depth
    if not within:
        return f"{edge}<{name}{given} />"
    return f"{edge}<{name}{given}>\n{within}\n{edge}</{name}>"


def xml_file(root: str) -> bytes:
    """Return the bytes of an XML file with the text of its root element."""
    return f"{_HEAD}{root}".encode()


def write_xml(root: ElementTree.Element, path: str | Path) -> None:
    """Write an element as an indented XML file in UTF-8."""
    ElementTree.indent(root)
    write_bytes(path, xml_file(ElementTree.tostring(root, encoding="unicode")))


def decimal(value: float, digits: int) -> str:
    """Return a number without exponent and without needless zeros."""
    text = f"{float(value):.{digits}f}"
    return text.rstrip("0").rstrip(".") if "." in text else text
