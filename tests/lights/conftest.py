"""Reading bytes as if they were a file, for the tests of the readers."""

import pytest
from lights.images.hdr_files import checked_message

from shviewer.errors import LightError
from shviewer.lights.images.radiance_files import read_radiance_image
from shviewer.lights.reading import Reading


@pytest.fixture
def read(tmp_path):
    """Reads bytes as if they were a file of that name."""

    def read_bytes(data, name="light.hdr", layer="", **options):
        path = tmp_path / name
        path.write_bytes(data)
        return read_radiance_image(path, Reading(**options), layer)

    return read_bytes


@pytest.fixture
def refusal(read):
    """The message with which bytes are refused: one line that begins with the file."""

    def refuse(data, name="light.hdr", **options):
        with pytest.raises(LightError) as caught:
            read(data, name, **options)
        return checked_message(caught.value, name)

    return refuse
