"""Other libraries: that they do the same work, and that one that is missing is named."""

from __future__ import annotations

import math

import numpy as np
import pytest

from shviewer.benchmark.measuring import peers
from shviewer.benchmark.rows.row import Row
from shviewer.errors import UsageError
from shviewer.harmonics.basis import degrees
from shviewer.harmonics.projection.scattered import project_values
from shviewer.harmonics.quadrature import fibonacci


def test_a_peer_that_is_not_installed_is_named_and_left_out() -> None:
    missing: list[str] = []
    found = peers.available({"one": ("math", lambda module: module), "other": ("absent_module", print)}, missing)
    assert list(found) == ["one"]
    assert found["one"]() is math
    assert missing == ["other: absent_module is not installed"]


def test_ours_is_measured_beside_whatever_peers_there_are() -> None:
    answer = peers.measure(["film_studio", "green"], [3], 0.5, 0)
    rows = [Row.from_dict(row) for row in answer["rows"]]
    ours = [(row.light, row.method, row.samples) for row in rows if row.method.startswith(peers.OURS)]
    assert sorted(ours, key=str) == [
        ("film_studio", "shviewer f32", None),
        ("film_studio", "shviewer", 10_000),
        ("film_studio", "shviewer", None),
    ]
    assert all(row.error is None for row in rows)
    assert all(row.repeats >= 1 if row.measured else row.note == "not measured" for row in rows)  # on the machine
    there = {row.method for row in rows} | {line.split(":")[0].split(",")[0] for line in answer["missing"]}
    assert there >= {*peers.IMAGE_PEERS, *peers.SAMPLE_PEERS}


def test_what_is_too_slow_for_the_budget_is_a_row_that_says_so() -> None:
    answer = peers.measure(["film_studio"], [3, 9], 1e-6, 0)
    ours = [Row.from_dict(row) for row in answer["rows"] if row["method"] == peers.OURS]
    assert [(row.n_bands, row.samples, row.note) for row in ours] == [
        (n_bands, samples, "not measured") for n_bands in (3, 9) for samples in (None, 10_000)
    ]


def test_sphericart_on_samples_does_what_we_do() -> None:
    sphericart = pytest.importorskip("sphericart")
    samples = fibonacci(500)
    radiance = np.random.default_rng(0).normal(size=(500, 3))
    theirs = np.asarray(peers.sphericart_samples(sphericart, samples, radiance, 5))
    ours = project_values(samples.directions, radiance * samples.weights[:, None], 5)
    assert np.abs(theirs) == pytest.approx(np.abs(ours), abs=1e-12)  # their phase is another


def test_scipy_on_samples_does_what_we_do() -> None:
    special = pytest.importorskip("scipy.special")
    samples = fibonacci(500)
    radiance = np.random.default_rng(0).normal(size=(500, 3))
    theirs = np.asarray(peers.scipy_samples(special, samples, radiance, 5)).reshape(5, 5, 3)
    ours = project_values(samples.directions, radiance * samples.weights[:, None], 5)
    zonal = [int(np.flatnonzero(degrees(5) == l)[l]) for l in range(5)]
    assert theirs[:, 0].real == pytest.approx(ours[zonal], abs=1e-12)


def test_a_process_that_fails_is_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(peers.sys, "executable", "false")
    with pytest.raises(UsageError, match="measuring them failed: no message"):
        peers.peer_rows(["green"], [3], 1.0, 0)
