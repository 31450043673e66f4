"""The triangles of a surface: closed, facing outward, as near as asked for, and bounded."""

from __future__ import annotations

import numpy as np
import pytest
from helpers import lat_long_grid

from shviewer.harmonics.basis import evaluate_basis, index
from shviewer.lights.environment import EnvironmentLight
from shviewer.viewer.gl.surface_mesh import MAX_TRIANGLES, Mesh, gradient, grid_directions, surface_mesh
from shviewer.viewer.surface import Surface, basis_surface, sample_basis, sample_light, surface


def closed(mesh: Mesh) -> bool:
    """Each side belongs to two triangles that run along it in opposite ways, points on a pole or at the origin being one."""
    positions = np.abs(mesh.vertices[:, :1]) * mesh.vertices[:, 1:4]
    _, same = np.unique(np.round(positions, 6), axis=0, return_inverse=True)
    corners = same.ravel()[mesh.triangles.astype(np.int64)]
    flat = (corners == np.roll(corners, 1, axis=1)).any(axis=1)
    sides = np.concatenate([corners[~flat][:, [i, (i + 1) % 3]] for i in range(3)])
    forward, count = np.unique(sides, axis=0, return_counts=True)
    backward = np.unique(sides[:, ::-1], axis=0)
    return bool((count == 1).all() and np.array_equal(forward, backward))


def bumpy(rows: int = 129) -> np.ndarray:
    values = 3 + np.abs(sample_basis(7, 3, rows)) + 0.1 * np.random.default_rng(0).random((rows, 2 * rows - 2))
    values[[0, -1]] = values[[0, -1], :1]
    return (values / values.max()).astype(np.float32)


@pytest.mark.parametrize("tolerance", [0.1, 0.02, 0.005, 0.0])
def test_the_surface_has_no_cracks(tolerance: float) -> None:
    mesh = surface_mesh(bumpy(), tolerance)
    assert len(mesh.triangles) > 100
    assert closed(mesh)


@pytest.mark.parametrize(("l", "m"), [(0, 0), (1, 0), (3, -2), (6, 6)])
def test_triangles_enclose_the_volume_of_the_body_and_face_outward(l: int, m: int) -> None:
    """The integral of |f|^3 / 3 over the sphere, by quadrature; triangles cut off up to the tolerance."""
    shown = basis_surface(l, m, 257)
    mesh = surface_mesh(shown.values, 1e-3)
    a, b, c = (np.abs(mesh.vertices[i, :1]) * mesh.vertices[i, 1:4].astype(float) for i in mesh.triangles.T.astype(int))
    volume = np.einsum("ij,ij->", a, np.cross(b, c)) / 6
    z, weights = np.polynomial.legendre.leggauss(200)
    phi = 2 * np.pi * np.arange(400) / 400
    ring = np.sqrt(1 - z * z)[:, None]
    directions = np.stack([ring * np.cos(phi), ring * np.sin(phi), np.broadcast_to(z[:, None], (200, 400))], axis=-1)
    function = evaluate_basis(directions, l + 1)[..., index(l, m)]
    wanted = (
        weights @ (np.abs(function / np.abs(sample_basis(l, m, 257)).max()) ** 3).sum(axis=1) * (2 * np.pi / 400) / 3
    )
    assert volume == pytest.approx(wanted, rel=0.02)


def test_no_triangle_has_both_signs() -> None:
    mesh = surface_mesh(basis_surface(5, 2, 257).values, 1e-3)
    signs = np.sign(mesh.vertices[mesh.triangles, 0])
    assert not ((signs.max(axis=1) > 0) & (signs.min(axis=1) < 0)).any()


def test_triangles_are_bounded_and_a_smooth_surface_needs_few() -> None:
    noise = np.random.default_rng(0).random((513, 1024)).astype(np.float32)
    assert len(surface_mesh(noise, 1e-4).triangles) <= MAX_TRIANGLES
    assert len(surface_mesh(basis_surface(1, 0, 513).values, 1e-3).triangles) < 40_000
    assert len(surface_mesh(np.zeros((129, 256), np.float32), 1e-3).triangles) == 4


def test_a_finer_tolerance_is_nearer() -> None:
    counts = [len(surface_mesh(basis_surface(3, 2, 257).values, tolerance).triangles) for tolerance in (1e-2, 1e-3)]
    assert counts[0] < counts[1] / 4


@pytest.mark.parametrize("shape", [(128, 256), (129, 255), (100, 198), (2, 2)])
def test_a_grid_that_cannot_be_halved_is_refused(shape: tuple[int, int]) -> None:
    with pytest.raises(ValueError, match=r"2\^k \+ 1 rows"):
        surface_mesh(np.ones(shape, np.float32), 0.1)


def test_gradients_are_right_everywhere_and_at_the_poles() -> None:
    """The gradient of the linear a.u is a - (a.u) u; central differences are off by h^2/6, at 129 rows 1e-4."""
    a = np.array([0.5, -0.7, 0.3])
    directions = lat_long_grid(129)
    value = directions @ a
    wanted = a - value[..., None] * directions
    assert np.abs(np.moveaxis(gradient(value.astype(np.float32)), 0, -1) - wanted).max() < 5e-4


def test_at_a_jump_the_rim_keeps_the_slope_of_what_it_ends() -> None:
    values = np.where(np.arange(129)[:, None] <= 64, 1.0, 0.0) * np.ones(256)
    slope = gradient(values.astype(np.float32))
    assert np.abs(slope[:, 64]).max() == 0
    assert np.abs(slope[:, 65]).max() > 30


def test_grid_directions_are_those_of_lat_long_images() -> None:
    assert np.abs(np.moveaxis(grid_directions(65), 0, -1) - lat_long_grid(65)).max() < 1e-6


def test_an_image_with_bright_texels_gives_finite_triangles() -> None:
    pixels = np.random.default_rng(0).random((32, 64, 3)).astype(np.float32)
    pixels[10, 20] = 1e6
    values = sample_light(EnvironmentLight(pixels), 129)
    shown = surface(values, 4.0, root=True)
    assert isinstance(shown, Surface)
    assert shown.clipped
    assert np.isfinite(surface_mesh(shown.values, 1e-3).vertices).all()
