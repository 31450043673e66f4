"""Options that several modes of the command line have in common, and how their values are read.

No mode is imported here, so that --help stays fast.
"""

from __future__ import annotations

import argparse
import math
from typing import NoReturn

LIGHT_HELP = (
    "a built-in name (--list-lights), a .toml scene, an image (.hdr, .exr, file.exr:layer, .png or .jpg), "
    "file.py:function, or coefficients (.json, .csv, .txt, .npz, .h, .glsl)"
)


class OneLineParser(argparse.ArgumentParser):
    """argparse, but a mistake is one line on stderr and not the usage, too."""

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"shviewer: {' '.join(message.split())}; see {self.prog} --help\n")


def add_view_options(parser: OneLineParser) -> None:
    """LIGHT, and everything that a picture of it depends on."""
    parser.add_argument("light", metavar="LIGHT", nargs="?", default="green", help=f"{LIGHT_HELP} (default green)")
    add_projection_options(parser)
    add_picture_options(parser)
    add_reading_options(parser)


def add_projection_options(parser: OneLineParser) -> None:
    """How a light is projected, and what is kept of it."""
    parser.add_argument("--bands", metavar="N", type=int, help="number of bands, 1 to 128 (default 5)")
    parser.add_argument(
        "--tolerance",
        metavar="T",
        type=_tolerance,
        help="as many bands as keep the relative L2 error within T, such as 5%% or 0.05, instead of --bands",
    )
    parser.add_argument(
        "--for",
        metavar="WHAT",
        dest="quantity",
        help="radiance (default), or irradiance: what a white Lambertian surface receives",
    )
    parser.add_argument(
        "--split-sun", action="store_true", help="take suns out of the light as discs of their own and project the rest"
    )
    parser.add_argument(
        "--window",
        metavar="W[:WIDTH]",
        default="none",
        help="none, hann, lanczos, gauss (WIDTH in bands, default N) or dering",
    )
    parser.add_argument(
        "--mute", metavar="L,L", type=_band_list, default=frozenset(), help="bands to leave out, such as 1,3"
    )
    parser.add_argument(
        "--method", metavar="M", default="best", help="best (of this light), jittered (the paper's) or gauss-legendre"
    )
    parser.add_argument(
        "--samples", metavar="K", type=_count, default=10_000, help="of the sampled methods (default 10000)"
    )
    parser.add_argument("--seed", metavar="S", type=int, default=0, help="of the jittered samples (default 0)")


def add_picture_options(parser: OneLineParser) -> None:
    """What is drawn of it, and how."""
    parser.add_argument(
        "--compare",
        metavar="FILE",
        help="show the coefficients in FILE instead of the light's own, and say how well they agree, or by which usual "
        "mistake they are off; finds out the convention of a bare list, if none is named",
    )
    parser.add_argument("--exposure", metavar="STOPS", type=finite, help="fixed, instead of chosen from the light")
    parser.add_argument("--tone", metavar="T", default="none", help="curve after exposure: none, reinhard, aces or log")
    parser.add_argument(
        "--error",
        metavar="E",
        default="off",
        help="a third sphere, reconstruction minus original: off (default), signed, absolute or relative",
    )
    parser.add_argument(
        "--error-range",
        metavar="R",
        help="where its colours end: a radiance, or for the relative error such as 20%%; chosen from the light unless given",
    )
    parser.add_argument("--no-marks", action="store_true", help="do not mark the minimum and the largest error")
    parser.add_argument(
        "--lobes", action="store_true", help="surfaces in place of spheres: radius is magnitude, colour is sign"
    )
    parser.add_argument(
        "--basis", metavar=("L", "M"), nargs=2, type=int, help="the surface of one basis function Y(l, m) on the right"
    )
    parser.add_argument("--convergence", action="store_true", help="plot the error against the number of bands")
    parser.add_argument(
        "--evaluate",
        metavar="E",
        default="auto",
        help="sum the bands per pixel (direct), draw from a map, or auto (default): by the time that a frame takes",
    )
    parser.add_argument(
        "--camera", metavar=("AZIMUTH", "ELEVATION"), nargs=2, type=finite, help="where the camera stands, degrees"
    )
    parser.add_argument(
        "--rotate-light",
        metavar=("AZIMUTH", "ELEVATION"),
        nargs=2,
        type=finite,
        help="turn the light so that its +x axis points there, degrees",
    )
    parser.add_argument(
        "--zoom", metavar="Z", type=finite, default=1.0, help="size of the spheres, 0.25 to 16 (default 1)"
    )
    parser.add_argument(
        "--size", metavar=("W", "H"), nargs=2, type=int, default=(1280, 640), help="pixels (default 1280 640)"
    )


def add_reading_options(parser: OneLineParser, convention: str = "--convention") -> None:
    """How an image is read, and coefficients that do not say their convention."""
    parser.add_argument(
        convention,
        metavar="C",
        dest="input_convention",
        default="",
        help="of a bare list of coefficients: shviewer, filament, three, unity, unreal, ambix, sphericart or scipy",
    )
    parser.add_argument(
        "--sanitize",
        action="store_true",
        help="repair NaN, infinite and negative texels of an image instead of refusing or keeping them",
    )
    parser.add_argument(
        "--layout",
        metavar="L",
        default="auto",
        help="how an image covers the sphere: auto (default), lat-long, cube, angular or mirror-ball",
    )
    parser.add_argument(
        "--max-side",
        metavar="N",
        type=_positive_count,
        help="texels along a side that an image may have (default 32768)",
    )
    parser.add_argument(
        "--max-megatexels",
        metavar="M",
        type=_positive,
        help="texels that an image may have, in units of 1024 x 1024 (default 128)",
    )
    parser.add_argument(
        "--max-file-mib", metavar="M", type=_positive, help="size that an image's file may have, in MiB (default 512)"
    )


def _band_list(text: str) -> frozenset[int]:
    try:
        return frozenset(int(part) for part in text.split(",") if part.strip())
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"{text!r}: bands are whole numbers separated by commas, such as 1,3"
        ) from None


def _count(text: str) -> int:
    value = finite(text)  # 1e6 is a count, too
    if value != int(value):
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number")
    return int(value)


def _positive_count(text: str) -> int:
    return int(_positive(str(_count(text))))


def _positive(text: str) -> float:
    value = finite(text)
    if not value > 0:
        raise argparse.ArgumentTypeError(f"{text!r} is not positive")
    return value


def finite(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"{text!r} is not a finite number")
    return value


def _tolerance(text: str) -> float:
    value = finite(text.removesuffix("%")) / (100 if text.endswith("%") else 1)
    if not 0 < value < 1:
        hint = f"did you mean {text}%?" if 1 <= value < 100 and not text.endswith("%") else "such as 0.05 or 5%"
        raise argparse.ArgumentTypeError(f"{text!r}: a tolerance is between 0 and 1; {hint}")
    return value


def share(text: str) -> float:
    value = finite(text)
    if not 0 <= value <= 1:
        raise argparse.ArgumentTypeError(f"{text!r}: a share is 0 to 1")
    return value
