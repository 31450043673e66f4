"""Actions that place things before the eye: camera, light, zoom and where the spheres or maps stand."""

from __future__ import annotations

import math

from shviewer.harmonics.basis import Array
from shviewer.viewer.camera import Quaternion, facing, turn_of, turned_by_drag
from shviewer.viewer.state import State, changed
from shviewer.viewer.view import ZOOM_RANGE, View


def orbit(state: State, right: float, up: float) -> State:
    """Turn all spheres as if their front was dragged, in radii of a sphere; or move the maps, in radians of them.

    The state says where the camera is.
    """
    if state.view.whole_sphere:
        azimuth, elevation = state.view.map_centre
        return _centred(state, azimuth + right * 180 / math.pi, elevation - up * 180 / math.pi)
    assert state.view.camera is not None
    azimuth, elevation = state.view.camera
    azimuth = (azimuth - right * 180 / math.pi) % 360
    elevation = min(max(elevation - up * 180 / math.pi, -90.0), 90.0)
    return changed(state, camera=(azimuth, elevation))


def face(state: State, direction: Array) -> State:
    """Turn all spheres so that a direction in the world (3,) is in front, or move the maps so that it is in the middle."""
    if state.view.whole_sphere:
        return _centred(state, *facing(direction))
    return changed(state, camera=facing(direction), pan=View.pan)


def face_light(state: State) -> State:
    """See the light from its front, as at the start."""
    return changed(state, camera=None, zoom=View.zoom, pan=View.pan, map_centre=View.map_centre)


def _centred(state: State, azimuth: float, elevation: float) -> State:
    """The state with that in the middle of the maps, as far as they reach."""
    most = 90 - 90 / max(state.view.zoom, 1.0)
    return changed(state, map_centre=((azimuth + 180) % 360 - 180, min(max(elevation, -most), most)))


def rotate_light(state: State, right: float, up: float) -> State:
    """Turn the light as if the front of a sphere, or the middle of a map, was dragged; right and up as in `orbit`."""
    view = state.view
    if view.whole_sphere:  # which is seen from inside
        return stand(state, turned_by_drag(view.light_rotation, view.map_centre, -right, up))
    assert view.camera is not None
    return stand(state, turned_by_drag(view.light_rotation, view.camera, right, up))


def stand(state: State, rotation: Quaternion) -> State:
    """Turn the light to where `rotation` has it, and project it there if it is projected as it stands."""
    turn = None if state.recipe.turn is None else turn_of(rotation)
    return changed(state, light_rotation=rotation, turn=turn)


def zoom(state: State, steps: float) -> State:
    low, high = ZOOM_RANGE
    low = 1.0 if state.view.whole_sphere else low  # a map has no more to show
    wanted = min(max(state.view.zoom * 1.1**steps, low), high)
    zoomed = changed(state, zoom=wanted, pan=_within(state.view.pan, wanted))
    return _centred(zoomed, *state.view.map_centre)


def zoom_about(state: State, steps: float, right: float, up: float) -> State:
    """Zoom so that a point stays where it is: right and up from the middle of its sphere, in radii at zoom 1.

    Going back, the middle comes nearer to its place again, and at zoom 1 it is there.
    """
    zoomed = zoom(state, steps)
    grown = zoomed.view.zoom / state.view.zoom - 1
    x, y = state.view.pan
    most = zoomed.view.zoom if steps > 0 else max(zoomed.view.zoom - 1, 0.0)
    return changed(zoomed, pan=_within((x - right * grown, y - up * grown), most))


def zoom_map_about(state: State, steps: float, azimuth: float, elevation: float) -> State:
    """Zoom maps so that a direction stays where it is: so many degrees from the one in their middle."""
    zoomed = zoom(state, steps)
    nearer = 1 - state.view.zoom / zoomed.view.zoom
    middle = state.view.map_centre
    return _centred(zoomed, middle[0] + azimuth * nearer, middle[1] + elevation * nearer)


def pan(state: State, right: float, up: float) -> State:
    """Move the spheres, in radii at zoom 1, as far as something of them is in sight."""
    x, y = state.view.pan
    return changed(state, pan=_within((x + right, y + up), state.view.zoom))


def _within(place: tuple[float, float], radius: float) -> tuple[float, float]:
    """The place, or the nearest to it that is no further than `radius` from the middle."""
    far = math.hypot(*place)
    return place if far <= radius else (place[0] * radius / far, place[1] * radius / far)
