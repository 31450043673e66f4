"""Where shaders and assets are."""

from __future__ import annotations

import pytest

from shviewer.errors import ShviewerError
from shviewer.resources import resource_folder


def test_the_folders_of_the_installation_are_found_and_a_missing_one_is_said() -> None:
    assert (resource_folder("shaders") / "sphere.frag").is_file()
    assert (resource_folder("assets") / "scenes" / "green.toml").is_file()
    with pytest.raises(ShviewerError, match="no folder nothing/"):
        resource_folder("nothing")
