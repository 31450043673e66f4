"""Numbers, shares, angles, times and counts as text, the same in every place that shows them."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Sequence

MOST_CHARACTERS = 1000
"""The longest line that is made of text from outside: names of files, descriptions, what a library says."""


def one_line(text: str, most: int = MOST_CHARACTERS) -> str:
    """A text from outside made safe for a terminal: on one line, its control characters escaped, not longer than `most`."""
    shown = " ".join(text.split()) if not text.isprintable() else text
    if not shown.isprintable():
        shown = "".join(c if c.isprintable() else ascii(c)[1:-1] for c in shown)
    return shortened(shown, most)


def near(text: str, choices: Iterable[str], most: int = 3) -> list[str]:
    """The choices that a text nearly is, whatever its capitals, dots and dashes, the likeliest first.

    They are it, begin with it or it with them, or have seven tenths of their letters in common, as difflib counts them.
    """
    import difflib  # only where something is refused

    plain: dict[str, list[str]] = {}
    for choice in choices:
        plain.setdefault(_plain(choice), []).append(choice)
    wanted = _plain(text)
    begin = [
        one for one in plain if min(len(one), len(wanted)) > 2 and (one.startswith(wanted) or wanted.startswith(one))
    ]
    found = [wanted] if wanted in plain else begin or difflib.get_close_matches(wanted, plain, n=most, cutoff=0.7)
    return [choice for one in found for choice in plain[one]][:most]


def meant(text: str, choices: Collection[str], otherwise: str = "") -> str:
    """The advice where a text is none of the choices: "did you mean three?", or where none is near, `otherwise` or all."""
    found = near(text, choices)
    return f"did you mean {' or '.join(found)}?" if found else otherwise or f"it must be one of {', '.join(choices)}"


def _plain(text: str) -> str:
    return "".join(filter(str.isalnum, text.casefold()))


def counted(count: int, noun: str) -> str:
    """ "1 band", "5 bands" """
    return f"{count} {noun}{'' if count == 1 else 's'}"


def all_of(words: Sequence[str]) -> str:
    """ "a", "a and b", "a, b and c"; "" for none"""
    return " and ".join(filter(None, (", ".join(words[:-1]), *words[-1:])))


def theta_phi_degrees(direction: Iterable[float]) -> tuple[float, float]:
    """theta, the angle to +z, and phi, the azimuth from +x towards +y, of a direction (x, y, z); never a negative zero."""
    x, y, z = map(float, direction)
    return math.degrees(math.atan2(math.hypot(x, y), z)), math.degrees(math.atan2(y, x)) + 0.0


def brief_percent(share: float) -> str:
    """A share of 1 in two digits: "104 %", "1.4 %", "0.0001 %", and never a power of ten."""
    text = f"{100 * share:.2g}" if share < 0.1 else f"{100 * share:.0f}"
    return f"{float(text):.10f}".rstrip("0").rstrip(".") + " %"


def shortened(name: str, length: int) -> str:
    """At most `length` letters, with dots in the middle."""
    return name if len(name) <= length else f"{name[: length // 2 - 1]}...{name[len(name) - length // 2 + 2 :]}"


def percent(share: float, digits: int = 3, floor: float = 0.0) -> str:
    """A share of 1 in percent; one below the floor of its method, or too small for the digits, only says so."""
    value = 100 * share
    if not math.isfinite(value):
        return "infinite"
    if share < floor:
        return f"< {100 * floor:.5f}".rstrip("0") + " %"
    if value == 0:
        return "0 %"
    if value < 1e-4:
        return "< 0.0001 %"
    decimals = min(max(0, digits - 1 - math.floor(math.log10(value) + 1e-9)), 4)
    while value < 100 and decimals < 4 and f"{value:.{decimals}f}".startswith("100"):
        decimals += 1
    return f"{value:.{decimals}f} %"


def radiance(value: float, peak: float, digits: int = 3) -> str:
    """A radiance in three digits, with a power of ten where that is shorter; "0" below a millionth of the light's peak.

    digits: fewer, where there is no room for three.
    """
    if abs(value) <= 1e-6 * peak:
        return "0"
    value = float(f"{value:.{digits - 1}e}") if abs(value) < 10 ** (digits - 1) else value  # 0.9999 is 1.00
    if 1e-3 <= abs(value) < (1e5 if digits == 3 else 1e4):
        return f"{value:.{max(0, digits - 1 - math.floor(math.log10(abs(value))))}f}"
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
    return f"{mantissa}e{int(exponent)}"


def grouped(count: int) -> str:
    """A count in groups of three digits: 1000000 as "1 000 000"."""
    return f"{count:,}".replace(",", " ")


def grouped_number(value: float) -> str:
    """A number with two decimals below 10, and above in groups of three digits with none."""
    return f"{value:.2f}" if value < 10 else grouped(round(value))


def short_count(count: int) -> str:
    """A count in few letters: "625", "2.5k", "160k", "1M"."""
    for size, letter in ((1_000_000, "M"), (1000, "k")):
        if count >= size:
            return f"{count / size:.3g}{letter}"
    return str(count)


def round_percent(share: float) -> str:
    """A round share of 1, as it stands beside an axis: 150 %, 0.002 %, 1e-7 %."""
    if share < 0.99e-7:
        mantissa, exponent = f"{100 * share:.1e}".split("e")
        return f"{mantissa.removesuffix('.0')}e{int(exponent)} %"
    return f"{100 * share:.10f}".rstrip("0").rstrip(".") + " %"
