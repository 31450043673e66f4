"""Write the manual page and the completions of shells that the wheel installs: python tests/shell_files.py"""

from __future__ import annotations

import argparse
import re
from pathlib import Path

from places import ASSETS

from shviewer.cli.options.completion import completion
from shviewer.cli.options.modes import EXIT_CODES, PARSERS

FOLDER = ASSETS / "shell"


def shell_files() -> dict[Path, str]:
    """The files of assets/shell/ and what they hold today."""
    return {
        FOLDER / "shviewer.1": manual_page(),
        FOLDER / "shviewer": completion("bash"),
        FOLDER / "_shviewer": completion("zsh"),
        FOLDER / "shviewer.fish": completion("fish"),
    }


def manual_page() -> str:
    """shviewer(1) in the macros of man(7)."""
    usage = re.sub("^ *(?=shviewer)", "", PARSERS["view"]().usage or "", flags=re.MULTILINE)
    lines = [
        ".TH SHVIEWER 1",
        ".SH NAME",
        "shviewer \\- see a light beside its spherical\\-harmonic reconstruction",
        ".SH SYNOPSIS",
        ".nf",
        _escaped(usage),
        ".fi",
    ]
    for mode, parser in PARSERS.items():
        made = parser()
        lines += [f".SH {'WINDOW' if mode == 'view' else mode.upper()}", _escaped(made.description or "")]
        for action in made._actions:
            lines += [".TP", f".B {_escaped(_called(action))}", _escaped((action.help or "").replace("%%", "%"))]
    codes = [re.split(" {2,}", line.strip(), maxsplit=1) for line in EXIT_CODES.splitlines()[1:]]
    lines += [".SH EXIT STATUS", *(part for code, says in codes for part in (".TP", f".B {code}", _escaped(says)))]
    return "\n".join([*lines, ".SH SEE ALSO", "shviewer help guide", ""])


def _called(action: argparse.Action) -> str:
    metavar = " ".join(action.metavar) if isinstance(action.metavar, tuple) else action.metavar or ""
    return f"{', '.join(action.option_strings)} {metavar}".strip()


def _escaped(text: str) -> str:
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return re.sub(r"^(?=[.'])", r"\\&", text, flags=re.MULTILINE)


def write_shell_files() -> None:
    FOLDER.mkdir(exist_ok=True)
    for path, text in shell_files().items():
        path.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    write_shell_files()
