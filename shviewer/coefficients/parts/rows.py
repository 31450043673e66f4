"""Orders of rows: which Y(l, m) each row of a list belongs to.

Ours, "acn" to those who record sound, has Y(l, m) in the row l(l+1) + m. The others are those that lists are found in:

order-playcanvas   1 x y z xz yz xy 3z^2-1 x^2-y^2, of PlayCanvas and ClayGL (ambientSH)
order-xyz          1 x y z xy xz yz x^2-y^2 3z^2-1, the polynomials of face models such as DECA (add_SHlight)
order-alternating  m = 0, +1, -1, +2, -2 ... in each degree: Basri and Jacobs (2003), SfSNet (get_shading)
order-2001         L00 L1-1 L10 L11 L21 L2-1 L2-2 L20 L22, as tables after Ramamoorthi and Hanrahan (2001) have them
order-cilm         m = 0, 1 ... l, -1 ... -l in each degree: SHCilmToVector of SHTOOLS
order-m-major      m = 0, +1, -1, +2, -2 ..., for each of them all degrees
order-m-rising     m from the lowest to the highest, for each of them all degrees
order-fuma         W X Y Z R S T U V K ... Q of B-format: as alternating, but l = 1 is +1, -1, 0
order-fuma-inverse the inverse of that, which spharpy 1.0.1 has for FuMa (nm_to_fuma)
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

Order = NDArray[np.int64]
"""The index l(l+1) + m of the Y(l, m) that each row belongs to, (n_bands**2,)."""

ACN = "acn"

_FUMA = (0, 3, 1, 2, 6, 7, 5, 8, 4, 12, 13, 11, 14, 10, 15, 9)


def _listed(*places: int) -> Callable[[int], Order]:
    """The order of a list that ends with these places, or at the end of a degree before."""

    def order(n_bands: int) -> Order:
        if n_bands**2 > len(places):
            raise ValueError(f"{n_bands} bands: it is defined for 1 to {round(len(places) ** 0.5)}")
        return np.array(places[: n_bands**2])

    return order


def _sorted(key: Callable[[int, int], tuple[int, ...]]) -> Callable[[int], Order]:
    """The order of lists of any length, sorted by a key of l and m."""

    def order(n_bands: int) -> Order:
        pairs = sorted(((l, m) for l in range(n_bands) for m in range(-l, l + 1)), key=lambda pair: key(*pair))
        return np.array([l * (l + 1) + m for l, m in pairs])

    return order


def _outwards(m: int) -> tuple[int, bool]:
    return abs(m), m < 0


ORDERS: dict[str, tuple[Callable[[int], Order], str]] = {
    ACN: (_sorted(lambda l, m: (l, m)), "l(l+1) + m"),
    "order-playcanvas": (_listed(0, 3, 1, 2, 7, 5, 4, 6, 8), "1 x y z xz yz xy 3z^2-1 x^2-y^2"),
    "order-xyz": (_listed(0, 3, 1, 2, 4, 7, 5, 8, 6), "1 x y z xy xz yz x^2-y^2 3z^2-1"),
    "order-alternating": (_sorted(lambda l, m: (l, *_outwards(m))), "m = 0, 1, -1, 2, -2 ... in each degree"),
    "order-2001": (_listed(0, 1, 2, 3, 7, 5, 4, 6, 8), "L00 L1-1 L10 L11 L21 L2-1 L2-2 L20 L22"),
    "order-cilm": (_sorted(lambda l, m: (l, m < 0, abs(m))), "m = 0, 1 ... l, -1 ... -l in each degree"),
    "order-m-major": (_sorted(lambda l, m: (*_outwards(m), l)), "m = 0, 1, -1, 2, -2 ..., for each all degrees"),
    "order-m-rising": (_sorted(lambda l, m: (m, l)), "m from the lowest to the highest, for each all degrees"),
    "order-fuma": (_listed(*_FUMA), "W X Y Z R S T U V K L M N O P Q"),
    "order-fuma-inverse": (_listed(*np.argsort(_FUMA).tolist()), "the inverse of W X Y Z R S T U V K L M N O P Q"),
}
"""Name -> the order for a number of bands, a ValueError where it is not defined; and the order in words."""


@lru_cache(64)
def row_order(name: str, n_bands: int) -> Order:
    """The index l(l+1) + m of the Y(l, m) that each row belongs to. ValueError for more bands than the order has."""
    try:
        order = ORDERS[name][0](n_bands)
        order.setflags(write=False)
        return order
    except ValueError as error:
        raise ValueError(f"rows in {name}, {error}") from None
