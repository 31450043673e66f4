"""What is remembered of a light, and that a light is forgotten as a whole."""

from __future__ import annotations

import gc
import os
import sys
import weakref
from dataclasses import replace
from pathlib import Path

import numpy as np
import OpenEXR
import pytest
from lights.images.hdr_files import hdr_file, random_texels

from shviewer.analysis import figures as analysis
from shviewer.analysis import projections
from shviewer.analysis.cache import MEMORY, MOST_LIGHTS, Memory, Remembered, array_bytes, remember
from shviewer.analysis.recipe import Recipe
from shviewer.analysis.reconstruction import reconstruction_of
from shviewer.analysis.subjects import keep_light, load_light, read_again, version_read
from shviewer.errors import LightError
from shviewer.lights.environment import EnvironmentLight
from shviewer.lights.find import built_in_lights, file_version, find_light
from shviewer.lights.light import Light
from shviewer.lights.reading import Reading

pytestmark = pytest.mark.usefixtures("fresh_memory")


@pytest.fixture
def image(tmp_path: Path) -> Path:
    path = tmp_path / "image.hdr"
    path.write_bytes(hdr_file(random_texels(8, 16)))
    return path


def recipe_of(path: Path | str, **changes: object) -> Recipe:
    return Recipe(str(path), **changes)


class Counting:
    """A remembered function that counts its calls."""

    def __init__(self, most: int = 2) -> None:
        self.calls: list[object] = []
        self.function: Remembered[..., object] = remember(most)(self._compute)

    def _compute(self, light: Light, *arguments: object) -> object:
        self.calls.append(arguments)
        return object()


# --- results


def test_a_result_is_computed_once_for_a_light_and_its_arguments() -> None:
    counting, green, studio = Counting(), find_light("green"), find_light("studio")
    first = counting.function(green, 1)
    assert counting.function(green, 1) is first
    assert counting.function(studio, 1) is not first
    assert counting.function(green, 2) is not first
    assert counting.function(green.irradiance(), 1) is not first
    assert len(counting.calls) == 4


def test_the_result_used_longest_ago_gives_way_within_each_light() -> None:
    counting, green, studio = Counting(most=2), find_light("green"), find_light("studio")
    for light, argument in ((green, 1), (green, 2), (studio, 1), (studio, 2), (green, 1), (green, 3)):
        counting.function(light, argument)
    counting.calls.clear()
    for light, argument in ((green, 1), (green, 3), (studio, 1), (studio, 2)):
        counting.function(light, argument)
    assert counting.calls == []
    counting.function(green, 2)
    assert counting.calls == [(2,)]


def test_clearing_a_function_forgets_its_results_for_every_light() -> None:
    one, other = Counting(), Counting()
    for light in (find_light("green"), find_light("studio")):
        for counting in (one, other):
            counting.function(light)
            one.function.cache_clear()
            counting.function(light)
    assert (len(one.calls), len(other.calls)) == (4, 2)


# --- lights


def test_the_light_used_longest_ago_is_forgotten_with_its_name_and_all_its_results() -> None:
    memory, lights = Memory(most_lights=2), [find_light("green") for _ in range(3)]
    memory.name("first", lights[0])
    memory.name("second", lights[1])
    assert memory.named("first") is lights[0]  # used: now the second is the oldest
    memory.results(lights[1].irradiance(), "function")["key"] = "value"  # and now it is not
    memory.results(lights[2], "function")
    assert memory.named("first") is None
    assert [light in memory for light in lights] == [False, True, True]
    assert memory.results(lights[1], "function") == {"key": "value"}


def test_a_name_that_gets_another_light_forgets_the_one_before() -> None:
    memory, before, after = Memory(), find_light("green"), find_light("green")
    memory.name("green", before)
    memory.name("also", before)
    memory.name("green", after)
    assert before not in memory
    assert memory.named("also") is None
    assert memory.named("green") is after


def test_large_lights_are_forgotten_sooner_but_never_the_one_in_use() -> None:
    memory = Memory(most_lights=9, most_bytes=2500)
    lights = [find_light("green") for _ in range(5)]
    base = array_bytes(lights[0])
    assert base < 250
    for light in lights:
        memory.results(light, "function")["key"] = np.zeros(1000, np.uint8)
    assert [light in memory for light in lights] == [False, False, True, True, True]
    memory.results(lights[0], "function")["key"] = np.zeros(10_000, np.uint8)
    assert lights[0] in memory


def test_ten_large_lights_in_turn_stay_below_the_cap() -> None:
    """Whatever each of them has grown to before the next one comes; the one in use is beside the cap."""
    memory = Memory(most_lights=12, most_bytes=2500)
    lights = [find_light("green") for _ in range(10)]
    for number, light in enumerate(lights):
        memory.results(light, "image")["texels"] = np.zeros(900, np.uint8)
        others = [array_bytes(other, memory._known[other]) for other in memory._known if other is not light]
        assert sum(others) <= memory.most_bytes
        memory.results(light, "rest")["without suns"] = np.zeros(90 * number, np.uint8)
    assert lights[-1] in memory


def test_every_array_is_counted_once_wherever_it_is() -> None:
    array = np.zeros(100)
    light = replace(find_light("green"), name="other")
    assert array_bytes([array, array[:50], array[::2]], {"a": array}, (array, {1: array.reshape(10, 10)})) == 800
    assert array_bytes(light, array) - array_bytes(light) == 800
    assert array_bytes("text", 1.0, None, test_every_array_is_counted_once_wherever_it_is) == 0


def test_the_bytes_of_an_image_and_of_its_figures_are_found(image: Path) -> None:
    light = reconstruction_of(recipe_of(image)).subject.light
    assert isinstance(light, EnvironmentLight)
    grid = analysis.error_grid(light, 96)
    assert array_bytes(light) >= light.map.texels.nbytes
    assert array_bytes(grid, light) >= grid.original.nbytes + light.map.texels.nbytes


def test_all_built_in_lights_are_remembered_together() -> None:
    assert len(built_in_lights()) < MOST_LIGHTS


def test_of_sixty_images_the_oldest_are_gone_without_waiting_for_the_collector(tmp_path: Path) -> None:
    """Neither a result nor a cycle keeps an image: counting references is enough."""
    lights, texels = [], []
    gc.disable()
    try:
        for number in range(60):
            path = tmp_path / f"{number}.hdr"
            path.write_bytes(hdr_file(random_texels(4, 8, seed=number)))
            for quantity in ("radiance", "irradiance"):
                picture = reconstruction_of(recipe_of(path, quantity=quantity, n_bands=3))
            light = load_light(recipe_of(path))
            lights.append(weakref.ref(light))
            texels.append(weakref.ref(light.map))
            del picture, light
        for references in (lights, texels):
            alive = [number for number, reference in enumerate(references) if reference() is not None]
            assert alive == list(range(60 - MOST_LIGHTS, 60))
    finally:
        gc.enable()


# --- reading again


def test_a_file_is_read_once_until_it_is_asked_for_again(image: Path) -> None:
    recipe = recipe_of(image)
    first = load_light(recipe)
    image.write_bytes(hdr_file(random_texels(8, 16, seed=1)))
    assert load_light(recipe) is first
    second = read_again(recipe)
    assert second is not first
    assert load_light(recipe) is second
    assert not np.array_equal(first.coefficients(2), second.coefficients(2))


def test_reading_again_leaves_nothing_of_the_light_before(image: Path) -> None:
    recipe = recipe_of(image)
    for quantity in ("radiance", "irradiance"):
        reconstruction_of(
            replace(recipe, quantity=quantity, n_bands=33)
        )  # above 32 bands with a map of the reconstruction
    before = weakref.ref(load_light(recipe))
    read_again(recipe)
    assert before() is None


def test_a_functions_file_is_executed_again_at_the_same_size_within_the_same_second(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Python's own cache of compiled files would take the second for the first."""
    monkeypatch.setattr(sys, "dont_write_bytecode", False)
    path = tmp_path / "my.py"
    recipe = recipe_of(f"{path}:sky")
    for level in (1, 3):
        path.write_text(f"def sky(directions):\n    return {level} + 0 * directions\n")
        os.utime(path, (1_700_000_000, 1_700_000_000))
        assert read_again(recipe).radiance(np.eye(3))[0, 0] == level
    assert [file.name for file in tmp_path.iterdir()] == ["my.py"]


def test_a_file_that_has_become_unreadable_leaves_what_is_known(image: Path) -> None:
    recipe = recipe_of(image)
    light, read = load_light(recipe), version_read(recipe)
    results = projections.project(light, projections.BEST, 32)
    image.write_bytes(b"#?RADIANCE\n")
    with pytest.raises(LightError, match=r"image\.hdr"):
        read_again(recipe)
    assert load_light(recipe) is light
    assert projections.project(light, projections.BEST, 32) is results
    assert version_read(recipe) == read != file_version(str(image))


def test_a_light_can_be_kept_although_its_file_says_otherwise(image: Path) -> None:
    recipe = recipe_of(image)
    light = load_light(recipe)
    read_again(recipe)
    keep_light(recipe, load_light(Recipe(light, quantity="irradiance")))
    assert load_light(recipe) is light


def test_the_stamp_is_that_of_the_file_before_it_was_read(image: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    before = file_version(str(image))

    def find_and_change(text: str, reading: Reading) -> Light:
        light = find_light(text, reading)
        image.write_bytes(hdr_file(random_texels(8, 16)) + b"more")
        return light

    monkeypatch.setattr("shviewer.analysis.subjects.find_light", find_and_change)
    recipe = recipe_of(image)
    assert version_read(recipe) is None
    load_light(recipe)
    assert version_read(recipe) == before != file_version(str(image))


def test_a_light_without_a_file_is_what_it_is() -> None:
    light = find_light("green")
    recipe = Recipe(light)
    assert read_again(recipe) is light
    keep_light(recipe, light)
    assert version_read(recipe) is None


def test_only_files_of_ones_own_are_decoded_in_isolation(image: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[tuple[str, bool]] = []

    def find(text: str, reading: Reading) -> Light:
        asked.append((text, reading.isolated))
        return find_light("green")

    monkeypatch.setattr("shviewer.analysis.subjects.find_light", find)
    for text in ("film_studio", str(image)):
        load_light(recipe_of(text, reading=Reading(isolated=True)))
        load_light(recipe_of(text))  # isolation makes no other light of it
    assert asked == [("film_studio", False), (str(image), True)]


def test_what_is_left_without_suns_belongs_to_its_light(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(MEMORY, "most_bytes", 1)  # so that any second light would drive the first one out
    pixels = np.ones((64, 128, 3), np.float32)
    pixels[10, 20] = 1e5
    path = tmp_path / "sun.exr"
    OpenEXR.File({}, {"RGB": pixels}).write(str(path))
    recipe = recipe_of(path, split_sun=True)
    first = reconstruction_of(recipe)
    path.unlink()
    for n_bands in (6, 7):
        assert reconstruction_of(replace(recipe, n_bands=n_bands)).subject.light is first.subject.light
        assert (
            reconstruction_of(replace(recipe, n_bands=n_bands, quantity="irradiance")).subject.light.source
            is first.subject.light
        )
    rest = weakref.ref(first.subject.light)
    MEMORY.forget(first.subject.whole)
    del first
    gc.collect()
    assert rest() is None
