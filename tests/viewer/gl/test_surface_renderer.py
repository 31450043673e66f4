"""The lobe view on the GPU: its outline, its colours, its edges, and what it leaves behind."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import moderngl
import numpy as np
import pytest
from helpers import from_srgb, to_srgb
from numpy.typing import NDArray
from viewer.gl.frames import sum_of_harmonics
from viewer.gl.silhouettes import coverage, outline

from shviewer.harmonics.basis import Array, evaluate_basis, index
from shviewer.harmonics.metrics import LUMINANCE
from shviewer.viewer.camera import matrix, towards, world_from_view
from shviewer.viewer.composing.panes import Box, Sphere
from shviewer.viewer.gl import surface_renderer, triangles
from shviewer.viewer.gl.renderer import Renderer
from shviewer.viewer.gl.shared import BACKGROUND
from shviewer.viewer.gl.surface_mesh import surface_mesh
from shviewer.viewer.gl.surface_renderer import OVERSAMPLING, TILE, SurfaceRenderer, tiles
from shviewer.viewer.gl.triangles import MOST_SURFACES
from shviewer.viewer.surface import (
    Surface,
    basis_surface,
    rows_for,
    sample_reconstruction,
    surface,
)

SIDE = 460
SPHERE = Sphere(230.37, 229.81, 222.0, Box(0, 0, SIDE, SIDE))
SKEW = world_from_view(30.0, 20.0)
FRONT = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
"""The light's y to the right, its z up, its x to the viewer."""
EMPTY = np.round(255 * to_srgb(np.array(BACKGROUND))).astype(int)


@dataclass
class Frame:
    context: moderngl.Context
    target: moderngl.Framebuffer
    surfaces: SurfaceRenderer

    def draw(self, shown: Surface, light_from_view: Array, sphere: Sphere = SPHERE) -> NDArray[np.int64]:
        """(height, width, 3), top row first, over BACKGROUND."""
        self.target.use()
        self.target.clear(*(EMPTY / 255), 1.0)
        for box in tiles(sphere, SIDE):
            with self.surfaces.tile(self.target, sphere, SIDE, shown, light_from_view, box) as steps:
                steps.draw(0, steps.total)
        pixels = np.frombuffer(self.target.read(components=3), dtype=np.uint8)
        return pixels.reshape(SIDE, SIDE, 3)[::-1].astype(int)

    def covered(self, sphere: Sphere = SPHERE) -> Array:
        """The share of each pixel of the frame that the surface drawn last covers, from the samples themselves."""
        tones = np.frombuffer(self.surfaces.spare[0][0].read(components=1, dtype="f2"), dtype=np.float16)
        assert np.isfinite(tones).all()
        pixels = (tones.reshape(TILE, OVERSAMPLING, TILE, OVERSAMPLING) != 0).mean(axis=(1, 3))
        reach = sphere.radius + 1
        left, low = (max(0, int(np.floor(middle - reach))) for middle in (sphere.x, SIDE - sphere.y))
        frame = np.zeros((SIDE, SIDE))
        frame[low:, left:] = pixels[: SIDE - low, : SIDE - left]
        return frame[::-1]


@pytest.fixture
def frame(renderer: Renderer) -> Iterator[Frame]:
    texture = renderer.context.texture((SIDE, SIDE), 4)
    target = renderer.context.framebuffer([texture])
    surfaces = SurfaceRenderer(renderer.context)
    yield Frame(renderer.context, target, surfaces)
    renderer.rest.use()
    for part in (surfaces, target, texture):
        part.release()


def harmonic(l: int, m: int) -> Callable[[Array], Array]:
    """Y(l, m) in units of its largest magnitude, which a fine grid along theta finds: |cos m phi| reaches 1."""
    theta = np.linspace(0, np.pi, 20001)
    phi = np.pi / 2 / abs(m) if m < 0 else 0.0
    meridian = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=1)
    peak = np.abs(evaluate_basis(meridian, l + 1)[:, index(l, m)]).max()
    return lambda directions: evaluate_basis(directions, l + 1)[:, index(l, m)] / peak


def blue(pixel: NDArray[np.int64]) -> bool:
    return bool(pixel[2] > 1.3 * pixel[0])


def warm(pixel: NDArray[np.int64]) -> bool:
    return bool(pixel[0] > 1.05 * pixel[2])


def at(pixels: NDArray[np.int64], right: float, up: float) -> NDArray[np.int64]:
    """The pixel at a place in units of the radius from the centre."""
    return pixels[int(SPHERE.y - up * SPHERE.radius), int(SPHERE.x + right * SPHERE.radius)]


# --- where it is


def assert_outline(frame: Frame, shown: Surface, values: Callable[[Array], Array]) -> None:
    """Against float64 rays, 8 x 8 a pixel.

    9 samples a pixel are off by up to 1/3 where an edge is parallel to their rows, and triangles cut up to half a pixel off
    a tip of 16 bands: so much in 1 % of the pixels on the edge, and on average 0.15. A pixel's breadth inside and
    outside the edge all is covered and nothing is.
    """
    frame.draw(shown, SKEW)
    true = coverage(outline(values, SKEW), SPHERE, SIDE, SIDE)
    error = np.abs(frame.covered() - true)
    edge = (true > 0) & (true < 1)
    assert edge.sum() > 500
    assert error[edge].mean() < 0.15
    assert (error[edge] > 0.5).mean() < 0.01
    assert (error > 0.75).mean() < 1e-5
    assert error[~edge].mean() < 2e-4


@pytest.mark.parametrize(("l", "m"), [(0, 0), (1, -1), (3, 2), (15, 0), (15, 7)])
def test_a_function_has_the_outline_that_rays_find(frame: Frame, l: int, m: int) -> None:
    assert_outline(frame, basis_surface(l, m, rows_for(l + 1, SPHERE.radius)), harmonic(l, m))


def test_a_reconstruction_has_the_outline_that_rays_find(frame: Frame) -> None:
    coefficients = np.random.default_rng(0).normal(size=(256, 3)) / np.sqrt(1 + np.arange(256))[:, None]
    values = sample_reconstruction(coefficients, 513)
    unit = float(np.abs(values).max())
    assert_outline(frame, surface(values, unit), lambda d: sum_of_harmonics(d, coefficients) @ LUMINANCE / unit)


def test_square_roots_have_the_outline_that_rays_find(frame: Frame) -> None:
    """The surface of a magnitude that is steep where its sign changes."""
    coefficients = np.random.default_rng(1).normal(size=(36, 3))
    values = sample_reconstruction(coefficients, 513)
    unit = float(np.abs(values).max())

    def radius(directions: Array) -> Array:
        value = sum_of_harmonics(directions, coefficients) @ LUMINANCE / unit
        return np.asarray(np.copysign(np.sqrt(np.abs(value)), value))

    assert_outline(frame, surface(values, unit, root=True), radius)


def test_an_asymmetric_surface_turns_as_the_spheres_do(frame: Frame) -> None:
    """A bump towards one direction of the light is drawn where light_from_view takes the view there."""
    axis = np.array([0.48, -0.6, 0.64])
    bump = np.linalg.inv(evaluate_basis(np.eye(3), 2)[:, 1:]) @ axis
    coefficients = np.zeros((4, 3))
    coefficients[1:] = bump[:, None]
    shown = surface(
        sample_reconstruction(coefficients, 129), float(np.abs(sample_reconstruction(coefficients, 129)).max())
    )
    for turn in (FRONT, SKEW, matrix(towards(-70.0, 40.0)) @ SKEW):
        pixels = frame.draw(shown, turn)
        right, up, to_viewer = turn.T @ axis  # where the middle of the positive ball is; the negative one is opposite
        if to_viewer > -0.3:
            assert warm(at(pixels, 0.6 * right, 0.6 * up))
        if to_viewer < 0.3:
            assert blue(at(pixels, -0.6 * right, -0.6 * up))
        assert np.abs(frame.covered() - coverage(outline(lambda d: d @ axis, turn), SPHERE, SIDE, SIDE)).max() < 0.5


@pytest.mark.parametrize(("l", "m"), [(2, 1), (5, -3), (9, 0)])
def test_what_is_nearest_on_a_ray_is_what_is_seen(frame: Frame, l: int, m: int) -> None:
    """Random pixels against 2000 points on each ray in float64; edges between lobes pass through some of them."""
    pixels = frame.draw(basis_surface(l, m, rows_for(l + 1, SPHERE.radius)), SKEW)
    columns, rows = np.random.default_rng(0).integers(60, SIDE - 60, size=(2, 1500))
    x, y = (columns + 0.5 - SPHERE.x) / SPHERE.radius, (SPHERE.y - rows - 0.5) / SPHERE.radius
    depth = np.linspace(1, -1, 2001)
    wrong, hits, values = 0, 0, harmonic(l, m)
    for column, row, right, up in zip(columns, rows, x, y, strict=True):
        points = np.stack([np.full(2001, right), np.full(2001, up), depth], axis=1)
        distance = np.linalg.norm(points, axis=1)
        value = values(points @ SKEW.T / distance[:, None])
        inside = np.abs(value) >= distance
        pixel = pixels[row, column]
        if not inside.any():
            wrong += bool((np.abs(pixel - EMPTY) > 3).any())
            continue
        hits += 1
        wrong += not (warm if value[inside.argmax()] > 0 else blue)(pixel)
    assert hits > 150
    assert wrong < 0.02 * 1500


def test_a_surface_is_cut_to_its_box_and_pixels_beside_it_are_left_alone(frame: Frame) -> None:
    shown = basis_surface(0, 0, 129)
    box = Box(100, 150, 301, 333)
    pixels = frame.draw(shown, SKEW, SPHERE._replace(clip=box, radius=700.0))
    inside = np.zeros((SIDE, SIDE), dtype=bool)
    inside[150:333, 100:301] = True
    assert (pixels[~inside] == EMPTY).all()
    assert (pixels[inside].min(axis=-1) > 60).all()


def test_tiles_join_without_a_seam(frame: Frame, monkeypatch: pytest.MonkeyPatch) -> None:
    shown = basis_surface(5, 2, 257)
    whole = frame.draw(shown, SKEW)
    monkeypatch.setattr(surface_renderer, "TILE", 128)
    surfaces = SurfaceRenderer(frame.context)
    parts = Frame(frame.context, frame.target, surfaces).draw(shown, SKEW)
    surfaces.release()
    assert (np.abs(parts - whole).max(axis=-1) > 2).mean() < 1e-3  # samples right on an edge


# --- its colours


@pytest.mark.parametrize(
    ("l", "m", "view", "positive"),
    [
        (1, 1, FRONT, False),  # -x, seen from +x
        (1, 1, FRONT @ np.diag([-1.0, 1.0, -1.0]), True),  # from -x
        (2, 0, FRONT, False),  # 3 z^2 - 1 on the equator
        (2, 2, FRONT, True),  # x^2 - y^2
        (2, 0, np.eye(3), True),  # from +z
        (1, 0, np.diag([1.0, -1.0, -1.0]), False),  # z, from -z
        (15, 0, np.diag([1.0, -1.0, -1.0]), False),  # odd: negative at the south pole
        (14, 0, np.diag([1.0, -1.0, -1.0]), True),
    ],
)
def test_looking_down_an_axis_the_sign_of_the_value_there_is_seen(
    frame: Frame, l: int, m: int, view: Array, positive: bool
) -> None:
    pixel = at(frame.draw(basis_surface(l, m, rows_for(l + 1, SPHERE.radius)), view), 0.0, 0.0)
    assert (warm(pixel), blue(pixel)) == (positive, not positive)


def test_every_pixel_inside_is_of_one_sign_or_on_an_edge(frame: Frame) -> None:
    """Y(2,2) from +z: four petals, each of one colour right to the centre, where no triangle bridges two of them."""
    pixels = frame.draw(basis_surface(2, 2, 257), np.eye(3))
    for angle in np.radians(np.arange(0, 360, 3) + 1.5):
        if abs(np.cos(2 * angle)) < 0.3:  # thinner than a pixel
            continue
        for share in (0.15, 0.4, 0.7):
            reach = share * abs(np.cos(2 * angle)) * 0.95
            pixel = at(pixels, reach * np.cos(angle), reach * np.sin(angle))
            assert (warm if np.cos(2 * angle) > 0 else blue)(pixel), (np.degrees(angle), share)


def test_poles_and_seam_do_not_show(frame: Frame) -> None:
    """A sphere looks the same from everywhere, and so smooth that neighbours differ by little."""
    shown = surface(np.ones((129, 256), dtype=np.float32), 1.0)
    views = [np.eye(3), FRONT, world_from_view(180.0, 0.0), SKEW]
    pictures = [frame.draw(shown, view) for view in views]
    middle = slice(100, 360), slice(100, 360)
    for pixels in pictures:
        assert np.abs(pixels[middle] - pictures[0][middle]).max() <= 2
        assert np.abs(np.diff(pixels[middle], 2, axis=0)).max() <= 3


@pytest.mark.parametrize(("l", "m"), [(1, 0), (2, 1), (4, 3)])
def test_normals_are_those_of_the_function(l: int, m: int) -> None:
    """Normals of vertices, against float64 differences of the function; where a triangle is pinched they are interpolated."""
    shown = basis_surface(l, m, 257)
    mesh = surface_mesh(shown.values, 0.25 / SPHERE.radius)
    value, direction = mesh.vertices[:, 0].astype(float), mesh.vertices[:, 1:4].astype(float)
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    values, step = harmonic(l, m), 1e-5
    slope = np.stack(
        [
            (values(unit(direction + step * axis)) - values(unit(direction - step * axis))) / (2 * step)
            for axis in np.eye(3)
        ],
        axis=1,
    )
    exact = value[:, None] * direction - slope
    found = mesh.vertices[:, 4:].astype(float)
    cosine = (unit(exact) * unit(found)).sum(axis=1)
    assert np.degrees(np.arccos(np.clip(cosine, -1, 1))).max() < 2.0


def unit(vectors: Array) -> Array:
    return np.asarray(vectors / np.linalg.norm(vectors, axis=-1, keepdims=True))


def test_nothing_but_the_circle_of_radius_1_is_drawn_of_zero(frame: Frame) -> None:
    pixels = frame.draw(surface(np.zeros((129, 256), np.float32), 0.0), SKEW)
    assert (frame.covered() == 0).all()
    y, x = np.nonzero((pixels != EMPTY).any(axis=-1))
    distance = np.hypot(x + 0.5 - SPHERE.x, SPHERE.y - y - 0.5)
    assert np.abs(distance - SPHERE.radius).max() < 1.5
    assert np.abs(pixels - EMPTY).max() < 30


def test_edges_are_blended_in_linear_light(frame: Frame, monkeypatch: pytest.MonkeyPatch) -> None:
    """The picture is that of 4 times as many samples, averaged here in linear light, to what 9 samples are off by.

    Averaged as encoded, edges would come out darker, by 20 and more.
    """
    shown = basis_surface(3, 2, 129)
    pixels = frame.draw(shown, SKEW)
    monkeypatch.setattr(surface_renderer, "OVERSAMPLING", 1)
    monkeypatch.setattr(surface_renderer, "RING_WIDTH", 0.0)
    fine, side = 6, SIDE
    surfaces = SurfaceRenderer(frame.context)
    sum_ = np.zeros((side, side, 3))
    for dy in range(fine):
        for dx in range(fine):
            shift = ((0.5 + dx) / fine - 0.5, (0.5 + dy) / fine - 0.5)
            moved = SPHERE._replace(x=SPHERE.x - shift[0], y=SPHERE.y - shift[1])
            sum_ += from_srgb(Frame(frame.context, frame.target, surfaces).draw(shown, SKEW, moved) / 255)
    surfaces.release()
    wanted = 255 * to_srgb(sum_ / fine**2)
    y, x = np.indices((side, side))
    off_ring = np.abs(np.hypot(x + 0.5 - SPHERE.x, SPHERE.y - y - 0.5) - SPHERE.radius) > 2
    difference = (pixels - wanted)[off_ring]
    edge = np.abs(difference).max(axis=-1) > 3
    assert 100 < edge.sum() < 0.05 * edge.size
    assert abs(difference[edge].mean()) < 3
    assert np.abs(difference).max() < 80


# --- what it leaves behind


def test_state_is_left_as_found(frame: Frame) -> None:
    context, target = frame.context, frame.target
    other = context.simple_framebuffer((32, 32))
    other.use()
    other.clear(0.2, 0.4, 0.6, 1.0)
    context.enable_only(moderngl.BLEND)
    target.viewport = (3, 5, 70, 80)
    for box in tiles(SPHERE, SIDE):
        with frame.surfaces.tile(target, SPHERE, SIDE, basis_surface(2, 1, 129), SKEW, box) as steps:
            steps.draw(0, steps.total)
    assert target.viewport == (3, 5, 70, 80)
    assert other.viewport == (0, 0, 32, 32)
    # A triangle at half strength, drawn without saying where: blended into the framebuffer that was bound, at any depth.
    program = context.program(
        vertex_shader="#version 330 core\nvoid main() { gl_Position = vec4(4.0 * vec2(gl_VertexID & 1, gl_VertexID >> 1)"
        " - 1.0, 0.9, 1.0); }",
        fragment_shader="#version 330 core\nout vec4 c; void main() { c = vec4(1.0, 1.0, 1.0, 0.5); }",
    )
    array = context.vertex_array(program, [])
    context.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA
    array.render(moderngl.TRIANGLES, vertices=3)
    array.render(moderngl.TRIANGLES, vertices=3)
    pixels = np.frombuffer(other.read(components=3), dtype=np.uint8).reshape(-1, 3)
    context.disable(moderngl.BLEND)
    target.use()
    for part in (array, program, *other.color_attachments, other):
        part.release()
    assert (np.abs(pixels.astype(int) - np.round(255 * (0.75 + 0.25 * np.array([0.2, 0.4, 0.6])))) <= 2).all()


@contextmanager
def counted(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[float]]:
    made: list[float] = []
    mesh = triangles.surface_mesh

    def counting(values: NDArray[np.float32], tolerance: float) -> object:
        made.append(tolerance)
        return mesh(values, tolerance)

    with monkeypatch.context() as patch:
        patch.setattr(triangles, "surface_mesh", counting)
        yield made


def test_a_surface_is_meshed_once_and_again_only_when_it_is_drawn_much_larger(
    frame: Frame, monkeypatch: pytest.MonkeyPatch
) -> None:
    first, second = basis_surface(2, 1, 129), basis_surface(2, 0, 129)
    with counted(monkeypatch) as made:
        for shown in (first, second, first, second):
            frame.draw(shown, SKEW)
        frame.draw(first, FRONT)
        frame.draw(first, SKEW, SPHERE._replace(radius=SPHERE.radius * 1.1))
        assert len(made) == 2
        frame.draw(first, SKEW, SPHERE._replace(radius=SPHERE.radius * 2))
        assert len(made) == 3
        assert made[2] == made[0] / 2


def test_what_is_held_is_bounded_and_all_is_released(frame: Frame) -> None:
    for order in range(-3, 4):
        frame.draw(basis_surface(3, order, 129), SKEW)
    assert len(frame.surfaces.triangles.held) == MOST_SURFACES
    held = list(frame.surfaces.triangles.held.values())
    programs = frame.surfaces.program, frame.surfaces.resolve_program
    (tile,) = frame.surfaces.spare
    frame.surfaces.release()
    assert not frame.surfaces.triangles.held
    parts = [*tile, *(program.program for program in programs), *(d.vertices for d in held)]
    assert all(isinstance(part.mglo, moderngl.InvalidObject) for part in parts)
    frame.surfaces = SurfaceRenderer(frame.context)
