"""The mutation check itself stays alive; running it is a command, tests/mutants.py."""

from __future__ import annotations

import pytest
from mutants import MUTANTS, ROOT, Mutant, texts


@pytest.mark.parametrize("mutant", MUTANTS, ids=lambda mutant: mutant.name)
def test_a_mutant_still_finds_the_one_line_it_breaks(mutant: Mutant) -> None:
    assert sum(text.count(mutant.right) for text in texts(mutant, ROOT).values()) == 1
