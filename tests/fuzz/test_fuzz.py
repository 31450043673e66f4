"""Whatever the bytes: the reader gives a sound image or one line, soon, in little memory, and the process lives on."""

from __future__ import annotations

import multiprocessing
import os
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import harness
import numpy as np
import promise
import pytest
from harness import FOUND, examine, save
from inputs import Mutations, Truncations, verdict
from promise import LIMITS, BrokenPromise, Witness
from seeds import seeds, stb_seeds

from shviewer.errors import LightError
from shviewer.lights.environment import EnvironmentLight
from shviewer.lights.images.decoded import Decoded
from shviewer.limits import Limits

SEED = 0

# What the reader does not need may be missing: small levels, parts that are not the light, the place of a second image.
ACCEPTED_CUT_SHORT = {"mip-mapped.exr", "parts.exr", "mip-mapped-cube.dds", "codes.tif", "float.tif", "turned.tif"}
FOLLOWED = {"trailer.jpg", "ultra-hdr-xmp.jpg", "ultra-hdr-iso.jpg"}  # by what is no part of the picture


def assert_none_broken(findings, inputs, folder):
    """Saves what broke the promise first, so that it can be looked at."""
    lines = [
        f"number {number}, of {name}: {why}; saved as {save(inputs[number][1], str(number), name, folder)}"
        for number, name, why in findings.broken
    ]
    assert not lines, "\n".join(lines)


def test_twenty_thousand_mutations_are_read_or_refused(tmp_path):
    inputs = Mutations(SEED)
    findings = examine(inputs)
    assert_none_broken(findings, inputs, tmp_path)
    assert findings.count == 20_000
    share = findings.accepted.total() / findings.count
    assert 0.1 < share < 0.5, "mutations that are all refused, or all accepted, test little"
    for name in seeds():
        assert findings.accepted[name], name
        assert findings.refused[name], name


def test_every_truncation_of_every_seed_is_refused(tmp_path):
    inputs = Truncations()
    findings = examine(inputs)
    assert_none_broken(findings, inputs, tmp_path)
    accepted = {name: count for name, count in findings.accepted.items() if name not in ACCEPTED_CUT_SHORT | FOLLOWED}
    assert all(name.endswith(".jpg") and count <= 2 for name, count in accepted.items()), "but for the end marker"
    for name, data in seeds().items():
        if len(data) <= 2048:
            assert findings.accepted[name] + findings.refused[name] == len(data), name


@pytest.mark.parametrize("limits", [Limits(), Limits(side=2**40, texels=2**60)], ids=["default", "raised"])
@pytest.mark.parametrize("name", stb_seeds())
def test_files_that_broke_another_reader_are_refused(name, limits):
    assert verdict(Witness(limits), name, stb_seeds()[name]) is False


def test_what_once_broke_the_promise_does_so_no_more():
    verdicts = {path.name: verdict(Witness(), path.name, path.read_bytes()) for path in sorted(FOUND.glob("*.*"))}
    assert not {name: why for name, why in verdicts.items() if isinstance(why, str)}


# ------------------------------------------------------------------------------------------------- the seeds themselves


def test_every_seed_is_a_sound_file_of_the_size_it_declares():
    assert {name: verdict(Witness(), name, data) for name, data in seeds().items()} == dict.fromkeys(seeds(), True)


def test_the_seeds_are_of_every_kind_and_layout_and_small():
    kinds = [Path(name).suffix for name in seeds()]
    ours = {".hdr", ".exr", ".png", ".jpg", ".pfm", ".dds", ".npy"}
    assert ours <= set(kinds) <= {*ours, ".tif", ".psd", ".bmp", ".webp"}
    assert all(kinds.count(kind) >= 3 for kind in kinds)
    layouts = {
        "lat-long",
        "vertical-cross",
        "horizontal-cross",
        "strip",
        "vertical-strip",
        "angular",
        "mirror-ball",
        "cube",
    }
    assert layouts <= {Path(name).stem for name in seeds()}
    assert len(seeds()) >= 12
    assert max(map(len, seeds().values())) < 4096


def test_a_mutation_is_a_function_of_seed_and_number():
    assert [Mutations(3)[number] for number in range(50)] == [Mutations(3, 7)[number] for number in range(50)]
    assert [Mutations(3)[number] for number in range(50)] != [Mutations(4)[number] for number in range(50)]
    unchanged = sum(data == seeds()[name] for name, data in map(Mutations(0).__getitem__, range(2000)))
    assert unchanged < 100


# ------------------------------------------------------------------------------- the harness sees what it is there for


@pytest.fixture
def judged(monkeypatch):
    """What is said of a reader that does this."""
    return lambda reader: verdict_on(reader, monkeypatch)


def verdict_on(reader, patch):
    patch.setattr(promise, "decode_radiance_image", lambda data, name, reading: reader())
    return verdict(Witness(), "flat.hdr", seeds()["flat.hdr"])


def image(height=4, width=12, value=1.0, dtype=np.float32):
    return Decoded(np.full((height, width, 3), value, dtype), "test")


def refusing(message):
    def refuse():
        error = LightError("")
        error.args = (message,)  # past what makes every message safe
        raise error

    return refuse


def test_an_honest_reader_is_cleared(judged):
    assert judged(image) is True
    assert judged(refusing("flat.hdr: damaged; fetch it again")) is False


@pytest.mark.parametrize(
    ("reader", "why"),
    [
        (lambda: 1 // 0, "ZeroDivisionError"),
        (refusing("damaged"), "refused with 'damaged'"),
        (refusing("flat.hdr: \x1b[2J"), "refused with"),
        (refusing("flat.hdr: " + "damaged " * 200), "refused with"),
        (lambda: image(value=np.nan), "not finite"),
        (lambda: image(dtype=np.float64), "float64"),
        (lambda: image(width=11), "(4, 11) where the file declares {(4, 12)}"),
        (lambda: image(12, 4), "(12, 4) where the file declares {(4, 12)}"),
        (lambda: time.sleep(0) or Decoded(image().pixels[:, ::-1], "test"), "gives float32 (4, 12, 3)"),
    ],
)
def test_a_reader_that_misbehaves_is_reported(judged, reader, why):
    assert why in judged(reader)


@pytest.mark.parametrize(
    ("method", "spoil", "why"),
    [
        ("radiance", lambda seen: 1 // 0, "makes no light: ZeroDivisionError"),
        ("radiance", lambda seen: seen * np.nan, "makes a light that is not finite, lat-long"),
        ("coefficients", lambda coefficients: coefficients + np.inf, "makes a light that is not finite, lat-long"),
        ("radiance", lambda seen: seen * 1.001, "makes a light beyond its texels, lat-long"),
        ("radiance", lambda seen: seen * 0.999, "makes a light beyond its texels, lat-long"),
    ],
)
def test_a_light_that_misbehaves_is_reported(judged, monkeypatch, method, spoil, why):
    right = getattr(EnvironmentLight, method)
    monkeypatch.setattr(EnvironmentLight, method, lambda light, argument: spoil(right(light, argument)))
    assert why in judged(image)


def test_a_slow_reader_is_reported(judged, monkeypatch):
    def slow():
        until = time.process_time() + 0.1
        while time.process_time() < until:
            pass
        return image()

    assert judged(slow) is True
    monkeypatch.setattr(promise, "MOST_SECONDS", 0.05)
    assert "took 0.1 s" in judged(slow)


@pytest.mark.skipif(not Path("/proc/self/clear_refs").exists(), reason="memory is measured on Linux only")
def test_a_wasteful_reader_is_reported_even_after_another():
    """In a process of its own: what other tests left behind, and is given back meanwhile, would count against it."""
    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as child:
        verdicts = child.submit(verdicts_on_memory, (150, 250, 150, 250)).result()
    assert verdicts[::2] == [True, True]
    assert all("MB for at most 48 texels" in verdict for verdict in verdicts[1::2])


def verdicts_on_memory(megabytes):
    def wasteful(size):
        np.ones(size * 10**6, np.uint8)
        return image()

    with pytest.MonkeyPatch.context() as patch:
        return [verdict_on(lambda size=size: wasteful(size), patch) for size in megabytes]


class Deadly:
    """Six sound files; making number 2 ends the child's process, and making number 4 takes for ever there."""

    def judge(self):
        return Witness()

    def __len__(self):
        return 6

    def __getitem__(self, number):
        if multiprocessing.parent_process():
            if number == 2:
                os.abort()
            if number == 4:
                time.sleep(3600)
        return "flat.hdr", seeds()["flat.hdr"]


def test_an_input_that_kills_or_stops_the_process_is_reported_and_the_rest_still_read(monkeypatch):
    monkeypatch.setattr(harness, "_NO_SIGN_OF_LIFE_SECONDS", 3.0)
    monkeypatch.setattr(harness, "_AT_ONCE", 1)
    findings = examine(Deadly())
    assert [(broken.number, broken.why) for broken in findings.broken] == [
        (2, "killed its process (exit code -6)"),
        (4, "did not come back within 3 s"),
    ]
    assert 1 <= findings.accepted["flat.hdr"] <= 4  # those before number 2 and 4 die with their batch


def test_broken_promises_are_saved_under_their_seeds_name(tmp_path):
    assert save(b"bytes", "0-41", "flat.hdr", tmp_path / "found").read_bytes() == b"bytes"
    assert [path.name for path in tmp_path.rglob("*.hdr")] == ["0-41-flat.hdr"]
    with pytest.raises(BrokenPromise):
        Witness(LIMITS).check("flat.hdr", None)
