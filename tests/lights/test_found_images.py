"""The table "which program writes what" of the guide, row by row."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from lights.found_images import Found, found_images

from shviewer.errors import LightError
from shviewer.lights.find import find_light


@pytest.mark.parametrize("found", found_images(), ids=lambda found: f"{found.program}, {found.writes}")
def test_a_file_as_a_program_writes_it_is_the_light_that_the_guide_says_or_refused_in_words(
    found: Found, tmp_path: Path
) -> None:
    path = tmp_path / found.name
    if path.suffix in (".tif", ".psd"):
        pytest.importorskip("OpenImageIO", reason='OpenImageIO is missing: pip install "shviewer[formats]"')
    path.write_bytes(found.data())
    if found.mean is None:
        with pytest.raises(LightError, match=found.said) as caught:
            find_light(str(path))
        assert "\n" not in str(caught.value)
        return
    light = find_light(str(path))
    mean = light.coefficients(1)[0] / np.sqrt(4 * np.pi)
    assert mean == pytest.approx(found.mean, rel=0.02 if path.suffix == ".jpg" else 1e-3, abs=1e-4)  # JPEG: two codes
    assert found.said in "; ".join(light.notes)
