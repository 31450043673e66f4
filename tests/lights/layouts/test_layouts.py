"""What shviewer.lights.layouts promises: where each texel lies, how large it is, and exact integrals over it.

The references here are written from the definitions, point by point; areas are those of many small cells.
"""

import itertools

import numpy as np
import pytest
from harmonics.independent import random_directions
from numpy.testing import assert_allclose, assert_array_equal

from shviewer.errors import LightError
from shviewer.harmonics.areas import ball
from shviewer.harmonics.basis import evaluate_basis
from shviewer.harmonics.projection.scattered import project_values
from shviewer.lights.layouts import mirror_ball
from shviewer.lights.layouts.angular import AngularLayout
from shviewer.lights.layouts.arrangements import (
    HORIZONTAL_CROSS,
    HORIZONTAL_STRIP,
    OPENEXR,
    PACK,
    TALL_PACK,
    VERTICAL_CROSS,
    VERTICAL_STRIP,
)
from shviewer.lights.layouts.cube import CubeLayout
from shviewer.lights.layouts.lat_long import LatLongLayout
from shviewer.lights.layouts.mirror_ball import MirrorBallLayout
from shviewer.lights.layouts.recognise import recognise
from shviewer.lights.reading import LAYOUTS

FORWARD, LEFT, UP = np.eye(3)
CUBES = (VERTICAL_STRIP, HORIZONTAL_STRIP, OPENEXR, VERTICAL_CROSS, HORIZONTAL_CROSS)


def named(layouts):
    return pytest.mark.parametrize(
        "layout", layouts, ids=lambda it: f"{getattr(getattr(it, 'arrangement', it), 'name', '')} {it.size}"
    )


def all_layouts(size):
    """Layouts of about as many texels each: faces of `size` texels."""
    cubes = [CubeLayout(arrangement, size) for arrangement in CUBES]
    return [LatLongLayout(2 * size, 4 * size), *cubes, AngularLayout(3 * size), MirrorBallLayout(3 * size)]


SMALL = [
    LatLongLayout(1, 1),
    LatLongLayout(2, 3),
    *(CubeLayout(arrangement, 1) for arrangement in CUBES),
    *(layout(side) for layout in (AngularLayout, MirrorBallLayout) for side in (1, 2, 3)),
]
EVERY = [*SMALL, LatLongLayout(7, 5), *all_layouts(4), *all_layouts(5)]


def shape(layout):
    angles = layout.solid_angles()
    return (len(angles), layout.width) if isinstance(layout, LatLongLayout) else angles.shape


def solid_angles(layout):
    return np.broadcast_to(layout.solid_angles(), shape(layout))


# --- the definitions


def direction_at(layout, row, column):
    """The unit direction (k, 3) at image coordinates in texels from the upper left corner; NaN where nothing is shown."""
    height, width = shape(layout)
    if isinstance(layout, LatLongLayout):
        theta, phi = np.pi * row / height, np.pi * (1 - 2 * column / width)
        across = np.sin(theta)
        return np.stack([across * np.cos(phi), across * np.sin(phi), np.cos(theta)], axis=-1)
    if isinstance(layout, CubeLayout):
        return on_cube(layout, row, column)
    x, y = 2 * column / width - 1, 1 - 2 * row / height
    radius, azimuth = np.hypot(x, y), np.arctan2(y, x)
    radius = np.where(radius > 1, np.nan, radius)
    theta = np.pi * radius if layout.name == "angular" else 2 * np.arcsin(radius)
    sideways = np.cos(azimuth)[:, None] * -LEFT + np.sin(azimuth)[:, None] * UP
    return np.cos(theta)[:, None] * FORWARD + np.sin(theta)[:, None] * sideways


def on_cube(layout, row, column):
    size, arrangement = layout.face, layout.arrangement
    cell_row, cell_column = (row // size).astype(int), (column // size).astype(int)
    s, t = 2 * (column / size - cell_column) - 1, 2 * (row / size - cell_row) - 1
    directions = np.full((len(row), 3), np.nan)
    for i in range(len(row)):
        where = (cell_row[i], cell_column[i])
        if arrangement in (VERTICAL_STRIP, HORIZONTAL_STRIP):
            directions[i] = opengl(max(where), s[i], t[i])
        elif arrangement is OPENEXR:
            directions[i] = openexr(where[0], s[i], t[i])
        elif where in (moves := VERTICAL_MOVES if arrangement is VERTICAL_CROSS else HORIZONTAL_MOVES):
            directions[i] = unfolded(moves[where], s[i], t[i])
    return directions / np.linalg.norm(directions, axis=1, keepdims=True)


def opengl(face, s, t):
    """The table of major axes in the OpenGL specification (4.6, 8.13), solved for the direction rx, ry, rz."""
    rx, ry, rz = [(1, -t, -s), (-1, -t, s), (s, 1, t), (s, -1, -t), (s, -t, 1), (-s, -t, -1)][face]
    return rz * FORWARD - rx * LEFT + ry * UP  # a left-handed space: x to the right


def openexr(face, s, t):
    """Where ImfEnvmap.h puts x, y and z on the six faces of the data window, one below the other."""
    x, y, z = [(1, -t, s), (-1, -t, -s), (s, 1, -t), (s, -1, t), (-s, -t, 1), (s, -t, -1)][face]
    return z * FORWARD + x * LEFT + y * UP


VERTICAL_MOVES = {(1, 1): "", (0, 1): "u", (1, 0): "l", (1, 2): "r", (2, 1): "d", (3, 1): "dd"}
HORIZONTAL_MOVES = {(1, 1): "", (0, 1): "u", (1, 0): "l", (1, 2): "r", (2, 1): "d", (1, 3): "rr"}


def unfolded(moves, s, t):
    """A cube rolled from its front face cell by cell: up, down, left, right."""
    centre, right, down = FORWARD, -LEFT, -UP
    for move in moves:
        if move == "r":
            centre, right = right, -centre
        elif move == "l":
            centre, right = -right, centre
        elif move == "d":
            centre, down = down, -centre
        else:
            centre, down = -down, centre
    return centre + s * right + t * down


def cells(layout, row, column, fine):
    """Centres (k, 3) and solid angles (k,) of the fine^2 cells of one texel that show something.

    Flat quadrilaterals between corners on the sphere. In a disc, where cells at the rim would be badly off: their area in the
    image times the mean density of a narrow ring, and whole or nothing by their centres.
    """
    steps = np.linspace(1e-9, 1 - 1e-9, fine + 1)  # just inside: an edge belongs to another cell
    if isinstance(layout, (AngularLayout, MirrorBallLayout)):
        middles = np.meshgrid(row + (steps[1:] + steps[:-1]) / 2, column + (steps[1:] + steps[:-1]) / 2, indexing="ij")
        y, x = (2 * a.ravel() / layout.side - 1 for a in middles)
        radius = np.hypot(x, y)[np.hypot(x, y) < 1]
        inner, outer = np.maximum(radius - 1e-4, 0), np.minimum(radius + 1e-4, 1)
        cosines = [np.cos(np.pi * r if layout.name == "angular" else 2 * np.arcsin(r)) for r in (inner, outer)]
        density = 2 * (cosines[0] - cosines[1]) / (outer**2 - inner**2)
        return direction_at(layout, *(a.ravel()[np.hypot(x, y) < 1] for a in middles)), density * (
            2 / layout.side / fine
        ) ** 2
    at = np.meshgrid(row + steps, column + steps, indexing="ij")
    corners = direction_at(layout, at[0].ravel(), at[1].ravel()).reshape(fine + 1, fine + 1, 3)
    a, b, c, d = corners[:-1, :-1], corners[:-1, 1:], corners[1:, :-1], corners[1:, 1:]
    area = (np.linalg.norm(np.cross(b - a, c - a), axis=-1) + np.linalg.norm(np.cross(b - d, c - d), axis=-1)) / 2
    seen = np.isfinite(area)
    centre = (a + b + c + d)[seen]
    return centre / np.linalg.norm(centre, axis=-1, keepdims=True), area[seen]


def random_places(layout, count, seed=0):
    """Rows and columns, whole texels and the points in them, that show something."""
    random = np.random.default_rng(seed)
    points = random.uniform([0, 0], shape(layout), (count, 2))
    directions = direction_at(layout, points[:, 0], points[:, 1])
    seen = np.isfinite(directions[:, 0])
    return points[seen], directions[seen]


# --- where texels are


@named(EVERY)
def test_a_direction_finds_the_texel_that_shows_it(layout):
    points, directions = random_places(layout, 3000)
    rows, columns = layout.nearest(directions)
    expected = points.astype(np.int64)
    wrong = (rows != expected[:, 0]) | (columns != expected[:, 1])
    edge = np.abs(points - np.rint(points)).min(axis=1) < 1e-9
    assert not (wrong & ~edge).any()
    assert len(points) > 1000


@named(EVERY)
def test_the_six_axes_and_the_diagonals_have_a_texel_that_shows_something(layout):
    axes = np.concatenate([np.eye(3), -np.eye(3)])
    corners = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, -1).T / np.sqrt(3)
    edges = np.concatenate([np.roll([[1, s, 0], [-1, s, 0]], i, axis=1) for i in range(3) for s in (1, -1)]) / np.sqrt(
        2
    )
    directions = np.concatenate([axes, -0.0 * axes + axes, corners, edges])
    rows, columns = layout.nearest(directions)
    assert (solid_angles(layout)[rows, columns] > 0).all()


@named(all_layouts(8))
def test_six_colours_at_six_axes_are_found_there_and_nothing_is_mirrored(layout):
    """A scene of six differently coloured sides with a mark to the right of front and one above it."""
    axes = {"+x": 1.0, "-x": 2.0, "+y": 3.0, "-y": 4.0, "+z": 5.0, "-z": 6.0}

    def scene(directions):
        axis = np.abs(directions).argmax(axis=1)
        negative = np.take_along_axis(directions, axis[:, None], axis=1)[:, 0] < 0
        value = 1.0 + 2 * axis + negative
        value[(directions @ [0.9, -0.4, 0.1]) > 0.97] = 7.0
        value[(directions @ [0.9, 0.1, 0.4]) > 0.97] = 8.0
        return value

    height, width = shape(layout)
    pixels = np.zeros((height * width, 3), np.float32)
    for inward in (0.99, 0.75, 0.5):  # a texel on a rim shows what its inner part sees
        row, column = (a.ravel() + 0.5 for a in np.indices((height, width)))
        row, column = (
            row + np.sign(height / 2 - row) * (inward - 0.5),
            column + np.sign(width / 2 - column) * (inward - 0.5),
        )
        directions = direction_at(layout, row, column)
        seen = np.isfinite(directions[:, 0])
        pixels[seen] = scene(directions[seen])[:, None]
    pixels = pixels.reshape(height, width, 3)
    for name, colour in axes.items():
        direction = (1.0 if name[0] == "+" else -1.0) * np.eye(3)["xyz".index(name[1])] + [0.02, 0.03, 0.01]
        found = pixels[layout.nearest((direction / np.linalg.norm(direction))[None])]
        assert found[0, 0] == colour, name
    for place, colour in (([0.9, -0.4, 0.1], 7.0), ([0.9, 0.1, 0.4], 8.0)):
        found = pixels[layout.nearest((np.array(place) / np.linalg.norm(place))[None])]
        assert found[0, 0] == colour


def test_crosses_are_continuous_across_their_inner_edges():
    for arrangement, edges in (
        (VERTICAL_CROSS, [(1, 1.5), (2, 1.5), (3, 1.5), (1.5, 1), (1.5, 2)]),
        (HORIZONTAL_CROSS, [(1, 1.5), (2, 1.5), (1.5, 1), (1.5, 2), (1.5, 3)]),
    ):
        layout = CubeLayout(arrangement, 64)
        for row, column in edges:
            step = np.array([0.5, 0]) if row == int(row) else np.array([0, 0.5])
            places = np.array([64 * row, 64 * column])[None] + np.array([[-1], [0]]) * 2 * step
            ends = layout.centres(*places.astype(np.int64).T)
            assert np.linalg.norm(ends[0] - ends[1]) < 1.1 / 64


@named(EVERY)
def test_centres_are_those_of_the_definition_and_lie_in_their_texels(layout):
    height, width = shape(layout)
    rows, columns = (a.ravel() for a in np.indices((height, width)))
    centres = layout.centres(rows, columns)
    assert_allclose(np.linalg.norm(centres, axis=1), 1, rtol=0, atol=1e-15)
    expected = direction_at(layout, rows + 0.5, columns + 0.5)
    seen = np.isfinite(expected[:, 0])
    assert_allclose(centres[seen], expected[seen], rtol=0, atol=1e-14)
    shows = solid_angles(layout).ravel() > 1e-12
    found = layout.nearest(centres[shows])
    assert_array_equal(found, (rows[shows], columns[shows]))


# --- how high they are

RISING = [*EVERY, CubeLayout(PACK, 6), CubeLayout(TALL_PACK, 5)]


@named([*RISING, *all_layouts(64), AngularLayout(511), MirrorBallLayout(1001)])
def test_the_rises_add_up_to_the_upper_half(layout):
    rises = layout.rises()
    assert rises.shape == layout.solid_angles().shape
    assert (rises >= -1e-15).all()
    total = rises.sum() * (layout.width if isinstance(layout, LatLongLayout) else 1)
    assert_allclose(total, np.pi, rtol=1e-13, atol=0)


@named(EVERY)
def test_the_rise_of_a_texel_is_the_integral_of_its_height_above_the_horizon(layout):
    rises = np.broadcast_to(layout.rises(), shape(layout))
    random = np.random.default_rng(3)
    for _ in range(6):
        row, column = (int(random.integers(count)) for count in shape(layout))
        directions, areas = cells(layout, row, column, 40)
        assert_allclose(rises[row, column], np.maximum(directions[:, 2], 0) @ areas, rtol=0.01, atol=2e-3)


@named(all_layouts(48))
def test_rises_are_the_exact_integrals_of_the_second_band(layout):
    """With an even number of texels a side, the horizon lies between them."""
    pixels = np.random.default_rng(4).random((*shape(layout), 3)).astype(np.float32)
    rows, columns = (index.ravel() for index in np.indices(shape(layout)))
    above = (layout.centres(rows, columns)[:, 2] > 0).reshape(shape(layout))
    expected = layout.project(pixels * above[..., None], 2)[2] * np.sqrt(4 * np.pi / 3)
    found = np.einsum("rc,rck->k", np.broadcast_to(layout.rises(), shape(layout)), pixels.astype(np.float64))
    assert_allclose(found, expected, rtol=1e-12, atol=0)


# --- how large they are


@named(
    [
        *EVERY,
        *all_layouts(64),
        LatLongLayout(4, 38400),
        AngularLayout(511),
        AngularLayout(512),
        AngularLayout(1000),
        MirrorBallLayout(1001),
    ]
)
def test_solid_angles_add_up_to_the_sphere(layout):
    angles = layout.solid_angles()
    total = angles.sum() * (layout.width if isinstance(layout, LatLongLayout) else 1)
    assert (angles >= 0).all()
    assert_allclose(total, 4 * np.pi, rtol=1e-13, atol=0)


@named(EVERY)
def test_the_solid_angle_of_every_texel_is_what_small_cells_say(layout):
    """A sixtieth of a texel wide; those on a rim are wholly in or out."""
    angles = solid_angles(layout)
    fine = 60
    for row, column in np.random.default_rng(1).integers([0, 0], angles.shape, (12, 2)):
        _, area = cells(layout, row, column, fine)
        assert_allclose(area.sum(), angles[row, column], rtol=2e-3, atol=2e-3 * 4 * np.pi / angles.size)


@named([*EVERY, CubeLayout(VERTICAL_CROSS, 33), AngularLayout(600), MirrorBallLayout(601)])
def test_the_solid_angles_of_some_texels_are_those_of_all(layout):
    angles = solid_angles(layout)
    rows, columns = (a.ravel()[:: 1 + angles.size // 5000] for a in np.indices(angles.shape))
    assert_array_equal(layout.solid_angles_at(rows, columns), angles[rows, columns])


# --- what they add up to


@named([*EVERY, CubeLayout(OPENEXR, 33), AngularLayout(33), AngularLayout(64), AngularLayout(100)])
@pytest.mark.parametrize("n_bands", [1, 4, 20])
def test_a_constant_map_gives_one_coefficient(layout, n_bands):
    pixels = np.ones((*shape(layout), 3), np.float32) * np.float32([1, 0.5, 3])
    coefficients = layout.project(pixels, n_bands)
    assert_allclose(coefficients[0], np.sqrt(4 * np.pi) * np.array([1, 0.5, 3]), rtol=1e-13, atol=0)
    others = np.abs(coefficients[1:]).max(initial=0) / coefficients[0].max()
    assert others < 1e-13


@named([CubeLayout(HORIZONTAL_CROSS, 6), AngularLayout(24), AngularLayout(2), MirrorBallLayout(5)])
def test_a_constant_map_gives_one_coefficient_at_many_bands(layout):
    pixels = np.ones((*shape(layout), 3), np.float32)
    coefficients = layout.project(pixels, 64)
    assert_allclose(coefficients[0], np.sqrt(4 * np.pi), rtol=1e-12, atol=0)
    others = np.abs(coefficients[1:]).max() / coefficients[0].max()
    assert others < 1e-12


@named(EVERY)
def test_a_hot_texel_anywhere_has_the_energy_of_its_solid_angle(layout):
    angles = solid_angles(layout)
    height, width = angles.shape
    places = {(0, 0), (0, width - 1), (height - 1, width // 2), (height // 2, 0), (height // 2, width // 2)}
    places |= {tuple(place) for place in np.random.default_rng(2).integers([0, 0], angles.shape, (4, 2)).tolist()}
    for row, column in places:
        pixels = np.zeros((height, width, 3), np.float32)
        pixels[row, column] = [1, 2, 1000]
        found = layout.project(pixels, 3)[0] * np.sqrt(4 * np.pi)
        assert_allclose(found, angles[row, column] * np.array([1, 2, 1000]), rtol=1e-11, atol=1e-13)


@named([layout for layout in EVERY if layout not in SMALL])
def test_a_hot_texel_is_where_its_definition_says(layout):
    """Against cells of 1/100 texel, to their error."""
    angles = solid_angles(layout)
    shown = np.argwhere(angles > 0.2 * 4 * np.pi / angles.size)
    for row, column in np.random.default_rng(3).permutation(shown)[:5]:
        pixels = np.zeros((*angles.shape, 3), np.float32)
        pixels[row, column] = 1
        directions, area = cells(layout, row, column, 100)
        expected = area @ evaluate_basis(directions, 6)
        found = layout.project(pixels, 6)
        assert_allclose(found[:, 1], expected, rtol=0, atol=1e-3 * angles[row, column])


@named(EVERY)
def test_band_0_is_the_sum_of_radiance_times_solid_angle(layout):
    pixels = np.random.default_rng(4).normal(size=(*shape(layout), 3)).astype(np.float32)
    expected = np.einsum("rc,rcx->x", solid_angles(layout), pixels.astype(np.float64)) / np.sqrt(4 * np.pi)
    assert_allclose(layout.project(pixels, 2)[0], expected, rtol=0, atol=1e-12)


@named(EVERY)
def test_no_band_count_changes_the_lower_bands(layout):
    """So the point counts suffice: more bands use more points."""
    pixels = np.random.default_rng(5).random((*shape(layout), 3)).astype(np.float32)
    assert_allclose(layout.project(pixels, 9), layout.project(pixels, 40)[:81], rtol=0, atol=1e-13)


@pytest.mark.parametrize(
    ("layout", "n_bands"),
    [
        (layout(side), n)
        for layout, side in ((MirrorBallLayout, 5), (MirrorBallLayout, 4), (AngularLayout, 5))
        for n in (6, 24)
    ]
    + [(MirrorBallLayout(10), 6), (AngularLayout(10), 6)],  # with corners that lie on the rim: 3, 4, 5
    ids=str,
)
def test_a_disc_is_the_sum_over_its_texels_of_a_rule_that_takes_any_rim(layout, n_bands):
    """Against double exponential quadrature of every texel's part inside the circle, which roots at the ends do not disturb."""
    pixels = np.random.default_rng(12).normal(size=(layout.side, layout.side, 3)).astype(np.float32)
    expected = np.zeros((n_bands**2, 3))
    for directions, weights, texel in parts_of_texels(layout, 40 if n_bands < 10 else 60):
        expected += project_values(directions, weights[:, None] * pixels[texel], n_bands)
    found = layout.project(pixels, n_bands)
    assert np.abs(found - expected).max() < 1e-12 * np.abs(expected).max()


def parts_of_texels(layout, n):
    """Directions, steradians and the texel of points in each part of a texel whose sides are smooth: first x, then y."""
    step = 3.2 * np.arange(-n, n + 1) / n
    share = 1 / (1 + np.exp(-np.pi * np.sinh(step)))  # tanh-sinh on [0, 1], and 1 - share, without cancellation
    rest, weight = share[::-1], 3.2 / n * np.pi * np.cosh(step) * share * share[::-1]
    edges = 2 * np.arange(layout.side + 1) / layout.side - 1
    for row, column in np.ndindex(layout.side, layout.side):
        (y0, y1), (x0, x1) = (sorted(np.abs(edges[[i, i + 1]])) for i in (row, column))
        if edges[row] < 0 < edges[row + 1]:
            y0, y1 = -y1, y1
        if edges[column] < 0 < edges[column + 1]:
            x0, x1 = -x1, x1
        nearest = 0.0 if x0 < 0 else x0
        cuts = [np.sqrt(1 - x * x) for x in (x1, nearest) if x < 1]
        stops = sorted({y0, y1, *(sign * c for c in cuts for sign in (-1, 1) if y0 < sign * c < y1)})
        for low, high in itertools.pairwise(stops):
            y = low + (high - low) * share
            top = np.sqrt(np.maximum((1 - y) * (1 + y), 0))
            middle = low + 0.3 * (high - low)  # not 0, where the circle touches the last texel
            if middle**2 + nearest**2 >= 1:
                continue
            clipped = middle**2 + x1**2 > 1
            left = np.maximum(x0, -top) if x0 < 0 else np.full_like(y, x0)
            right = top if clipped else np.full_like(y, x1)
            width = np.maximum(right - left, 0)
            x = left[:, None] + width[:, None] * share
            to_rim = top[:, None] - right[:, None] + width[:, None] * rest
            to_other = top[:, None] + x
            depth = np.sqrt(np.maximum(to_rim * to_other, 0)).ravel()
            x, y = x.ravel(), np.repeat(y, len(share))
            radius = np.sqrt(np.maximum(1 - depth**2, 0))
            if layout.name == "angular":
                from_back = np.pi * depth**2 / (1 + radius)
                cosine, scale = -np.cos(from_back), np.pi * np.sinc(radius)
                density = np.pi * scale
            else:
                cosine, scale, density = 2 * depth**2 - 1, 2 * depth, np.full_like(depth, 4)
            right_sign, up_sign = (-1 if edges[i] + edges[i + 1] < 0 else 1 for i in (column, row))
            directions = np.stack([cosine, -right_sign * x * scale, -up_sign * y * scale], axis=-1)
            weights = (high - low) * np.repeat(weight * width, len(share)) * np.tile(weight, len(share)) * density
            kept = weights > 0
            yield directions[kept], weights[kept], (row, column)


@pytest.mark.parametrize("side", [330, 331, 400])
def test_a_mirror_ball_is_the_same_however_much_of_it_is_taken_in_tiles_or_by_edges(side, monkeypatch):
    """Two ways that have nothing in common but the image: smaller tiles take what edges took."""
    pixels = np.random.default_rng(5).random((side, side, 3)).astype(np.float32)
    coarse = MirrorBallLayout(side).project(pixels, 40)
    monkeypatch.setattr(mirror_ball, "SMALLEST_TILE", 4)
    fine = MirrorBallLayout(side).project(pixels, 40)
    monkeypatch.setattr(mirror_ball, "FEWEST_TEXELS", side)
    by_edges = MirrorBallLayout(side).project(pixels, 40)
    monkeypatch.setattr(ball, "TEXELS", 7 * side)
    monkeypatch.setattr(ball, "WAVE_VALUES", 40 * side)
    in_parts = MirrorBallLayout(side).project(pixels, 40)
    for other in (fine, by_edges, in_parts):
        assert not np.array_equal(other, coarse)
        assert np.abs(other - coarse).max() < 1e-13 * np.abs(coarse).max()


def test_a_lone_texel_of_a_mirror_ball_is_as_exact_as_the_others():
    """Where tiles take it; by its edges, as at the rim, it would be 1e-12 off."""
    layout, place = MirrorBallLayout(600), (np.array([260]), np.array([420]))
    pixels = np.zeros((600, 600, 3), np.float32)
    pixels[place] = 1
    expected = layout.project_texels(np.ones((1, 3)), *place, 40)
    assert np.abs(layout.project(pixels, 40) - expected).max() < 2e-13 * np.abs(expected).max()


@pytest.mark.parametrize("layout", [AngularLayout(300), AngularLayout(257), MirrorBallLayout(300)], ids=str)
def test_few_bands_are_those_of_many_to_rounding(layout):
    """The turning of an edge about the middle needs points, too, however smooth the bands are."""
    pixels = np.random.default_rng(5).random((layout.side, layout.side, 3)).astype(np.float32)
    many = layout.project(pixels, 100)
    for n_bands in (1, 3, 9):
        assert np.abs(layout.project(pixels, n_bands) - many[: n_bands**2]).max() < 1e-14 * np.abs(many).max()


@pytest.mark.parametrize("side", [3, 10, 11, 100])
def test_the_area_of_a_texel_that_a_balls_rim_cuts_is_that_of_the_square_within_the_circle(side):
    """Four times the area between the circle and two sides: the antiderivative (x y + asin x) / 2, y = sqrt(1 - x^2)."""
    angles = MirrorBallLayout(side).solid_angles()
    edges = np.abs(2 * np.arange(side // 2, side + 1) / side - 1)[side % 2 :]
    first = side - len(edges) + 1

    def segment(x):
        return (x * np.sqrt(np.maximum(1 - x * x, 0)) + np.arcsin(np.minimum(x, 1))) / 2

    for row, (y0, y1) in enumerate(itertools.pairwise(edges)):
        for column, (x0, x1) in enumerate(itertools.pairwise(edges)):
            stop = min(x1, np.sqrt(1 - y0 * y0))
            full = min(max(x0, np.sqrt(max(1 - y1 * y1, 0))), stop)  # below here the circle is above the texel
            area = (
                max(full - x0, 0) * (y1 - y0) + segment(stop) - segment(full) - (stop - full) * y0 if stop > x0 else 0.0
            )
            assert_allclose(angles[first + row, first + column], 4 * area, rtol=0, atol=4e-15)


def test_texels_outside_the_disc_do_not_count():
    for layout in (AngularLayout(10), MirrorBallLayout(10), AngularLayout(11), MirrorBallLayout(11)):
        pixels = np.random.default_rng(6).random((layout.side, layout.side, 3)).astype(np.float32)
        other = pixels.copy()
        other[layout.solid_angles() == 0] = 1e6
        assert not np.array_equal(pixels, other)
        assert_array_equal(layout.project(pixels, 5), layout.project(other, 5))


def smooth(coefficients, directions):
    return evaluate_basis(directions, 4) @ coefficients


@pytest.mark.parametrize("index", range(8), ids=lambda i: type(all_layouts(1)[i]).__name__ + str(i))
def test_all_layouts_of_one_scene_agree_and_the_better_the_finer(index):
    """Texels hold the radiance at their centres: second order in their size, at least first at a ball's rim."""
    truth = np.random.default_rng(7).normal(size=(16, 3))
    errors, looks = [], []
    directions = random_directions(4000, seed=8)
    for size in (16, 32, 64):
        layout = all_layouts(size)[index]
        rows, columns = (a.ravel() for a in np.indices(shape(layout)))
        pixels = smooth(truth, layout.centres(rows, columns)).reshape(*shape(layout), 3).astype(np.float32)
        errors.append(np.abs(layout.project(pixels, 4) - truth).max())
        looks.append(np.abs(layout.sample(pixels, directions) - smooth(truth, directions)).mean())
    assert errors[0] < 0.05
    assert errors[2] < errors[0] / 8
    assert looks[2] < looks[0] / (5 if index == 7 else 10)


# --- the look-up


@named(EVERY)
def test_the_look_up_of_a_constant_is_constant_whatever_is_outside(layout):
    """Converters leave texels black whose centres are outside the disc, though a part of them is inside."""
    rows, columns = np.indices(shape(layout)).reshape(2, -1)
    shown = np.isfinite(direction_at(layout, rows + 0.5, columns + 0.5)[:, 0]).reshape(shape(layout))
    pixels = np.where(shown[:, :, None], np.float32(0.7), np.float32(-50)).repeat(3, axis=2)
    directions = np.concatenate([np.eye(3), -np.eye(3), random_directions(2000, seed=9)])
    assert_allclose(layout.sample(pixels, directions), 0.7, rtol=1e-6, atol=0)


@named([layout for layout in EVERY if layout not in SMALL])
def test_the_look_up_at_a_centre_is_the_texel(layout):
    pixels = np.random.default_rng(10).random((*shape(layout), 3)).astype(np.float32)
    rows, columns = (a.ravel() for a in np.indices(shape(layout)))
    seen = np.isfinite(direction_at(layout, rows + 0.5, columns + 0.5)[:, 0])
    rows, columns = rows[seen], columns[seen]
    assert_allclose(layout.sample(pixels, layout.centres(rows, columns)), pixels[rows, columns], rtol=0, atol=1e-6)


@named([*all_layouts(4), CubeLayout(OPENEXR, 1), CubeLayout(VERTICAL_CROSS, 2)])
def test_the_look_up_has_no_jumps(layout):
    """Along great circles across edges, corners and poles; the back of a disc is a line, which none of them touches."""
    pixels = np.random.default_rng(11).random((*shape(layout), 3)).astype(np.float32)
    angle = np.linspace(0, 2 * np.pi, 40001)[:, None]
    for first, second in (([1, 0.3, 0.2], [0.1, 1, -0.4]), ([1, 1, 1], [1, -1, 0.2]), ([0, 1, 0.01], [0, 0.02, 1])):
        a = np.array(first) / np.linalg.norm(first)
        b = np.cross(a, np.cross(second, a))
        circle = np.cos(angle) * a + np.sin(angle) * b / np.linalg.norm(b)
        steps = np.abs(np.diff(layout.sample(pixels, circle), axis=0)).max()
        assert steps < 0.02


# --- which layout it is


def image(height, width, seed=12):
    return np.random.default_rng(seed).random((height, width, 3)).astype(np.float32) + 0.1


def cross(rows, columns, empty, size=3, colour=0.0):
    pixels = image(rows * size, columns * size)
    for row, column in empty:
        pixels[row * size : (row + 1) * size, column * size : (column + 1) * size] = colour
    return pixels


def disc(side, colour=0.0, blur=0.0, noise=0.0):
    """What a converter makes: texels whose centres are outside are empty, or mixed up to `blur` texels on."""
    pixels = image(side, side)
    x = (2 * np.arange(side) + 1) / side - 1
    beyond = (np.hypot(x, x[:, None])[..., None] - 1) * side / 2
    share = np.clip(1 - beyond / blur, 0, 1) if blur else beyond <= 0
    empty = colour + noise * np.random.default_rng(13).uniform(-1, 1, pixels.shape)
    return (pixels * share + empty * (1 - share)).astype(np.float32)


def bleeding(pixels, texels, rows, columns, empty):
    """A cross whose empty cells take colour from their neighbours, `texels` deep."""
    size = len(pixels) // rows
    pixels = pixels.copy()
    for row, column in empty:
        cell = pixels[row * size : (row + 1) * size, column * size : (column + 1) * size]
        border = np.ones(cell.shape[:2], dtype=bool)
        border[texels : size - texels, texels : size - texels] = False
        cell[border] = 0.4
    return pixels


def night(height, width, noise, lamps):
    """Dark, noisy, with some lamps."""
    random = np.random.default_rng(14)
    pixels = (noise * random.random((height, width, 3))).astype(np.float32)
    pixels[random.integers(height // 3, height * 2 // 3, lamps), random.integers(0, width, lamps)] = 100
    return pixels


VERTICAL_EMPTY = [(0, 0), (0, 2), (2, 0), (2, 2), (3, 0), (3, 2)]
HORIZONTAL_EMPTY = [(0, 0), (0, 2), (0, 3), (2, 0), (2, 2), (2, 3)]


@pytest.mark.parametrize(
    ("pixels", "stated", "wanted", "expected", "note"),
    [
        (image(4, 8), None, "auto", LatLongLayout(4, 8), ""),
        (image(4, 8), "lat-long", "auto", LatLongLayout(4, 8), ""),
        (image(8, 8), "lat-long", "auto", LatLongLayout(8, 8), ""),
        (image(8, 8), None, "auto", LatLongLayout(8, 8), "8 x 8 is not 2:1"),
        (image(2, 3), None, "auto", LatLongLayout(2, 3), "3 x 2 is not 2:1"),
        (image(8, 8), None, "lat-long", LatLongLayout(8, 8), ""),
        (image(12, 2), None, "auto", CubeLayout(VERTICAL_STRIP, 2), "2 x 12 is taken as a cube, vertical strip"),
        (image(12, 2), "cube", "auto", CubeLayout(OPENEXR, 2), ""),
        (image(12, 2), "cube", "cube", CubeLayout(OPENEXR, 2), ""),
        (image(12, 2), "cube", "lat-long", LatLongLayout(12, 2), ""),
        (image(12, 2), None, "cube", CubeLayout(VERTICAL_STRIP, 2), ""),
        (image(2, 12), None, "auto", CubeLayout(HORIZONTAL_STRIP, 2), "12 x 2 is taken as a cube, horizontal strip"),
        (image(8, 16), "cube", "auto", LatLongLayout(8, 16), "16 x 8 is no cube"),
        (cross(4, 3, VERTICAL_EMPTY), None, "auto", CubeLayout(VERTICAL_CROSS, 3), "vertical cross"),
        (cross(4, 3, VERTICAL_EMPTY, colour=0.3), None, "auto", CubeLayout(VERTICAL_CROSS, 3), "vertical cross"),
        (cross(3, 4, HORIZONTAL_EMPTY), None, "auto", CubeLayout(HORIZONTAL_CROSS, 3), "horizontal cross"),
        (image(12, 9), None, "auto", LatLongLayout(12, 9), "not 2:1 and no cube cross"),
        (image(12, 9), None, "cube", CubeLayout(VERTICAL_CROSS, 3), ""),
        (cross(4, 3, VERTICAL_EMPTY[1:]), None, "auto", LatLongLayout(12, 9), "no cube cross"),
        (disc(16), None, "auto", AngularLayout(16), "--layout mirror-ball"),
        (disc(16, 0.5), None, "auto", AngularLayout(16), "--layout mirror-ball"),
        (disc(17), None, "mirror-ball", MirrorBallLayout(17), ""),
        (np.ones((16, 16, 3), np.float32), None, "auto", LatLongLayout(16, 16), "not 2:1"),
        (image(16, 16), None, "angular", AngularLayout(16), ""),
        (image(1, 1), None, "auto", LatLongLayout(1, 1), "1 x 1 is not 2:1"),
    ],
)
def test_layouts_are_recognised(pixels, stated, wanted, expected, note):
    layout, notes, _ = recognise(pixels, stated, wanted)
    assert layout == expected
    assert layout.name in LAYOUTS
    assert (note in " ".join(notes)) if note else notes == ()
    assert all("\n" not in line for line in notes)


@pytest.mark.parametrize(
    ("pixels", "lossy", "layout"),
    [
        (disc(64, blur=1), False, AngularLayout),
        (disc(64, 0.5, blur=2), False, AngularLayout),
        (disc(64, blur=6), False, LatLongLayout),
        (disc(64, 0.5, noise=0.003), False, AngularLayout),
        (disc(64, 0.5, noise=0.05), False, LatLongLayout),
        (disc(256, 0.2, blur=20, noise=0.003), True, AngularLayout),
        (disc(256, 0.2, blur=20, noise=0.003), False, LatLongLayout),
        (bleeding(cross(4, 3, VERTICAL_EMPTY, 32), 2, 4, 3, VERTICAL_EMPTY), False, CubeLayout),
        (bleeding(cross(4, 3, VERTICAL_EMPTY, 32), 3, 4, 3, VERTICAL_EMPTY), False, LatLongLayout),
        (bleeding(cross(3, 4, HORIZONTAL_EMPTY, 64), 16, 3, 4, HORIZONTAL_EMPTY), True, CubeLayout),
        (bleeding(cross(3, 4, HORIZONTAL_EMPTY, 64), 17, 3, 4, HORIZONTAL_EMPTY), True, LatLongLayout),
    ],
)
def test_what_shows_nothing_may_be_blurred_at_its_border_and_a_little_noisy(pixels, lossy, layout):
    assert isinstance(recognise(pixels, None, "auto", lossy)[0], layout)


@pytest.mark.parametrize("lossy", [False, True])
@pytest.mark.parametrize(
    "pixels",
    [
        *(image(side, side) for side in (2, 3, 16, 100)),
        image(96, 128),
        night(64, 64, 1e-3, 300),
        night(256, 256, 1e-3, 5000),
        night(256, 256, 1e-3, 20000),
        night(256, 256, 0, 300),
        night(96, 128, 1e-3, 300),
        night(128, 96, 0, 300),
        np.zeros((64, 64, 3), np.float32),
        np.zeros((96, 128, 3), np.float32),
    ],
)
def test_a_full_image_is_neither_disc_nor_cross_however_dark_and_noisy(pixels, lossy):
    layout, (note,), _ = recognise(pixels, None, "auto", lossy)
    assert layout == LatLongLayout(*pixels.shape[:2])
    if len(pixels) == pixels.shape[1]:
        assert "--layout angular or mirror-ball" in note


@pytest.mark.parametrize(
    ("size", "wanted", "message"),
    [
        ((8, 16), "cube", "16 x 8 is no cube: it must be a cross"),
        ((13, 2), "cube", "2 x 13 is no cube"),
        ((8, 16), "angular", "16 x 8 is not square"),
        ((9, 8), "mirror-ball", "8 x 9 is not square"),
        ((8, 16), "octahedral", "layout 'octahedral': it must be one of auto, lat-long, cube, angular, mirror-ball"),
    ],
)
def test_a_shape_that_the_layout_asked_for_has_not_is_refused(size, wanted, message):
    with pytest.raises(LightError, match=message) as caught:
        recognise(image(*size), None, wanted)
    assert "\n" not in str(caught.value)
