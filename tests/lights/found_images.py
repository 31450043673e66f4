"""Images as programs write them, and what is made of them: rows of a table in the guide, each of which is a test.

Every file is made here, small, as the program writes it: the programs themselves are not needed.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

GREY = ((128 / 255 + 0.055) / 1.055) ** 2.4
"""The linear value of the sRGB code 128."""


class Found(NamedTuple):
    program: str
    writes: str
    becomes: str
    """What is made of it, in words; the light has the mean, and its notes or its refusal say `said`."""
    name: str
    data: Callable[[], bytes]
    mean: tuple[float, float, float] | None
    """Of the light; None for a file that is refused."""
    said: str = ""


def found_images() -> tuple[Found, ...]:
    return (*_hdr(),)


def table() -> str:
    """The rows as the guide has them."""
    rows = [f"| {row.program} | {row.writes} | {row.becomes} |" for row in found_images()]
    return "\n".join(["", "| program | writes | is read as |", "|---|---|---|", *rows, "", ""])


def _hdr() -> tuple[Found, ...]:
    base = (1.0, 0.5, 0.25)

    def file(header: bytes) -> Callable[[], bytes]:
        return lambda: header + b"-Y 8 +X 16\n" + bytes((128, 64, 32, 129)) * 128

    def set_to(line: bytes) -> Callable[[], bytes]:
        return file(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n" + line + b"\n\n")

    own = b"PRIMARIES= 0.6400 0.3300 0.2900 0.6000 0.1500 0.0600 0.3333 0.3333"
    return (
        Found("FreeImage up to 3.17", "`.hdr` with `EXPOSURE=0`", "the line is ignored, with a note",
              "a.hdr", set_to(b"EXPOSURE=0"), base, "'EXPOSURE=0' ignored"),
        Found("programs in a language with decimal commas", "`.hdr` with `EXPOSURE=2,000000`", "a decimal comma",
              "a.hdr", set_to(b"EXPOSURE=2,000000"), (0.5, 0.25, 0.125), "EXPOSURE 2 divided out"),
        Found("Radiance and its libraries", "`.hdr` with Radiance's own `PRIMARIES`",
              "the light of a file that states none: taken for Rec. 709", "a.hdr", set_to(own), base, "Radiance's own"),
        Found("Photoshop", "`.hdr` with the magic twice and `PRIMARIES=0 0 0 0 0 0 0 0`",
              "the primaries are ignored, with a note", "a.hdr",
              file(b"#?RADIANCE\n# Made with Adobe Photoshop\nGAMMA=1\nPRIMARIES=0 0 0 0 0 0 0 0\n"
                   b"FORMAT=32-bit_rle_rgbe\n#?RADIANCE\n\n"), base, "as Photoshop writes them"),
        Found("writers of their own", "`.hdr` without the empty line, with two, with CR, with a byte order mark",
              "as if it had one", "a.hdr", file(b"\xef\xbb\xbf#?RGBE\r\nFORMAT=32-bit_rle_rgbe\r\n"), base),
    )  # fmt: skip
