"""`shviewer --print-completion SHELL`: what a shell needs to complete modes, options, their words and built-in lights."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import NamedTuple

from shviewer.analysis.options import Choice, Quantity, WholeOr, options_of
from shviewer.analysis.recipe import Recipe
from shviewer.cli.options.modes import MODES, PARSERS
from shviewer.coefficients.programs import CONVENTIONS
from shviewer.coefficients.writing import FORMATS
from shviewer.harmonics.quantities.names import ENCODED_BANDS
from shviewer.lights.find import built_in_lights
from shviewer.lights.reading import LAYOUT_CHOICES
from shviewer.viewer.view import View

WORDS: dict[str | tuple[str, str], tuple[str, ...]] = {
    "convention": tuple(CONVENTIONS),
    "input_convention": tuple(CONVENTIONS),
    "format": FORMATS,
    "layout": LAYOUT_CHOICES,
    ("project", "encode"): tuple(ENCODED_BANDS),
    "list_factors": Quantity.words[1:],
}
"""What may be given with options that no dataclass holds, by their places, or only in a mode."""


class _Flag(NamedTuple):
    """An option of a mode: its names, whether a value follows, the words that this may be, and a line of help."""

    names: tuple[str, ...]
    takes_value: bool
    words: tuple[str, ...]
    help: str


def completion(shell: str) -> str:
    """The script of a shell: "bash", "zsh" or "fish"."""
    return {"bash": _bash, "zsh": _zsh, "fish": _fish}[shell]()


def _flags(mode: str) -> list[_Flag]:
    kinds = {name: row.kind for name, row in options_of(Recipe, View).items()}
    found = []
    for action in PARSERS[mode]()._actions:
        kind = kinds.get(action.dest)
        words: Iterable[str] = action.choices or WORDS.get((mode, action.dest), WORDS.get(action.dest, ()))
        if (mode, action.dest) not in WORDS and isinstance(kind, Choice | WholeOr | Quantity):
            words = kind.choices if isinstance(kind, Choice) else kind.words
        help_line = re.sub(r"\s+", " ", (action.help or "").replace("%%", "%"))
        if action.option_strings:
            found.append(
                _Flag(tuple(action.option_strings), action.nargs != 0, tuple(filter(None, map(str, words))), help_line)
            )
    return found


def _bash() -> str:
    cases, names = dict[str, dict[str, None]](), []
    for mode in PARSERS:
        flags = _flags(mode)
        names.append(f"    {mode}) options='{' '.join(name for flag in flags for name in flag.names)}' ;;")
        for flag in flags:
            if flag.words:  # those of all modes
                cases.setdefault("|".join(flag.names), {}).update(dict.fromkeys(flag.words))
    words = "\n".join(
        f"    {option}) COMPREPLY=($(compgen -W '{' '.join(each)}' -- \"$current\")); return ;;"
        for option, each in cases.items()
    )
    return f"""# bash completion of shviewer: shviewer --print-completion bash
_shviewer() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} mode=view options
  case ${{COMP_WORDS[1]}} in {"|".join(MODES)}) mode=${{COMP_WORDS[1]}} ;; esac
  case $before in
{words}
  esac
  case $mode in
{chr(10).join(names)}
  esac
  if [[ $current == -* ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$current"))
  else
    local lights='{" ".join(built_in_lights())}'
    ((COMP_CWORD > 1)) || lights+=' {" ".join((*MODES, "help"))}'
    COMPREPLY=($(compgen -W "$lights" -- "$current") $(compgen -f -- "$current"))
  fi
}}
complete -o filenames -F _shviewer shviewer
"""


def _zsh() -> str:
    def spec(flag: _Flag) -> str:
        says = re.sub(r"([\[\]:'])", lambda found: "'\\''" if found[1] == "'" else "\\" + found[1], flag.help)
        names = flag.names[0] if len(flag.names) == 1 else "{" + ",".join(flag.names) + "}"
        value = f":value:({' '.join(flag.words)})" if flag.words else ":value:_files" if flag.takes_value else ""
        return f"{names}'[{says}]{value}'" if len(flag.names) > 1 else f"'{names}[{says}]{value}'"

    modes = "\n".join(
        f"    {mode}) options=(\n      {(chr(10) + '      ').join(map(spec, _flags(mode)))}\n    ) ;;"
        for mode in PARSERS
    )
    return f"""#compdef shviewer
# zsh completion of shviewer: shviewer --print-completion zsh
_shviewer_files() {{
  local -a lights=({" ".join(built_in_lights())})
  (( CURRENT > 2 )) || lights+=({" ".join((*MODES, "help"))})
  compadd -- $lights
  _files
}}
_shviewer() {{
  local mode=view
  local -a options
  case $words[2] in {"|".join(MODES)}) mode=$words[2] ;; esac
  case $mode in
{modes}
  esac
  _arguments -s $options '*:light:_shviewer_files'
}}
_shviewer "$@"
"""


def _fish() -> str:
    modes = " ".join(MODES)
    lines = [
        "# fish completion of shviewer: shviewer --print-completion fish",
        f"complete -c shviewer -n 'not __fish_seen_subcommand_from {modes}' -a '{modes} help'",
        f"complete -c shviewer -a '{' '.join(built_in_lights())}'",
    ]
    shared: dict[_Flag, list[str]] = {}
    for mode in PARSERS:
        for flag in _flags(mode):
            shared.setdefault(flag, []).append(mode)
    for flag, having in shared.items():
        others = " ".join(mode for mode in MODES if mode not in having)
        seen = (
            f"not __fish_seen_subcommand_from {others}"
            if "view" in having
            else f"__fish_seen_subcommand_from {' '.join(having)}"
        )
        names = " ".join(f"-l {name[2:]}" if name.startswith("--") else f"-s {name[1:]}" for name in flag.names)
        value = f" -x -a '{' '.join(flag.words)}'" if flag.words else " -r" if flag.takes_value else ""
        says = flag.help.replace("\\", "\\\\").replace("'", "\\'")
        condition = f" -n '{seen}'" if others else ""
        lines.append(f"complete -c shviewer{condition} {names}{value} -d '{says}'")
    return "\n".join(lines) + "\n"
