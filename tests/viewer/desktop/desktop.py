"""A virtual screen and a viewer on it, driven by real keys and a real mouse (Xvfb, xdotool)."""

from __future__ import annotations

import os
import queue
import shutil
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from PIL import Image

NEEDED = ("Xvfb", "xdotool")
PATIENCE = 120.0
"""Seconds to wait for anything. Only what never comes takes so long: the machines are slow and shared."""

AT_REST = 0.01
"""The share of a core that a window may take in which nothing happens."""


def missing_programs() -> list[str]:
    return [name for name in NEEDED if shutil.which(name) is None]


@contextmanager
def virtual_display(size: str = "1400x900x24") -> Iterator[str]:
    """Start Xvfb on a free number; yields the DISPLAY. No key repeats (-r), however long a busy machine holds it down."""
    reading, writing = os.pipe()
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(writing), "-screen", "0", size, "-nolisten", "tcp", "-r"],
        pass_fds=(writing,),
        stderr=subprocess.DEVNULL,
    )
    os.close(writing)
    try:
        with os.fdopen(reading) as pipe:
            number = pipe.readline().strip()
            assert number, f"Xvfb ended with {server.wait(PATIENCE)}"
            yield f":{number}"
    finally:
        server.terminate()
        server.wait(PATIENCE)


class Viewer:
    """A running viewer. Its --verbose lines say when a frame has been drawn, so nothing waits for a fixed time."""

    def __init__(self, display: str, folder: Path, *arguments: str) -> None:
        environment = {**os.environ, "DISPLAY": display, "PYTHONUNBUFFERED": "1"}
        environment.pop("WAYLAND_DISPLAY", None)
        environment.pop("XDG_SESSION_TYPE", None)
        self.display = display
        self.folder = folder
        self.process = subprocess.Popen(
            [sys.executable, "-m", "shviewer", "--verbose", *arguments],
            cwd=folder,
            env=environment,
            stderr=subprocess.PIPE,
            text=True,
        )
        self.lines: queue.Queue[str] = queue.Queue()
        self.seen: list[str] = []
        self.reader = threading.Thread(target=self._read, daemon=True)
        self.reader.start()
        try:
            self.wait_for("frame ")  # its figures are there, too
            self._find_window()
        except BaseException:
            self.close()
            raise

    def _find_window(self) -> None:
        self.window = self.xdotool("search", "--sync", "--pid", str(self.process.pid), "--name", "shviewer").split()[0]
        self.xdotool("windowfocus", self.window)

    def _read(self) -> None:
        assert self.process.stderr is not None
        with self.process.stderr:
            for line in self.process.stderr:
                self.lines.put(line.rstrip())

    def xdotool(self, *arguments: str) -> str:
        done = subprocess.run(
            ["xdotool", *arguments],
            env={**os.environ, "DISPLAY": self.display},
            capture_output=True,
            text=True,
            timeout=PATIENCE,
            check=True,
        )
        return done.stdout

    def wait_for(self, text: str) -> str:
        """The next line that contains `text`."""
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            try:
                line = self.lines.get(timeout=0.2)
            except queue.Empty:
                if self.process.poll() is not None:
                    break
                continue
            self.seen.append(line)
            if text in line:
                return line
        raise AssertionError(f"no line with {text!r} came; the viewer said: {self.seen}")

    def press(self, key: str, until: str) -> str:
        """Type one key and wait for the frame or message that it causes."""
        self.forget()
        self.xdotool("key", key)
        return self.wait_for(until)

    def forget(self) -> None:
        """Drop what has been said so far."""
        while not self.lines.empty():
            self.seen.append(self.lines.get())

    def mouse(self, *steps: str) -> None:
        """xdotool mouse commands relative to the window: "320,270", "down", "up", "scroll-up"."""
        for step in steps:
            if step == "down":
                self.xdotool("mousedown", "1")
            elif step == "up":
                self.xdotool("mouseup", "1")
            elif step == "scroll-up":
                self.xdotool("click", "4")
            else:
                x, y = step.split(",")
                self.xdotool("mousemove", "--window", self.window, x, y)

    def saved_picture(self) -> tuple[np.ndarray, str]:
        """Press P; the picture and its metadata."""
        line = self.press("p", "saved ")
        path = self.folder / line.rpartition("saved ")[2]
        with Image.open(path) as image:
            return np.asarray(image.convert("RGB")), str(image.text["shviewer"])

    def rest(self, seconds: float = 1.0) -> None:
        """Wait until the viewer has said nothing for so long and has taken less than AT_REST of a core meanwhile.

        Its own processor time is counted, so that neither a busy machine nor a late start fails a viewer that does rest.
        """
        end = time.monotonic() + PATIENCE
        looks = [(time.monotonic(), self.cpu_seconds())]
        while looks[-1][0] < end:
            time.sleep(0.1)
            if not self.lines.empty():
                self.forget()
                looks.clear()
            looks.append((time.monotonic(), self.cpu_seconds()))
            while looks[-1][0] - looks[0][0] >= seconds:
                start, before = looks.pop(0)
                if (looks[-1][1] - before) / (looks[-1][0] - start) < AT_REST:
                    return
        raise AssertionError(f"it did not come to rest; the viewer said: {self.seen[-5:]}")

    def cpu_seconds(self) -> float:
        """Processor time of all its threads. The kernel's tick in /proc/PID/stat is too coarse for a second."""
        clock = ~self.process.pid << 3 | 2  # clock_getcpuclockid of the C library
        return time.clock_gettime(clock)

    def close(self) -> int:
        if self.process.poll() is None:
            self.process.terminate()
        self.reader.join(PATIENCE)
        return self.process.wait(PATIENCE)


def screenshot(folder: Path, *arguments: str) -> np.ndarray:
    """The picture of the screenshot mode, in a process without a display."""
    environment = {key: value for key, value in os.environ.items() if key not in ("DISPLAY", "WAYLAND_DISPLAY")}
    out = folder / "reference.png"
    subprocess.run(
        [sys.executable, "-m", "shviewer", "screenshot", str(out), *arguments],
        env=environment,
        cwd=folder,
        check=True,
        timeout=PATIENCE,
    )
    with Image.open(out) as image:
        return np.asarray(image.convert("RGB"))


def output_of(display: str, script: str, *arguments: str) -> str:
    """What a Python script prints on a display; it must end well."""
    done = subprocess.run(
        [sys.executable, "-c", script, *arguments],
        env={**os.environ, "DISPLAY": display, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
        capture_output=True,
        text=True,
        check=False,
        timeout=PATIENCE,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout
