"""Ways to spoil the words, numbers and lines of a text, and its encoding."""

# ruff: noqa: SIM905 (a list of spellings is read more easily in one text)

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache
from random import Random

MOST_BYTES = 2**20
"""The longest input but for a few: the limit of a coefficient file is eight times as much."""

NUMBERS = (
    *(
        "0 | -0 | -0.0 | 1 | -1 | 2 | 9 | 127 | 128 | 129 | 16384 | 2147483648 | 1e30 | 1e31 | 1e38 | 1e39 | 1e100 | "
        "1e101 | 1e155 | 1e308 | 1e309 | -1e400 | 1e-30 | 1e-31 | 1e-46 | 1e-320 | 1e-400 | 1e999999999 | nan | "
        "NaN | -nan | inf | -Infinity | Infinity | 1_0 | 1_000.0 | _1 | 1__0 | 0x10 | 0b1 | 0o7 | 01 | +1 | 1. | "
        ".5 | 1.5f | 1.5F | 1e | 1e+ | --1 | - 1 | 1,5 | 1,234 | 1.234,5 | 1 234 | 1'234 | 1j | 1+2j | (1,2) | 1d3 | "
        "1D0 | 1e3e3 | 99999999999999999999 | true | false | null | None | '' | 1979-05-27 | 07:32:00 | [1] | {} | "
        "[] | 5% | 150% | % | 1e5%"
    ).split(" | "),
    *("\u22121", "\u0661\u0662", "\uff11", "\u00b2", "9" * 400, "1" * 4301, "0." + "3" * 5000, '"1"'),
)
_WORDS = (
    *(
        "# | // | /* | */ | /* */ | ' | ''' | , | ; | : | . | - | + | = | ` | $(id) | %n | [ | ] | [[ | ]] | { | } | "
        "( | ) | () | < | vec3 | dvec3 | vec3[9] | float3 | coefficients | [lobe] | [[lobe.x]] | lobe.axis = 1 | l | "
        "m | red | blue-imaginary | shviewer-coefficients | convention | bands | a.b.c | coefficients begin | "
        "coefficients end | shviewer-coefficients: 1 | columns: red | suns | sun-1-direction"
    ).split(" | "),
    *("", " ", "\t", "\n", "\r", "\r\n", "\x0b", "\x0c", "\x1c", "\x85", "\u2028", "\u00a0", "\ufeff", "\0"),
    *("\x1b[31m", "\u202e", "\\", '"', '"""', "|", "columns: "),
    *("\ud800".encode("utf-8", "surrogatepass").decode("latin-1"), "\U0001f600", "e\u0301", "x" * 300),
    *("\\u0000", "\\ud800", "\\x"),
)
_ARGUMENTS = (
    *(
        "- | -- | -o | --help | --version | --bands | --for | --list-lights | --no-such | --bands=3 | --max-side=0 | "
        "help | screenshot | screnshot | info | project | green | gren | studio | nine.json | bare.txt | o.png | . | "
        "/ | ~ | .. | x.exr: | x.exr:a | x.py:f | x.py: | : | file:///x.py:f | x.toml:1 | hann | gauss | gauss: | "
        "gauss:0 | hann:nan | dering | none:1 | lat-long | cube | best | gauss-legendre | three | unity,4pi | "
        "scipy | x,y | shviewer, | , | +x+y | +x+y+z | -z-y-x | +x+x+x | y-up,z-up | phase,no-phase | irradiance | "
        "0,1,2 | 1,,2 | 1-3 | -1 | 1;2 | @x | *"
    ).split(" | "),
    *("",),
)
DEPTHS = (2, 10, 100, 500, 1000, 3000, 20_000, 100_000)
_TOKEN = re.compile(r'"(?:[^"\\\n]|\\.)*"|[+-]?\.?\d[\w.]*(?:[eE][+-]\d+)?|[^\W\d][\w-]*|\s+|.', re.DOTALL)
_NUMERIC = re.compile(r"[+-]?\.?\d")

Tokens = list[str]
Way = Callable[[Tokens, Random, Tokens], None]
"""Changes the words of a text in place; the last argument is another seed's."""


def spoilt_text(data: bytes, other: bytes, random: Random, suffix: str) -> bytes:
    tokens = list(_tokens(data))
    ways = _WAYS + ((_argument,) * 8 if suffix == ".argv" else ())
    for _ in range(random.choice((1, 1, 1, 2, 3, 6))):
        if tokens:
            random.choice(ways)(tokens, random, list(_tokens(other)))
    return encoded("".join(tokens), random)


@cache
def _tokens(data: bytes) -> tuple[str, ...]:
    return tuple(_TOKEN.findall(data.decode("utf-8", "replace")[:20_000]))


def encoded(text: str, random: Random) -> bytes:
    """Mostly UTF-8; else another encoding, a mark in front of it, or bytes that are no text."""
    plain = text.encode("utf-8", "surrogatepass")
    match random.randrange(40):
        case 0:
            return b"\xef\xbb\xbf" * random.choice((1, 1, 2)) + plain
        case 1:
            return text.encode(random.choice(("utf-16", "utf-16-be", "utf-32", "utf-7")), "replace")
        case 2:
            return text.encode(random.choice(("latin-1", "cp1252", "cp037")), "replace")
        case 3:
            place = random.randrange(len(plain) + 1)
            return (
                plain[:place] + random.choice((b"\xff", b"\xc0\x80", b"\xed\xa0\x80", b"\0", b"\xf5")) + plain[place:]
            )
        case 4:
            return plain.replace(b"\n", random.choice((b"\r", b"\r\n", b"\n\n", b"", b" ", b"\x0c")))
    return plain


def _number(tokens: Tokens, random: Random, other: Tokens) -> None:
    places = [place for place, token in enumerate(tokens) if _NUMERIC.match(token)]
    if places:
        tokens[random.choice(places)] = random.choice(NUMBERS)


def _every_number(tokens: Tokens, random: Random, other: Tokens) -> None:
    spelling = random.choice(NUMBERS)
    change: Callable[[str], str] = random.choice(
        (
            lambda token: spelling,
            lambda token: token.replace(".", ","),
            lambda token: token.replace("-", "\u2212"),
            lambda token: token + random.choice("fFdhL"),
            lambda token: f"{token}e{random.choice((-400, -40, 29, 31, 99, 150, 300))}",
        )
    )
    tokens[:] = [change(token) if _NUMERIC.match(token) else token for token in tokens]


def _word(tokens: Tokens, random: Random, other: Tokens) -> None:
    tokens[random.randrange(len(tokens))] = random.choice((*_WORDS, random.choice(other or [""])))


def _insert(tokens: Tokens, random: Random, other: Tokens) -> None:
    place = random.randrange(len(tokens) + 1)
    begin = random.randrange(len(other) or 1)
    part = other[begin : begin + random.choice((1, 3, 10))]
    tokens[place:place] = random.choice((part, [random.choice(_WORDS)], [random.choice(NUMBERS)]))


def _delete(tokens: Tokens, random: Random, other: Tokens) -> None:
    begin = random.randrange(len(tokens))
    del tokens[begin : begin + random.choice((1, 1, 2, 5, 30))]


def _duplicate(tokens: Tokens, random: Random, other: Tokens) -> None:
    begin = random.randrange(len(tokens))
    part = tokens[begin : begin + random.choice((1, 2, 8, 40))]
    times = random.choice((1, 1, 2, 5, 40) if random.random() < 0.95 else (1000, 100_000))
    tokens[begin:begin] = part * min(times, 1 + 2 * MOST_BYTES // (sum(map(len, part)) or 1))


def _swap(tokens: Tokens, random: Random, other: Tokens) -> None:
    one, two = random.randrange(len(tokens)), random.randrange(len(tokens))
    tokens[one], tokens[two] = tokens[two], tokens[one]


def _lines(tokens: Tokens, random: Random, other: Tokens) -> None:
    """Lines doubled, left out, moved, joined, indented or made comments."""
    lines = "".join(tokens).split("\n")
    place = random.randrange(len(lines))
    match random.randrange(6):
        case 0:
            lines.insert(random.randrange(len(lines)), lines[place])
        case 1:
            del lines[place]
        case 2:
            random.shuffle(lines)
        case 3 if place:
            lines[place - 1 : place + 1] = [lines[place - 1] + lines[place]]
        case 4:
            lines[place] = random.choice(("  ", "#", "//", "/*", "*", "\t", "> ")) + lines[place]
        case 5:
            lines[place] += random.choice((" ", "\\", "#", "*/", ",", ";", ", 1", " 1 2"))
    tokens[:] = _TOKEN.findall("\n".join(lines))


def _separators(tokens: Tokens, random: Random, other: Tokens) -> None:
    old = random.choice((",", " ", "\n", ";", "\t", "[", "(", "{", '"'))
    new = random.choice((",", " ", "\n", ";", "\t", "", ",,", ", ", " ,", "|", "[", "(", "{", "'"))
    tokens[:] = [token.replace(old, new) for token in tokens]


def _nest(tokens: Tokens, random: Random, other: Tokens) -> None:
    opens = random.choice(
        ("[", "{", "(", '{"a":', "[[", "/*", "//", '"', "'''", "a.", "[{a=", "/*\n", "# \n", "\\", "-", "x=[", "1,")
    )
    depth = random.choice(DEPTHS[:4] if random.random() < 0.8 else DEPTHS)
    closes = {"[": "]", "{": "}", "(": ")", '{"a":': "}", "/*": "*/", "[{a=": "}]"}.get(opens, "")
    if random.random() < 0.5:
        closes = ""
    place = random.randrange(len(tokens))
    tokens[place] = opens * depth + tokens[place] + closes * depth


def _argument(tokens: Tokens, random: Random, other: Tokens) -> None:
    lines = "".join(tokens).split("\n")
    place = random.randrange(len(lines))
    value = random.choice((*_ARGUMENTS, random.choice("".join(other).split("\n")), random.choice(NUMBERS)))
    match random.randrange(5):
        case 0 | 1 | 2:
            lines[place] = value
        case 3:
            lines.insert(place, value)
        case 4:
            lines[place] += value
    tokens[:] = _TOKEN.findall("\n".join(lines))


_WAYS: tuple[Way, ...] = (
    *(_number, _number, _number, _every_number, _word, _insert, _delete, _duplicate, _swap, _lines, _separators, _nest),
)


def laid_out(random: Random) -> str:
    """A table of numbers in some layout, rows of one length or not, in some brackets."""
    n, width = random.choice((1, 2, 3, 4, 6, 9, 16, 25, 27, 36, 48)), random.choice((1, 2, 3, 3, 3, 4, 5, 6, 9, 16))
    between = random.choice((" ", ", ", ",", "\t", "; ", "  ", " , "))
    opens, closes = random.choice(
        (("", ""), ("", ""), ("[", "]"), ("(", "),"), ("{", "},"), ("vec3(", "),"), ("", ","))
    )
    rows = []
    for row in range(n):
        count = width + (random.choice((-1, 0, 1)) if random.random() < 0.02 else 0)
        numbers = [random.choice(("%.3f", "%g", "%.2e", "%df", "%d")) % random.uniform(-9, 9) for _ in range(count)]
        index = [str(row)] if random.random() < 0.02 else []
        rows.append(opens + between.join(index + numbers) + closes)
    head = random.choice(("", "", "", f"{n}\n", "# coefficients\n", "red,green,blue\n", "l m value\n", f"vec3[{n}](\n"))
    return head + random.choice(("\n", "\n", "\r\n", " ", "\n\n")).join(rows) + random.choice(("", "\n", ")\n"))
