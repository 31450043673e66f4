"""The screenshot mode: its files, its promises when something fails, and two golden pictures.

SHVIEWER_UPDATE_GOLDENS=1 python -m pytest tests/viewer/test_screenshot.py -k golden
writes the golden pictures in tests/data/ anew; look at them before keeping them.
"""

from __future__ import annotations

import json
import os
import re
import resource
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import OpenEXR
import pytest
from helpers import picture_of
from numpy.typing import NDArray
from PIL import Image
from places import DATA
from scipy.special import sph_harm_y
from viewer.gl.frames import square_frame

from shviewer import outputs, resources
from shviewer.errors import OutputError, ShaderError, UsageError
from shviewer.harmonics.basis import Array
from shviewer.lights.find import find_light
from shviewer.outputs import write_atomically
from shviewer.version import __version__
from shviewer.viewer import screenshot as screenshots
from shviewer.viewer.composing.composition import compose, frame_for
from shviewer.viewer.gl import renderer as renderers
from shviewer.viewer.gl import shader_source, surface_renderer
from shviewer.viewer.gl.renderer import Renderer
from shviewer.viewer.saving.picture_files import write_numbered, write_png
from shviewer.viewer.saving.reference import compare_with_reference
from shviewer.viewer.screenshot import render_in_parts, render_rgb

SHADERS = resources.resource_folder("shaders")

pytestmark = pytest.mark.usefixtures("session_renderer")  # skips, or fails on CI, where nothing can be drawn


def screenshot(*arguments: object, cwd: Path, **options: Any) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "shviewer", "screenshot", *map(str, arguments)]
    return subprocess.run(command, cwd=cwd, capture_output=True, text=True, check=False, **options)


def read_exr(path: Path) -> tuple[NDArray[np.float32], dict[str, Any]]:
    with OpenEXR.File(str(path)) as file:
        return np.array(file.channels()["RGB"].pixels), json.loads(file.header()["shviewer"])


@pytest.mark.parametrize("suffix", ["png", "exr"])
def test_the_same_arguments_give_the_same_bytes(tmp_path: Path, suffix: str) -> None:
    arguments = (
        "venice_sunset",
        "--bands",
        6,
        "--method",
        "jittered",
        "--samples",
        900,
        "--seed",
        3,
        "--size",
        320,
        160,
    )
    made = []
    for name in ("first", "second"):
        done = screenshot(f"{name}.{suffix}", *arguments, cwd=tmp_path)
        assert (done.returncode, done.stdout) == (0, ""), done.stderr
        made.append((tmp_path / f"{name}.{suffix}").read_bytes())
    assert made[0] == made[1]
    assert sorted(path.name for path in tmp_path.iterdir()) == [f"first.{suffix}", f"second.{suffix}"]


def test_a_png_tells_everything_that_made_it(tmp_path: Path) -> None:
    arguments = "studio --bands 6 --mute 1,3 --method jittered --samples 1000 --seed 7 --exposure -1.5 --size 400 300"
    view = "--camera 30 -20 --rotate-light 90 0 --zoom 1.25"
    assert screenshot("a.png", *arguments.split(), *view.split(), cwd=tmp_path).returncode == 0
    with Image.open(tmp_path / "a.png") as image:
        said = json.loads(image.info["shviewer"])
        assert image.size == (400, 300)
        assert image.mode == "RGB"
    plain = {
        "version": __version__,
        "light": "studio",
        "light_notes": [],
        "bands": 6,
        "muted": [1, 3],
        "method": "jittered",
        "samples": 961,  # 31 squared: the stratified samples are a square
        "seed": 7,
        "sanitize": False,
        "exposure_stops": -1.5,
        "size": [400, 300],
        "camera_degrees": [30.0, -20.0],
        "zoom": 1.25,
    }
    assert {key: said[key] for key in plain} == plain
    assert re.match(r"OpenGL \d\.\d, .+", said["opengl"])
    a, e = np.radians([30.0, -20.0])
    right, towards = [-np.sin(a), np.cos(a), 0], [np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)]
    columns = np.stack([right, np.cross(towards, right), towards], axis=1)
    np.testing.assert_allclose(said["world_from_view"], columns, rtol=0, atol=1e-14)
    np.testing.assert_allclose(said["light_from_world"], [[0, 1, 0], [-1, 0, 0], [0, 0, 1]], rtol=0, atol=1e-14)
    frame = compose(400, 300, 1.25)
    for name, sphere in zip(("original", "reconstruction"), frame.spheres, strict=True):
        assert said["spheres"][name]["centre"] == [sphere.x, sphere.y]
        assert said["spheres"][name]["radius"] == sphere.radius
    figures = said["figures"]
    assert set(figures) >= {"relative_l2", "max_error", "minimum", "negative_area", "peak", "energy_share"}
    squares = figures["all"]["left_out"] ** 2 + figures["all"]["added"] ** 2
    assert figures["relative_l2"] ** 2 == pytest.approx(squares, rel=1e-12)


def harmonics_of(directions: Array, n_bands: int) -> Array:
    """Y(l, m), (k, n**2), from SciPy's complex ones: sqrt(2) Re for m > 0, sqrt(2) Im of |m| for m < 0."""
    x, y, z = directions.T
    theta, phi = np.arctan2(np.hypot(x, y), z), np.arctan2(y, x)
    columns = []
    for l in range(n_bands):
        for m in range(-l, l + 1):
            value = sph_harm_y(l, abs(m), theta, phi)
            columns.append(value.real if m == 0 else np.sqrt(2) * (value.real if m > 0 else value.imag))
    return np.stack(columns, axis=1)


@pytest.mark.parametrize("name", ["studio", "venice_sunset"])
def test_an_exr_can_be_recomputed_from_its_own_metadata(tmp_path: Path, name: str) -> None:
    view = ["--camera", "150", "35", "--rotate-light", "-40", "25", "--exposure", "2", "--bands", "7", "--mute", "2"]
    assert screenshot("a.exr", name, *view, "--size", 320, 200, cwd=tmp_path).returncode == 0
    pixels, said = read_exr(tmp_path / "a.exr")
    assert pixels.dtype == np.float32
    assert pixels.shape == (200, 320, 3)
    light = find_light(said["light"])
    muted = np.repeat([l in said["muted"] for l in range(said["bands"])], [2 * l + 1 for l in range(said["bands"])])
    assert muted.sum() == 5
    coefficients = np.where(muted[:, None], 0, light.coefficients(said["bands"]))
    light_from_view = np.array(said["light_from_world"]) @ np.array(said["world_from_view"])
    y, x = np.indices(pixels.shape[:2]) + 0.5
    covered = np.zeros(pixels.shape[:2], dtype=bool)
    for side, sphere in said["spheres"].items():
        p = np.stack([x - sphere["centre"][0], sphere["centre"][1] - y], axis=-1) / sphere["radius"]
        squared = (p**2).sum(axis=-1)
        covered |= squared < 1.0001
        mask = squared < 0.96  # near the rim float32 turns the normal; test_parity.py bounds that
        directions = np.column_stack([p[mask], np.sqrt(1 - squared[mask])]) @ light_from_view.T
        if side == "original":
            wanted = light.radiance(directions)
            tolerance = 2e-6 if name == "studio" else 1e-4  # a map: 1e-4 of a texel
        else:
            wanted = harmonics_of(directions, said["bands"]) @ coefficients
            tolerance = 1e-6 * said["bands"]
            assert (wanted < 0).any()
        np.testing.assert_allclose(pixels[mask], wanted, rtol=0, atol=tolerance * np.abs(wanted).max(), err_msg=side)
    assert not pixels[~covered].any()


def test_the_screenshot_mode_needs_no_glfw(tmp_path: Path) -> None:
    code = (
        "import sys; from shviewer.cli.main import main; code = main(sys.argv[1:]); print('glfw' in sys.modules, code)"
    )
    command = [sys.executable, "-c", code, "screenshot", "a.png", "--size", "64", "64", "--no-overlay"]
    environment = {key: value for key, value in os.environ.items() if key not in ("DISPLAY", "WAYLAND_DISPLAY")}
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    assert done.stdout.split() == ["False", "0"], done.stderr


def test_no_overlay_leaves_the_spheres_alone(tmp_path: Path, renderer: Renderer) -> None:
    picture, frame = picture_of("green"), compose(640, 320)
    plain = render_rgb(renderer, picture, frame, overlay=False)
    full = render_rgb(renderer, picture_of("green", marks=False), frame)
    assert screenshot("a.png", "--no-overlay", "--size", 640, 320, cwd=tmp_path).returncode == 0
    with Image.open(tmp_path / "a.png") as image:
        np.testing.assert_array_equal(np.asarray(image), plain)
    bare = render_rgb(renderer, picture_of("green", marks=False), frame, overlay=False)
    changed = (bare != full).any(axis=2)
    assert changed.any()
    top, bottom = frame.spheres[0].y - frame.spheres[0].radius, frame.spheres[0].y + frame.spheres[0].radius
    inside = changed[int(top) + 25 : int(bottom) - 25]
    assert not inside.any()  # what is written stands above and below, but for marks


# --- comparing with a reference


@pytest.fixture(scope="module")
def reference(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("reference")
    assert screenshot("reference.png", "--size", 320, 160, cwd=folder).returncode == 0
    return folder / "reference.png"


def test_a_picture_equal_to_its_reference_passes(tmp_path: Path, reference: Path) -> None:
    done = screenshot("a.png", "--size", 320, 160, "--reference", reference, "--threshold", 0, cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert [path.name for path in tmp_path.iterdir()] == ["a.png"]


def test_a_different_picture_exits_1_and_shows_the_difference(tmp_path: Path, reference: Path) -> None:
    done = screenshot("a.png", "--bands", 4, "--size", 320, 160, "--reference", reference, cwd=tmp_path)
    assert done.returncode == 1
    assert len(done.stderr.splitlines()) == 1
    assert "a-difference.png" in done.stderr
    pictures = [np.asarray(Image.open(path).convert("RGB")).astype(int) for path in (tmp_path / "a.png", reference)]
    with Image.open(tmp_path / "a-difference.png") as image:
        difference = np.minimum(16 * np.abs(pictures[0] - pictures[1]), 255)
        np.testing.assert_array_equal(np.asarray(image), difference)
        assert difference.any()


def test_a_reference_of_another_size_exits_1_and_an_unreadable_one_2(tmp_path: Path, reference: Path) -> None:
    done = screenshot("a.png", "--size", 322, 160, "--reference", reference, cwd=tmp_path)
    assert done.returncode == 1
    assert "320 x 160" in done.stderr
    assert "322 x 160" in done.stderr
    (tmp_path / "bad.png").write_bytes(b"not a picture")
    for name in ("bad.png", "missing.png"):
        done = screenshot("a.png", "--size", 320, 160, "--reference", name, cwd=tmp_path)
        assert done.returncode == 2
        assert len(done.stderr.splitlines()) == 1
        assert name in done.stderr


def test_the_threshold_is_a_share_of_pixels_and_two_levels_are_no_difference(tmp_path: Path) -> None:
    base = np.full((10, 10, 3), 100, dtype=np.uint8)
    path, out = tmp_path / "reference.png", tmp_path / "difference.png"
    write_png(path, base, "{}")
    off_by_2, off_by_3 = base + np.uint8(2), base.copy()
    off_by_3[3, 4:7, 1] -= np.uint8(3)
    assert compare_with_reference(off_by_2, path, out, 0.0) == ""
    assert compare_with_reference(off_by_3, path, out, 0.03) == ""
    assert not out.exists()
    verdict = compare_with_reference(off_by_3, path, out, 0.029)
    assert verdict.startswith("3.0000% of the pixels differ")
    assert "largest 3/255" in verdict
    assert np.asarray(Image.open(out)).max() == 48
    with pytest.raises(UsageError, match=r"missing\.png"):
        compare_with_reference(base, tmp_path / "missing.png", out, 0.0)


# --- writing


def test_a_failing_move_leaves_the_old_file_and_nothing_else(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "a.png"
    path.write_bytes(b"old")

    def fail(source: str, target: Path) -> None:
        raise OSError(5, "Input/output error")

    monkeypatch.setattr(outputs.os, "replace", fail)
    with pytest.raises(OutputError, match=r"a\.png: cannot be written: Input/output error"):
        write_atomically(path, b"new")
    assert path.read_bytes() == b"old"
    assert [entry.name for entry in tmp_path.iterdir()] == ["a.png"]


def test_a_full_disk_leaves_the_old_file_and_nothing_else(tmp_path: Path) -> None:
    (tmp_path / "a.png").write_bytes(b"old")

    def small_files() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000))

    environment = {**os.environ, "MESA_SHADER_CACHE_DISABLE": "true", "PYTHONDONTWRITEBYTECODE": "1"}
    done = screenshot("a.png", "--size", 320, 160, cwd=tmp_path, preexec_fn=small_files, env=environment)
    assert done.returncode == 4
    assert len(done.stderr.splitlines()) == 1
    assert (tmp_path / "a.png").read_bytes() == b"old"
    assert [entry.name for entry in tmp_path.iterdir()] == ["a.png"]


def test_a_place_that_cannot_be_written_exits_4_with_one_line(tmp_path: Path) -> None:
    (tmp_path / "folder.png").mkdir()
    for out in ("missing/a.png", "folder.png", "missing/a.exr"):
        done = screenshot(out, "--size", 64, 64, "--no-overlay", cwd=tmp_path)
        assert done.returncode == 4, done.stderr
        assert len(done.stderr.splitlines()) == 1
        assert out in done.stderr
    assert [entry.name for entry in tmp_path.iterdir()] == ["folder.png"]


@pytest.mark.skipif(os.geteuid() == 0, reason="the superuser may write anywhere")
def test_a_read_only_folder_is_refused(tmp_path: Path) -> None:
    tmp_path.chmod(0o500)
    with pytest.raises(OutputError, match="Permission denied"):
        write_atomically(tmp_path / "a.png", b"new")


def test_a_file_gets_the_permissions_of_any_new_file(tmp_path: Path) -> None:
    (tmp_path / "plain").write_bytes(b"")
    write_atomically(tmp_path / "a.png", b"new")
    assert (tmp_path / "a.png").stat().st_mode == (tmp_path / "plain").stat().st_mode


def test_an_exclusive_write_never_replaces(tmp_path: Path) -> None:
    (tmp_path / "a.png").write_bytes(b"old")
    with pytest.raises(FileExistsError):
        write_atomically(tmp_path / "a.png", b"new", exclusive=True)
    assert (tmp_path / "a.png").read_bytes() == b"old"
    assert [entry.name for entry in tmp_path.iterdir()] == ["a.png"]


def test_numbered_pictures_take_the_next_free_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "view-002.png").write_bytes(b"mine")
    pixels = np.zeros((4, 4, 3), dtype=np.uint8)
    (tmp_path / "view-004.png").symlink_to("nowhere.png")
    names = [
        write_numbered("view", lambda path: write_png(path, pixels, "{}", exclusive=True), first).name
        for first in (1, 1, 1, 0, 0)
    ]
    assert names == ["view-001.png", "view-003.png", "view-005.png", "view.png", "view-006.png"]
    assert not (tmp_path / "nowhere.png").exists()
    assert (tmp_path / "view-002.png").read_bytes() == b"mine"


# --- shaders that do not work


@pytest.fixture
def shaders(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy of shaders/ that the program reads."""
    shutil.copytree(SHADERS, tmp_path / "shaders")
    monkeypatch.setattr(shader_source, "resource_folder", lambda kind: tmp_path / kind)
    return tmp_path / "shaders"


def broken_line(path: Path, old: str, new: str) -> int:
    """Replace the first `old` by `new`; returns its line, from 1."""
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))
    return text[: text.index(old)].count("\n") + 1


def draw_anew(renderer: Renderer) -> None:
    """With programs of its own, which are compiled when they are first wanted."""
    fresh = Renderer(renderer.context)
    try:
        render_rgb(fresh, picture_of("green"), square_frame(65))
    finally:
        renderer.rest.use()
        fresh.release()


@pytest.mark.parametrize(
    ("file", "old", "new"),
    [
        ("sh.glsl", "int i = 0;", "int i = oops;"),
        ("display.glsl", "return clamp(light", "return light +"),
        ("sphere.frag", "colour = vec4(srgb_from_linear", "color = vec4(srgb_from_linear"),
        ("screen.vert", "gl_Position = ", "gl_Place = "),
        ("layer.frag", "texelFetch(", "texelFish("),
        ("lobes.glsl", "return 1.0;", "return one;"),
    ],
)
def test_a_broken_shader_is_named_by_file_and_line(
    renderer: Renderer, shaders: Path, file: str, old: str, new: str
) -> None:
    line = broken_line(shaders / file, old, new)
    with pytest.raises(ShaderError) as caught:
        draw_anew(renderer)
    assert f"shaders/{file}:{line}:" in str(caught.value)
    assert "\n" not in str(caught.value)
    assert caught.value.exit_code == 6


def test_shaders_that_do_not_fit_together_are_both_named(renderer: Renderer, shaders: Path) -> None:
    broken_line(
        shaders / "sphere.frag",
        "vec3 original_radiance(vec3 direction) {",
        "vec3 nowhere(vec3 d);\nvec3 original_radiance(vec3 direction) {\n    if (radius < 0) return nowhere(direction);",
    )
    with pytest.raises(ShaderError, match=r"shaders/screen\.vert \+ shaders/sphere\.frag do not link: .*nowhere"):
        draw_anew(renderer)


def test_a_missing_include_lists_the_files_there_are(renderer: Renderer, shaders: Path) -> None:
    broken_line(shaders / "sphere.frag", '"lobes.glsl"', '"lobs.glsl"')
    with pytest.raises(ShaderError, match=r"no shaders/lobs\.glsl; there is: display\.glsl, .*lobes\.glsl"):
        draw_anew(renderer)


# --- golden pictures

GOLDENS = {
    "golden-green.png": ["green", "--bands", "5", "--no-overlay", "--size", "320", "160"],
    "golden-map.png": ["venice_sunset", "--bands", "9", "--map", "--error", "signed", "--size", "640", "400"],
    "golden-behind.png": [
        "studio",
        "--bands",
        "6",
        "--camera",
        "250",
        "-20",
        "--error",
        "absolute",
        "--size",
        "900",
        "400",
    ],
    "golden-surfaces.png": ["green", "--bands", "6", "--lobes", "--no-overlay", "--size", "320", "160"],
    "golden-studio.png": ["studio", "--bands", "8", "--mute", "2", "--size", "640", "320"],
}


@pytest.mark.parametrize("name", GOLDENS)
def test_the_picture_is_the_golden_one(tmp_path: Path, name: str) -> None:
    """At most 2 of 255 and a thousandth of the pixels: what drivers may round differently."""
    if os.environ.get("SHVIEWER_UPDATE_GOLDENS"):
        assert screenshot(DATA / name, *GOLDENS[name], cwd=tmp_path).returncode == 0
    done = screenshot("a.png", *GOLDENS[name], "--reference", DATA / name, "--threshold", 0.001, cwd=tmp_path)
    assert done.returncode == 0, done.stderr


def test_a_golden_picture_is_told_from_one_with_another_exposure(tmp_path: Path) -> None:
    """A tenth of a stop: the comparison above can fail."""
    arguments = [*GOLDENS["golden-green.png"], "--exposure", "-0.4", "--reference", str(DATA / "golden-green.png")]
    done = screenshot("a.png", *arguments, cwd=tmp_path)
    assert done.returncode == 1
    assert "of the pixels differ" in done.stderr


def test_an_odd_frame_is_drawn_to_its_last_pixel(renderer: Renderer) -> None:
    shown = render_rgb(renderer, picture_of("constant"), square_frame(65), overlay=False)
    assert shown.shape == (65, 130, 3)
    assert (shown[-1, -1] == shown[0, 0]).all()


STRIPS: dict[str, dict[str, Any]] = {
    "32 bands, summed": {"n_bands": 32},
    "an error with lines and marks": {"n_bands": 9, "error": "signed"},
    "a map of the sphere, enlarged": {"n_bands": 5, "whole_sphere": True, "zoom": 1.7, "map_centre": (40.0, 10.0)},
    "two reconstructions": {"n_bands": 9, "window": "hann", "beside": "no-window"},
    "bands from a map": {"n_bands": 40, "error": "relative"},
    "surfaces": {"n_bands": 5, "lobe_view": True, "error": "signed"},
    "a photograph": {"light": "venice_sunset", "n_bands": 6, "split_sun": True, "zoom": 3.0, "pan": (0.3, 0.2)},
}
"""Pictures whose lines, edges and samples depend on the neighbours of a pixel."""


@pytest.mark.parametrize("kind", STRIPS)
def test_a_picture_drawn_in_parts_has_every_byte_of_the_one_drawn_at_once(
    renderer: Renderer, monkeypatch: pytest.MonkeyPatch, kind: str
) -> None:
    """In strips of one row and of many, with frames of the window between them."""
    picture, other = (
        picture_of(**STRIPS[kind]),
        picture_of(light=STRIPS[kind].get("light", "green"), n_bands=2, lobe_view=True),
    )
    frame = frame_for(picture.state.view, 401, 300)
    whole = render_rgb(renderer, picture, frame)
    monkeypatch.setattr(renderers, "FIRST_PIXELS", 1000)
    monkeypatch.setattr(surface_renderer, "FIRST_TRIANGLES", 500)
    for seconds in (0.003, 0.01) if kind == "surfaces" else (0.0, 0.001):  # no less than a part takes without triangles
        monkeypatch.setattr(screenshots, "PART_SECONDS", seconds)
        parts, shares = render_in_parts(renderer, picture, frame), []
        while True:
            try:
                shares.append(next(parts))
            except StopIteration as last:
                pixels = last.value()
                break
            if len(shares) % (4 if kind == "surfaces" else 50) == 2:
                render_rgb(renderer, other, square_frame(64))
        np.testing.assert_array_equal(pixels, whole)
        assert shares == sorted(shares)
        assert shares[-1] == 1.0
        assert len(shares) > (100 if seconds == 0.0 else 9 if kind == "surfaces" else 2)
