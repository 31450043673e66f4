"""How long the search for a convention takes, beside one comparison of the numbers as they are.

    python tests/benchmarks/diagnosis.py

For lists of 2 to 9 bands of which nothing is known: the median of several searches, the first of which also makes the
matrices of all orientations, the same with the sign of a row wrong, and the ratio to reading the list and measuring its error
once.
"""

from __future__ import annotations

from functools import partial
from statistics import median

import numpy as np
from measure import wall_milliseconds

from shviewer.analysis.comparing.suspecting import error_of
from shviewer.coefficients.diagnosis.search import explain
from shviewer.coefficients.diagnosis.ways import ways
from shviewer.coefficients.numbers import Listed
from shviewer.coefficients.reading import interpreted
from shviewer.coefficients.texts import parse_convention
from shviewer.lights.find import find_light

ROUNDS = 7


def compare(listed: Listed, exact: np.ndarray) -> float:
    read = interpreted(listed, "shviewer")
    return error_of(exact, read.coefficients, read.quantity)


def main() -> None:
    light = find_light("venice_sunset")
    print("bands  ways  first search     search  wrong row  comparison  ratio")
    for n_bands in (2, 3, 4, 5, 6, 9):
        exact = light.coefficients(n_bands)
        numbers = np.asarray(parse_convention("shviewer,y-up,no-phase,times=1.7").from_ours(exact))
        listed = Listed(numbers)
        first, *searches = (wall_milliseconds(partial(explain, listed, exact)) for _ in range(ROUNDS))
        once = median(wall_milliseconds(partial(compare, listed, exact)) for _ in range(20))
        search, count = median(searches), len(list(ways(listed)))
        broken = Listed(np.where(np.arange(n_bands**2) == 3, -1, 1)[:, None] * numbers)
        slip = median(wall_milliseconds(partial(explain, broken, exact)) for _ in range(ROUNDS))
        times = f"{first:11.1f} ms {search:6.1f} ms {slip:6.1f} ms {once:8.2f} ms"
        print(f"{n_bands:5d} {count:5d} {times} {search / once:6.0f}")


if __name__ == "__main__":
    main()
