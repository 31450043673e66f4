"""The guide's way to several machines works: on the cluster of this machine, where Dask is installed."""

from __future__ import annotations

import pickle

import numpy as np
import pytest
from documents import code_blocks, page

import shviewer


def test_what_project_takes_and_gives_goes_from_process_to_process_unchanged() -> None:
    found = shviewer.project(*pickle.loads(pickle.dumps(("green", 4))))
    there = pickle.loads(pickle.dumps(found))
    assert np.array_equal(there.coefficients, found.coefficients)
    assert (there.figures, there.name, there.quantity) == (found.figures, found.name, found.quantity)
    assert pickle.loads(pickle.dumps(shviewer.project)) is shviewer.project


def test_an_error_goes_from_process_to_process_with_its_line() -> None:
    with pytest.raises(shviewer.ShviewerError) as raised:
        shviewer.project("gren", 4)
    assert str(pickle.loads(pickle.dumps(raised.value))) == str(raised.value)


def test_the_example_of_the_guide_projects_on_a_local_cluster_and_names_what_failed(
    capsys: pytest.CaptureFixture[str],
) -> None:
    distributed = pytest.importorskip("dask.distributed", reason="pip install -e '.[cluster]'")
    (example,) = code_blocks(page("command-line"), "python")
    names: dict[str, object] = {"__name__": "example"}
    exec(compile(example, "command-line.md", "exec"), names)
    with distributed.LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=":0") as cluster:
        found = names["project_all"](["green", "gren"], 4, cluster)
    assert list(found) == ["green"]
    assert np.array_equal(found["green"].coefficients, shviewer.project("green", 4).coefficients)
    assert capsys.readouterr().out == "gren: unknown light 'gren': did you mean green?\n"
