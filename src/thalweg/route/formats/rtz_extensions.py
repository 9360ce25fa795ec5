"""Extensions of other makers in RTZ files, as texts with the prefixes of their namespaces."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from xml.etree import ElementTree
from xml.sax.saxutils import escape

from thalweg.core.errors import InputError
from thalweg.route.carried_extensions import CarriedExtensions, Visit
from thalweg.route.formats.rtz_checks import schedule_elements
from thalweg.route.formats.rtz_writer import MANUFACTURER, ORDER
from thalweg.route.formats.xml_elements import (
    NamespaceTreeBuilder,
    children,
    escaped,
)

_DEEPEST = 50  # levels of elements in an extension
_XML_NAMESPACE = "http://www.w3.org/XML/1998/namespace"
_RETURN = {"\r": "&#13;"}
_RTZ = None  # the default namespace of the file that is written


def rtz_extensions(
    root: ElementTree.Element,
    waypoints: list[ElementTree.Element],
    visits: list[Visit],
    builder: NamespaceTreeBuilder,
) -> CarriedExtensions:
    """Return the extensions of other makers in an RTZ file.

    Parameters
    ----------
    root, waypoints : The route, and its waypoints in order.
    visits : Of the waypoints.
    builder : That made the tree.

    Raises
    ------
    InputError : If elements of an extension are nested too deep.
    """
    reader = _ExtensionReader(root, builder)
    for group in children(root, "waypoints"):
        reader.add("waypoints", group)
        for default in children(group, "defaultWaypoint"):
            reader.add("defaultWaypoint", group, default)
            for leg in children(default, "leg"):
                reader.add("defaultLeg", group, default, leg)
        for waypoint, visit in zip(waypoints, visits):
            if len(waypoint) > 1:
                reader.add("waypoint", group, waypoint, at=visit)
                for leg in children(waypoint, "leg"):
                    reader.add("leg", group, waypoint, leg, at=visit)
    for info in children(root, "routeInfo"):
        reader.add("routeInfo", info)
    visit_at = {waypoint.get("id"): visit for waypoint, visit in zip(waypoints, visits)}
    for group in children(root, "schedules"):
        reader.add("schedules", group)
        for schedule in children(group, "schedule"):
            reader.add_schedule(visit_at, group, schedule)
    reader.add("route")
    return CarriedExtensions(
        {name: tuple(texts) for name, texts in reader.general.items()},
        {
            visit: {name: tuple(texts) for name, texts in found.items()}
            for visit, found in reader.at.items()
        },
    )


class _ExtensionReader:
    """Collects texts of extensions.

    Attributes
    ----------
    general, at : As of `CarriedExtensions`.
    """

    def __init__(self, root: ElementTree.Element, builder: NamespaceTreeBuilder) -> None:
        self.general: dict[str, list[str]] = {}
        self.at: dict[Visit, dict[str, list[str]]] = {}
        self._root, self._declared = root, builder.declared
        self._namespace = _namespace_of(str(root.tag))

    def add(self, name: str, *parents: ElementTree.Element, at: Visit | None = None) -> None:
        """Add the extensions in an element.

        Parameters
        ----------
        name : Of the element among those of `CarriedExtensions`.
        parents : The elements below the route, down to that which holds the extensions.
        at : The visit of the waypoint that it belongs to.
        """
        line = (self._root, *parents)
        for group in children(line[-1], "extensions"):
            texts = [
                self._text(child, self._scope((*line, group)))
                for child in group
                if (child.get("manufacturer"), child.get("name")) != (MANUFACTURER, ORDER)
            ]
            if texts:
                found = self.general if at is None else self.at.setdefault(at, {})
                found.setdefault(name, []).extend(texts)

    def add_schedule(
        self,
        visit_at: Mapping[str | None, Visit],
        group: ElementTree.Element,
        schedule: ElementTree.Element,
    ) -> None:
        """Add the extensions in a schedule, its two parts and their elements."""
        self.add("schedule", group, schedule)
        for kind in ("manual", "calculated"):
            for part in children(schedule, kind):
                self.add(kind, group, schedule, part)
            for element in schedule_elements(schedule, kind):
                visit = visit_at.get(element.get("waypointId"))
                if len(element) and visit is not None:
                    self.add(f"{kind}Element", group, schedule, element, at=visit)

    def _scope(self, line: Iterable[ElementTree.Element]) -> dict[str, str]:
        """Return the namespaces by prefix inside a line of elements."""
        scope: dict[str, str] = {}
        for element in line:
            scope |= self._declared.get(element, {})
        return scope

    def _text(self, element: ElementTree.Element, scope: dict[str, str]) -> str:
        """Return the text of an extension, which declares the prefixes in it."""
        plain = self._element(element, scope, _RTZ, {})
        used = {
            prefix: uri for prefix, uri in scope.items() if prefix and f"{prefix}:" in plain
        } or None
        return plain if used is None else self._element(element, scope, _RTZ, used)

    def _element(
        self,
        element: ElementTree.Element,
        scope: Mapping[str, str],
        default: str | None,
        declarations: Mapping[str, str],
        depth: int = 0,
    ) -> str:
        """Return the text of an element.

        Parameters
        ----------
        scope : Namespaces by prefix around it in the file that was read.
        default : Namespace of names without prefix around it in the text.
        declarations : Prefixes to declare besides its own.
        """
        if depth > _DEEPEST:
            raise InputError(
                "An extension of the RTZ has elements nested too deep.",
                f"{_DEEPEST} levels are read.",
                "Remove the extension.",
            )
        own = self._declared.get(element, {})
        scope = {**scope, **own}
        declared = {**declarations, **{prefix: uri for prefix, uri in own.items() if prefix}}
        name, default = self._name(str(element.tag), scope, default, declared)
        attributes = {
            (f"xmlns:{prefix}" if prefix else "xmlns"): uri for prefix, uri in declared.items()
        } | {_attribute_name(key, scope): text for key, text in element.attrib.items()}
        given = "".join(f' {key}="{escaped(text)}"' for key, text in attributes.items())
        within = escape(element.text or "", _RETURN)
        for child in element:
            within += self._element(child, scope, default, {}, depth + 1)
            within += escape(child.tail or "", _RETURN)
        return f"<{name}{given}>{within}</{name}>" if within else f"<{name}{given} />"

    def _name(
        self, tag: str, scope: Mapping[str, str], default: str | None, declared: dict[str, str]
    ) -> tuple[str, str | None]:
        """Return the name of an element, and the default namespace in it; may declare that."""
        uri, local = _namespace_of(tag), tag.rpartition("}")[2]
        if uri == self._namespace and default is _RTZ:
            return local, default
        if uri == default:
            return local, default
        prefixes = [prefix for prefix, known in scope.items() if prefix and known == uri]
        if prefixes and scope.get("") != uri:
            return f"{prefixes[-1]}:{local}", default
        declared[""] = uri
        return local, uri


def _namespace_of(tag: str) -> str:
    return tag[1:].partition("}")[0] if tag.startswith("{") else ""


def _attribute_name(key: str, scope: Mapping[str, str]) -> str:
    """Return the name of an attribute with its prefix."""
    uri, local = _namespace_of(key), key.rpartition("}")[2]
    if not uri:
        return local
    if uri == _XML_NAMESPACE:
        return f"xml:{local}"
    return f"{next(prefix for prefix, known in scope.items() if prefix and known == uri)}:{local}"
