"""Limits of size: of files and images, checked before memory is taken, of bands, and of radiance that float32 can show."""

from __future__ import annotations

from dataclasses import dataclass

from shviewer.errors import LightError

MAX_BANDS = 128
"""The most bands that are read, projected by the program and shown."""

MAX_DIRECT_BANDS = 32
"""The most bands the fragment shader sums: 32**2 vec4 fill the 16 KiB that every driver grants a uniform block."""

MAX_SAMPLES = 16_000_000
"""The most directions a rule may have: 512 MB of directions and weights."""

DIMMEST, BRIGHTEST = 1e-30, 1e30
"""The largest radiance of a light that can be drawn: beyond, sums and products would leave float32."""


ROUNDED = 1 + 2**-23
"""A float32 image of exactly BRIGHTEST is brighter by less than this factor."""


def check_radiance(largest: float, name: str) -> None:
    """LightError unless float32 can show the largest radiance of the light `name`; it can show black."""
    if not (largest == 0 or DIMMEST <= largest <= BRIGHTEST * ROUNDED):
        raise LightError(
            f"{name}: its largest radiance is {largest:.3g}; float32 shows {DIMMEST:g} to {BRIGHTEST:g}: scale the light"
        )


def check_brightness(radiance: float, name: str) -> None:
    """LightError for a radiance above what float32 can show: the check for a light that is only being made."""
    if radiance > BRIGHTEST * ROUNDED:
        check_radiance(radiance, name)


@dataclass(frozen=True)
class Limits:
    """The largest image. side: texels along a side; texels: in the whole image; file_bytes: size of the file.

    Checked on the numbers a header claims, before anything of that size is made.
    """

    side: int = 32768
    texels: int = 2**27
    file_bytes: int = 512 * 2**20

    def check_file(self, size: int) -> None:
        """Raises LightError for a file of more than `file_bytes` bytes."""
        if size > self.file_bytes:
            raise LightError(
                f"{size} bytes; the limit is {self.file_bytes}: make the image smaller, or raise it (--max-file-mib)"
            )

    def check_size(self, width: int, height: int, what: str = "image") -> None:
        """Raises LightError unless both sides (texels) and their product are within the limits."""
        if not (1 <= width <= self.side and 1 <= height <= self.side):
            raise LightError(
                f"{what} of {width} x {height} texels; a side must be 1 to {self.side}: resize or re-export it, or raise"
                " the limit (--max-side)"
            )
        if width * height > self.texels:
            raise LightError(
                f"{what} of {width} x {height} = {width * height} texels; the limit is {self.texels}: make it smaller,"
                " or raise it (--max-megatexels)"
            )


DEFAULT_LIMITS = Limits()
