"""The mouse over a frame: what clicks, drags and the wheel make of a state. Knows no window.

Places are pixels of the frame from the top left, at the middle of a pixel.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.composing.panes import Box, Sphere
from shviewer.viewer.control.actions import toggle_band, turn_page
from shviewer.viewer.control.placing import face, orbit, pan, rotate_light, zoom, zoom_about, zoom_map_about
from shviewer.viewer.overlay.directions.probe import direction_at
from shviewer.viewer.picture import Picture
from shviewer.viewer.state import State, changed

LEFT, RIGHT, MIDDLE = range(3)
"""The buttons, in GLFW's numbers."""

CLICK_PIXELS = 4.0
"""A press is a click if the mouse moves less than this before its release."""

DOUBLE_SECONDS = 0.4
"""Two clicks on a point are one double click if they are no further apart."""

Point = tuple[float, float]
NEVER = (-math.inf, (0.0, 0.0))


class Mouse:
    """Where the mouse is, and which of its buttons is held down: the first of several."""

    def __init__(self) -> None:
        self.at: Point = (0.0, 0.0)
        self.held: int | None = None
        self.dragged = False
        """Whether it has moved since the button was pressed."""
        self._from: Point = self.at
        self._last: Point = self.at
        self._clicked = NEVER

    def press(self, button: int) -> None:
        if self.held is None and button in (LEFT, RIGHT, MIDDLE):
            self.held, self.dragged = button, False
            self._from = self._last = self.at

    def release(self, button: int) -> bool:
        """Let a button go; return whether that was a click of the left one."""
        if button != self.held:
            return False
        self.held = None
        clicked, self.dragged = button == LEFT and not self.dragged, False
        return clicked

    def click(
        self, picture: Picture, composition: Composition, bars: Mapping[int, Box], seconds: float
    ) -> State | None:
        """The state after a click: a band muted or not, or at the second on a point of a pane, that point in front."""
        (last, place), state = self._clicked, picture.state
        self._clicked = seconds, self._from
        if state.view.help_visible:
            return None
        for band, box in bars.items():
            if box.contains(*self._from):
                return toggle_band(changed(state, message=""), band)
        if seconds - last > DOUBLE_SECONDS or _apart(place, self._from) >= CLICK_PIXELS:
            return None
        self._clicked = NEVER
        direction = direction_at(picture, composition, *self._from)
        return None if direction is None else face(state, direction)

    def move(self, at: Point, placed: State, composition: Composition, *, shift: bool = False) -> State | None:
        """The state after a move, if a button is held down. placed: the state with its camera."""
        self.at = at
        if self.held is None or (not self.dragged and _apart(at, self._from) < CLICK_PIXELS):
            return None
        self.dragged = True
        right, up = at[0] - self._last[0], self._last[1] - at[1]
        self._last = at
        pane = composition.panes[0]
        radius = pane.radius if isinstance(pane, Sphere) else pane.width / math.tau
        if self.held == MIDDLE and isinstance(pane, Sphere):
            home = radius / placed.view.zoom
            return pan(placed, right / home, up / home)
        turn = rotate_light if shift or self.held == RIGHT else orbit
        return turn(placed, right / radius, up / radius)

    def scroll(self, steps: float, state: State, composition: Composition) -> State:
        """The state after the wheel: what is under the mouse stays there; beside the panes, the middle of the spheres does.

        Under the help it turns the pages.
        """
        if state.view.help_visible:
            return turn_page(state, -round(steps))
        over = next((pane for pane in composition.panes if pane.clip.contains(*self.at)), None)
        if over is None:
            return zoom(state, steps)
        if not isinstance(over, Sphere):
            left, top, right, bottom = over.clip
            across, along = ((left + right) / 2 - self.at[0], (top + bottom) / 2 - self.at[1])
            return zoom_map_about(state, steps, across * 360 / over.width, along * 360 / over.width)
        home = over.radius / state.view.zoom
        return zoom_about(state, steps, (self.at[0] - over.x) / home, (over.y - self.at[1]) / home)


def _apart(one: Point, other: Point) -> float:
    return max(abs(one[0] - other[0]), abs(one[1] - other[1]))
