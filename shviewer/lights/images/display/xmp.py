"""The properties in an XMP packet: names and texts, from whoever wrote the file.

A packet is XML with no declarations of types: one that declares types or entities is not read.

Source
    [XMP] ISO 16684-1:2019, 7: RDF properties as attributes, as elements, and as lists of elements
"""

from __future__ import annotations

from xml.etree import ElementTree

_RDF = "{http://www.w3.org/1999/02/22-rdf-syntax-ns#}"
_LISTS = (f"{_RDF}Seq", f"{_RDF}Bag", f"{_RDF}Alt")

Properties = dict[str, list[str]]
""" "{namespace}name" -> its text, or the texts of a list."""


def properties(packet: bytes) -> Properties:
    """The properties of the descriptions in a packet, the first of each name; none if it is not XML."""
    text = packet.decode("utf-8", "replace").strip("\0\ufeff \t\r\n")
    if "<!DOCTYPE" in text or "<!ENTITY" in text:
        return {}
    try:
        tree = ElementTree.fromstring(text)
    except (ElementTree.ParseError, ValueError, RecursionError):
        return {}
    found: Properties = {}
    for description in tree.iter(f"{_RDF}Description"):
        for name, value in description.items():
            found.setdefault(name, [value.strip()])
        for element in description:
            found.setdefault(element.tag, _texts(element))
    return found


def _texts(element: ElementTree.Element) -> list[str]:
    for content in element:
        if content.tag in _LISTS:
            return [(item.text or "").strip() for item in content]
    return [(element.text or "").strip()]


def number(texts: list[str] | None) -> float | None:
    """The only number of a property; None if it has another form."""
    try:
        return float(texts[0]) if texts and len(texts) == 1 else None
    except ValueError:
        return None
