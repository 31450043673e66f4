"""What Gauss-Legendre nodes cost, against numpy's and SciPy's: python tests/benchmarks/nodes.py

CPU time of one thread; the ratio to numpy, whose eigenvalues take the cube of the nodes. Goal: the square at most.
"""

from __future__ import annotations

import os

os.environ["OPENBLAS_NUM_THREADS"] = "1"

import numpy as np
from measure import cpu_milliseconds, machine
from scipy.special import roots_legendre

from shviewer.harmonics.quadrature import gauss_legendre_rows


def main() -> None:
    print(machine(), "- one thread")
    for rows in (64, 512, 1024, 2048, 4096):
        ours = cpu_milliseconds(lambda rows=rows: gauss_legendre_rows.__wrapped__(rows))
        numpys = cpu_milliseconds(lambda rows=rows: np.polynomial.legendre.leggauss(rows))
        scipys = cpu_milliseconds(lambda rows=rows: roots_legendre(rows))
        peers = f"numpy {numpys:8.1f} ({numpys / ours:.0f} x), SciPy {scipys:8.1f} ({scipys / ours:.0f} x)"
        print(f"{rows:>5} nodes {ours:8.1f} ms, {peers}")


if __name__ == "__main__":
    main()
