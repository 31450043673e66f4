"""Cost and edges of the lobe view at 1280 x 640: the product's mesh against marching along rays in the fragment shader.

python tests/benchmarks/lobes.py

Two spheres of radius 222 px show the same function: Y(n-1, n/2). The silhouette error is that of the share of a pixel which
is covered, against 8 x 8 rays per pixel in float64, over the pixels that the edge passes through: mean and worst.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import moderngl
import numpy as np
from measure import cpu_milliseconds, machine, medians, wall_milliseconds

sys.path.append(str(Path(__file__).resolve().parents[1]))  # tests/
from viewer.gl.silhouettes import coverage, outline

from shviewer.harmonics.basis import Array, evaluate_basis, index
from shviewer.viewer.camera import world_from_view
from shviewer.viewer.composing.composition import compose
from shviewer.viewer.gl.shader_source import load_shader
from shviewer.viewer.gl.surface_mesh import surface_mesh
from shviewer.viewer.gl.surface_renderer import OVERSAMPLING, TILE, SurfaceRenderer
from shviewer.viewer.screenshot import headless_renderer
from shviewer.viewer.surface import basis_surface, rows_for, sample_basis

BANDS = (4, 8, 16)
VIEW = world_from_view(30.0, 20.0)
COMPOSITION = compose(1280, 640)
SPHERE = COMPOSITION.spheres[0]

MARCHING = """#version 330 core
#include "lat_long.glsl"
uniform sampler2D radiance_map;
uniform vec2 centre;
uniform float radius;
uniform mat3 light_from_view;
uniform int steps;
out vec4 colour;

// Even steps of the direction, not of the depth: along a ray it turns by half a circle at most.
float hit(vec2 p) {
    float distance_ = length(p), covered = 0.0;
    float half_turn = distance_ < 1.0 ? acos(distance_) : 0.0;
    for (int i = 0; i <= steps && covered == 0.0; ++i) {
        float angle = half_turn * (1.0 - 2.0 * float(i) / float(steps));
        vec3 direction = light_from_view * vec3(cos(angle) * p / distance_, sin(angle));
        vec2 size = vec2(textureSize(radiance_map, 0));
        float value = textureLod(radiance_map, (map_position(direction, size, true).yx + 0.5) / size, 0.0).r;
        covered = abs(value) * cos(angle) >= distance_ ? 1.0 : 0.0;
    }
    return covered;
}

void main() {
    float sum = 0.0;
    for (int i = 0; i < 4; ++i) sum += hit((gl_FragCoord.xy + 0.5 * vec2(i & 1, i >> 1) - 0.25 - centre) / radius);
    colour = vec4(0.25 * sum);
}
"""
"""Only the silhouette, from a map of the values and four rays a pixel: no normals, no colour, no inner edges."""


class Marching:
    def __init__(self, context: moderngl.Context, n_bands: int, values: Array) -> None:
        sources = (load_shader("screen.vert"), load_shader("marching", {"marching": MARCHING}))
        self.program = context.program(vertex_shader=sources[0].text, fragment_shader=sources[1].text)
        self.quad = context.vertex_array(self.program, [])
        rows, columns = values.shape
        self.texture = context.texture((columns, rows), 1, values, dtype="f4")
        self.texture.repeat_y = False
        centre = (SPHERE.x, COMPOSITION.height - SPHERE.y)
        for name, value in {
            "centre": centre,
            "radius": SPHERE.radius,
            "steps": 8 * n_bands,
        }.items():
            self.program[name].value = value
        self.program["light_from_view"].write(VIEW.T.astype("f4").tobytes())

    def draw(self, target: moderngl.Framebuffer) -> None:
        target.use()
        side = int(2 * SPHERE.radius + 2)
        for sphere in COMPOSITION.spheres:
            target.viewport = (
                int(sphere.x - sphere.radius - 1),
                int(COMPOSITION.height - sphere.y - sphere.radius - 1),
                side,
                side,
            )
            self.program["centre"].value = (sphere.x, COMPOSITION.height - sphere.y)
            self.texture.use(0)
            self.quad.render(moderngl.TRIANGLES, vertices=3)
        target.viewport = (0, 0, COMPOSITION.width, COMPOSITION.height)

    def release(self) -> None:
        for part in (self.texture, self.quad, self.program):
            part.release()


def silhouette_error(shown: Array, true: Array) -> str:
    edge = (true > 0) & (true < 1)
    off = np.abs(shown - true)[edge]
    return f"mean {off.mean():.4f}, 99 % under {np.quantile(off, 0.99):.3f}, worst {off.max():.3f}"


def mesh_coverage(surfaces: SurfaceRenderer, height: int) -> Array:
    """The pixels of the sphere drawn last, in the frame's pixels, top row first."""
    tones = np.frombuffer(surfaces.spare[0][0].read(components=1, dtype="f2"), dtype=np.float16)
    pixels = (tones.reshape(TILE, OVERSAMPLING, TILE, OVERSAMPLING) != 0).mean(axis=(1, 3))
    frame = np.zeros((height, COMPOSITION.width))
    left, low = int(np.floor(SPHERE.x - SPHERE.radius - 1)), int(np.floor(height - SPHERE.y - SPHERE.radius - 1))
    frame[low : low + TILE, left : left + TILE] = pixels[: height - low]
    return frame[::-1]


def compare(context: moderngl.Context, surfaces: SurfaceRenderer, target: moderngl.Framebuffer, n_bands: int) -> None:
    l, m, height = n_bands - 1, n_bands // 2, COMPOSITION.height
    rows = rows_for(n_bands, SPHERE.radius)
    surface, peak = basis_surface(l, m, rows), float(np.abs(sample_basis(l, m, rows)).max())
    marching = Marching(context, n_bands, surface.values)
    rim = outline(lambda d: evaluate_basis(d, n_bands)[:, index(l, m)] / peak, VIEW)
    true = coverage(rim, SPHERE, COMPOSITION.width, height)

    def mesh() -> None:
        target.use()
        target.clear()
        for sphere in COMPOSITION.spheres:
            surfaces.draw(target, sphere, height, surface, VIEW)
        context.finish()

    def march() -> None:
        target.clear()
        marching.draw(target)
        context.finish()

    work: dict[str, Callable[[], object]] = {"mesh": mesh, "marching": march}
    cpu, wall = (medians(work, 5, clock) for clock in (cpu_milliseconds, wall_milliseconds))
    march()
    marched = np.frombuffer(target.read(components=1), dtype=np.uint8).reshape(height, -1)[::-1] / 255
    surfaces.draw(target, SPHERE, height, surface, VIEW)
    half = slice(0, COMPOSITION.width // 2)
    for name, shown in {"mesh": mesh_coverage(surfaces, height), "marching": marched}.items():
        error = silhouette_error(shown[:, half], true[:, half])
        print(f"{n_bands:>3} bands, {name:<9}{cpu[name]:8.1f} cpu-ms{wall[name]:8.1f} ms   off by {error}")
    tolerance = 0.25 / SPHERE.radius
    made = {"values": lambda: basis_surface(l, m, rows), "mesh": lambda: surface_mesh(surface.values, tolerance)}
    once, triangles = medians(made, 5), len(surface_mesh(surface.values, tolerance).triangles)
    print(f"    once: {rows} rows {once['values']:.0f} ms, {triangles} triangles {once['mesh']:.0f} ms")
    marching.release()


def main() -> None:
    print(machine())
    with headless_renderer() as renderer:
        context = renderer.context
        print(renderer.version)
        surfaces = SurfaceRenderer(context)
        texture = context.texture((COMPOSITION.width, COMPOSITION.height), 4)
        target = context.framebuffer([texture])
        for n_bands in BANDS:
            compare(context, surfaces, target, n_bands)
        renderer.rest.use()
        for part in (target, texture, surfaces):
            part.release()


if __name__ == "__main__":
    main()
