"""How long the search for a convention takes, beside one comparison of the numbers as they are.

    python tests/benchmarks/diagnosis.py

For lists of 2 to 9 bands of which nothing is known: the median of several searches, the first of which also makes the
matrices of all orientations, and the ratio to reading the list and measuring its error once.
"""

from __future__ import annotations

from statistics import median
from time import perf_counter

import numpy as np

from shviewer.analysis.comparison import error_of
from shviewer.coefficients.diagnosis.search import explain
from shviewer.coefficients.diagnosis.ways import ways
from shviewer.coefficients.numbers import Listed
from shviewer.coefficients.reading import interpreted
from shviewer.coefficients.texts import parse_convention
from shviewer.lights.find import find_light

ROUNDS = 7


def seconds(work: object, rounds: int) -> list[float]:
    taken = []
    for _ in range(rounds):
        start = perf_counter()
        work()  # type: ignore[operator]
        taken.append(perf_counter() - start)
    return taken


def main() -> None:
    light = find_light("venice_sunset")
    print("bands  ways  first search  search  comparison  ratio")
    for n_bands in (2, 3, 4, 5, 6, 9):
        exact = light.coefficients(n_bands)
        numbers = np.asarray(parse_convention("shviewer,y-up,no-phase,times=1.7").from_ours(exact))
        listed = Listed(numbers)
        first, *searches = seconds(lambda listed=listed, exact=exact: explain(listed, exact), ROUNDS)

        def compare(listed: Listed = listed, exact: np.ndarray = exact) -> float:
            read = interpreted(listed, "shviewer")
            return error_of(exact, read.coefficients, read.quantity)

        once, search = median(seconds(compare, 20)), median(searches)
        count = len(list(ways(listed)))
        print(f"{n_bands:5d} {count:5d} {first:12.3f} s {search:6.3f} s {1e3 * once:8.2f} ms {search / once:6.0f}")


if __name__ == "__main__":
    main()
