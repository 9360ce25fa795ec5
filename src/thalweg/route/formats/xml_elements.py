"""XML of route files: read without entities, found by name in any namespace, written at once."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

from thalweg.core.errors import InputError
from thalweg.core.file_writing import write_bytes


def parse_xml(data: bytes | str, what: str, *, largest: int | None = None) -> ElementTree.Element:
    """Return the root element of an XML text that declares no entities.

    Parameters
    ----------
    what : The format, for messages.
    largest : Bytes that are read at most.

    Raises
    ------
    InputError : If it is too large, not XML, or declares entities.
    """
    from defusedxml import DefusedXmlException
    from defusedxml.ElementTree import fromstring

    if largest is not None and len(data) > largest:
        raise InputError(
            f"The {what} has {len(data) / 1e6:.1f} MB.",
            f"It may have {largest / 1e6:.0f} MB at most.",
            "Remove what is not the route.",
        )
    try:
        root: ElementTree.Element = fromstring(data)
    except (ElementTree.ParseError, DefusedXmlException, ValueError, LookupError) as error:
        entities = isinstance(error, DefusedXmlException)
        raise InputError(
            f"The {what} cannot be read: {'it declares entities' if entities else error}.",
            "The file must be well-formed XML without entities.",
            "Check that the file is complete.",
        ) from None
    return root


def local_name(element: ElementTree.Element) -> str:
    """Return the name of an element without its namespace."""
    return str(element.tag).rpartition("}")[2]


def children(element: ElementTree.Element, name: str) -> Iterator[ElementTree.Element]:
    """Return the children of an element by name, whatever their namespace."""
    return (child for child in element if local_name(child) == name)


def xml_bytes(root: ElementTree.Element) -> bytes:
    """Return an element as an indented XML text in UTF-8."""
    ElementTree.indent(root)
    text = ElementTree.tostring(root, encoding="unicode")
    return f"<?xml version='1.0' encoding='utf-8'?>\n{text}".encode()


def write_xml(root: ElementTree.Element, path: str | Path) -> None:
    """Write an element as an XML file."""
    write_bytes(path, xml_bytes(root))


def decimal(value: float, digits: int) -> str:
    """Return a number without exponent and without needless zeros."""
    text = f"{float(value):.{digits}f}"
    return text.rstrip("0").rstrip(".") if "." in text else text
