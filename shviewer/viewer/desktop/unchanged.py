"""When two frames show the same: keys that are equal as long as nothing has to be drawn anew."""

from __future__ import annotations

from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.overlay.pane_words import describe_evaluation
from shviewer.viewer.overlay.plots.plane import measured
from shviewer.viewer.picture import Picture
from shviewer.viewer.state import changed
from shviewer.viewer.view import LOOKED, View


def panes_key(picture: Picture, composition: Composition, exact: bool) -> object:
    """A key of the panes, but for what is written over them. exact: whether surfaces have all their triangles."""
    view = picture.state.view
    seen = picture.world_from_view.tobytes(), picture.light_from_world.tobytes(), picture.exposure_stops
    drawn = picture.drawn, picture.beside, picture.error_scale, view.tone, view.marks, exact
    return picture.original, picture.compared, picture.suns, drawn, seen, composition


def overlay_key(picture: Picture, composition: Composition) -> object:
    """A key of all text. Turning changes none, unless the help shows the camera.

    Zooming may change it, since text gives way to spheres; the time-error plane changes with every measurement, and figures
    come after the picture.
    """
    state = picture.state
    if not state.view.help_visible:
        state = changed(state, **{name: getattr(View, name) for name in LOOKED if name != "map_centre"})
    known = measured(picture) if state.view.sheet == "plane" else ()
    figures = picture.figures, picture.needs, picture.verdict, picture.error_scale
    return state, figures, known, describe_evaluation(picture, timing=True), composition
