"""The hand on the whole sphere: G, dragging, turning the light, zooming, and what does not go with it."""

from __future__ import annotations

import json

import numpy as np
import pytest
from helpers import frame_of, picture_of

from shviewer.errors import UsageError
from shviewer.viewer.animation.animation import turntable
from shviewer.viewer.composing.panes import WholeSphere
from shviewer.viewer.control.keys import press
from shviewer.viewer.control.placing import face, orbit, rotate_light, zoom
from shviewer.viewer.overlay.directions.probe import direction_at, probe, probe_layers
from shviewer.viewer.picture import Picture, prepare
from shviewer.viewer.saving.stamp import metadata
from shviewer.viewer.saving.stamp_reading import state_of_stamp
from shviewer.viewer.state import State, changed, state_of

MAPS = state_of("venice_sunset", n_bands=4, whole_sphere=True)


def seen(state: State, x: float, y: float) -> np.ndarray:
    """The direction in the world at a pixel of the frame."""
    picture = prepare(state)
    found = direction_at(picture, frame_of(picture), x, y)
    assert found is not None
    return found


def first_map(picture: Picture) -> WholeSphere:
    return frame_of(picture).maps[0]


def test_g_shows_maps_and_then_spheres_and_is_left_by_surfaces() -> None:
    maps = press(state_of(), "G")
    assert isinstance(maps, State)
    assert maps.view.whole_sphere
    assert press(maps, "G") == state_of()
    for key in ("V", "Tab"):
        surfaces = press(maps, key)
        assert isinstance(surfaces, State)
        surfaces.check()
        assert (surfaces.view.whole_sphere, surfaces.view.lobe_view) == (False, True)
        back = press(surfaces, "G")
        assert isinstance(back, State)
        assert (back.view.whole_sphere, back.view.lobe_view, back.view.basis) == (True, False, None)


def test_maps_and_surfaces_at_once_are_refused() -> None:
    with pytest.raises(UsageError, match="surfaces have no map; leave one out"):
        state_of(whole_sphere=True, lobe_view=True).check()


@pytest.mark.parametrize("start", [0.0, 170.0])
def test_a_map_follows_the_mouse_round_the_seam(start: float) -> None:
    """Dragged by 100 pixels, what was under the mouse is still under it."""
    state = changed(MAPS, map_centre=(start, 0.0), zoom=2.0)
    pane = first_map(prepare(state))
    before = seen(state, 200.5, 200.5)
    moved = orbit(state, 100 / (pane.width / (2 * np.pi)), 30 / (pane.width / (2 * np.pi)))
    np.testing.assert_allclose(seen(moved, 300.5, 170.5), before, atol=1e-12)
    assert -180 <= moved.view.map_centre[0] < 180


def test_a_map_is_not_dragged_beyond_its_poles_and_not_made_smaller_than_it_is() -> None:
    assert orbit(MAPS, 0.0, -1.0).view.map_centre == (0.0, 0.0)
    near = changed(MAPS, zoom=4.0)
    assert orbit(near, 0.0, -9.0).view.map_centre == (0.0, 67.5)
    assert zoom(near, -100.0).view.zoom == 1.0
    assert zoom(orbit(near, 0.0, -9.0), -100.0).view.map_centre == (0.0, 0.0)


def test_turning_the_light_moves_the_middle_of_a_map_with_the_mouse() -> None:
    """Seen from inside, right is the other way; second order is left out (0.01 squared)."""
    picture = prepare(MAPS)
    pane = first_map(picture)
    x, y = (pane.clip.left + pane.clip.right) / 2, (pane.clip.top + pane.clip.bottom) / 2
    in_light = picture.light_from_world @ seen(MAPS, x, y)
    turned = rotate_light(MAPS, 0.01, 0.005)
    after = prepare(turned)
    place = first_map(after).place(after.light_from_world.T @ in_light, after.world_from_view)
    assert place[:2] == pytest.approx(
        (x + 0.01 * pane.width / (2 * np.pi), y - 0.005 * pane.width / (2 * np.pi)), abs=0.02
    )


def test_facing_a_direction_brings_it_into_the_middle_as_far_as_the_map_reaches() -> None:
    direction = np.array([-0.8, 0.0, 0.6])
    assert face(MAPS, direction).view.map_centre == pytest.approx((-180.0, 0.0))
    assert face(changed(MAPS, zoom=4.0), direction).view.map_centre == pytest.approx(
        (-180.0, np.degrees(np.arcsin(0.6)))
    )
    assert press(face(MAPS, direction), "F") == MAPS


def test_the_probe_reads_the_same_in_the_same_place_of_every_map_and_marks_it_in_the_others() -> None:
    picture = picture_of("venice_sunset", n_bands=9, error="signed", whole_sphere=True)
    composition = frame_of(picture)
    first, second = composition.maps[:2]
    x, y = first.clip.left + 100.5, first.clip.top + 80.5
    readings = [probe(picture, composition, x + dx, y) for dx in (0.0, second.clip.left - first.clip.left)]
    assert readings[0] is not None
    assert readings[1] is not None
    np.testing.assert_allclose(readings[0].reconstruction, readings[1].reconstruction, atol=1e-12)
    crosses = probe_layers(readings[0], picture, composition, x, y)[:-1]
    assert len(crosses) == 2
    middle = crosses[0].left + crosses[0].image.shape[1] // 2, crosses[0].top + crosses[0].image.shape[0] // 2
    assert middle == (round(second.clip.left + 100), round(second.clip.top + 80))
    assert probe(picture, composition, 3.0, 3.0) is None


def test_the_stamp_of_maps_says_where_they_are_and_gives_the_state_back() -> None:
    state = changed(MAPS, map_centre=(40.0, 20.0), zoom=3.0)
    picture = prepare(state)
    text = metadata(picture, frame_of(picture), "none")
    said = json.loads(text)
    assert said["spheres"] == {}
    pane = first_map(picture)
    assert said["maps"]["original"] == {"zero": [pane.x, pane.y], "width": pane.width, "clip": list(pane.clip)}
    assert state_of_stamp(text) == state


def test_a_turntable_of_maps_scrolls_them_once_round() -> None:
    states = turntable(MAPS, 4).states
    assert [state.view.map_centre[0] for state in states] == [0, 90, 180, 270]
    assert len({prepare(state).world_from_view.tobytes() for state in states}) == 1
