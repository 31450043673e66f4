"""Limits of size: of files, images and memory, checked before it is taken, of bands, and of radiance that float32 can show."""

from __future__ import annotations

from dataclasses import dataclass, field

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


MEMORY_SHARE = 0.5
"""The share of the available memory that one file may take, in all processes that work on a batch together."""

_processes = 1


def share_memory(processes: int) -> None:
    """Let this process take as much memory as one of so many."""
    global _processes
    _processes = processes


UNASKED = 2**24
"""Fewer bytes are taken without asking how many there are, which takes 0.3 ms."""

TEXEL_BYTES = 26
"""What a texel takes as it is drawn: 12 as it was read, 12 at most as a texture, and a little while it is projected."""

SPLIT_BYTES = 28
"""What a texel takes on top of that where a sun is taken out: its mean, and another image with its texture to draw the rest."""

RASTER_BYTES = 24
"""What a texel of the raster takes that stands for an image of another layout: raster and texture."""


@dataclass(frozen=True)
class Limits:
    """The largest image. side: texels along a side; texels: in the whole image; file_bytes: size of the file.

    Checked on the numbers a header claims, before anything of that size is made.
    """

    side: int = 32768
    texels: int = 2**27
    file_bytes: int = 512 * 2**20
    memory_bytes: int | None = field(default=None, compare=False)
    """The memory that one file may take; None: MEMORY_SHARE of what is available. It changes no value."""
    pipe_seconds: float = field(default=30.0, compare=False)
    """The time to wait for everything that comes through a pipe; 0: pipes are refused."""

    def check_file(self, size: int) -> None:
        """Raises LightError for a file of more than `file_bytes` bytes."""
        if size > self.file_bytes:
            raise LightError(
                f"{size} bytes; the limit is {self.file_bytes}: make the image smaller, or raise it (--max-file-mib)"
            )
        self.check_memory(size, f"a file of {size} bytes")

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

    def check_image(self, width: int, height: int, decoding: int, what: str = "image") -> None:
        """`check_size`, and LightError unless there is memory for the image until it is drawn.

        decoding: the bytes that the decoder takes at a time, its result and its copies of the file included.
        """
        self.check_size(width, height, what)
        self.check_memory(max(TEXEL_BYTES * width * height, decoding), f"{what} of {width} x {height} texels")

    def check_memory(self, needed: int, what: str) -> None:
        """LightError if `what` takes more bytes than there may be: the check before any large piece of memory is taken."""
        if self.memory_bytes is None and needed <= UNASKED:
            return
        most = self.most_memory
        if most is not None and needed > most:
            share = ", half of what is available" if self.memory_bytes is None else ""
            raise LightError(
                f"{what} takes up to {_mebibytes(needed)} of memory; the limit is {_mebibytes(most)}{share}: make it"
                " smaller, or raise the limit (--max-memory-mib)"
            )

    @property
    def most_memory(self) -> int | None:
        """The bytes that one file may take now; None where neither a user nor the system says."""
        if self.memory_bytes is not None:
            return self.memory_bytes
        from shviewer.memory import available_bytes  # here, since ctypes takes its time

        free = available_bytes()
        return None if free is None else int(MEMORY_SHARE * free / _processes)


def _mebibytes(count: float) -> str:
    return f"{count / 2**20:.0f} MiB"


DEFAULT_LIMITS = Limits()
