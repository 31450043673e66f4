"""How large a radiance file may be. Checked on the numbers a header claims, before anything of that size is made."""

from shviewer.errors import LightError

MAX_FILE_BYTES = 512 * 2**20
MAX_HEADER_BYTES = 64 * 2**10
MAX_SIDE = 32768  # texels
MAX_TEXELS = 2**27


def check_size(width: int, height: int, what: str = "image") -> None:
    """Raises LightError unless both sides (texels) and their product are within the limits."""
    if not (1 <= width <= MAX_SIDE and 1 <= height <= MAX_SIDE):
        raise LightError(f"{what} of {width} x {height} texels; a side must be 1 to {MAX_SIDE}: resize or re-export it")
    if width * height > MAX_TEXELS:
        raise LightError(
            f"{what} of {width} x {height} = {width * height} texels; the limit is {MAX_TEXELS}: make it smaller"
        )
