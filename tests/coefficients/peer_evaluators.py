"""How other programs turn their coefficients into a value, written from their own sources and without shviewer.

Each takes the numbers as that program stores them, (n**2, k), and unit directions in that program's own axes, (d, 3), and
returns (d, k). Constants are exact where the sources print six digits.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[Any]
Evaluator = Callable[[Numbers, NDArray[np.float64]], Numbers]

PI = math.pi


def polynomials(directions: NDArray[np.float64]) -> NDArray[np.float64]:
    """1, y, z, x, yx, yz, 3z^2-1, zx, x^2-y^2, (d, 9)."""
    x, y, z = directions.T
    return np.stack([1 + 0 * x, y, z, x, y * x, y * z, 3 * z * z - 1, z * x, x * x - y * y], axis=1)


def filament(sh: Numbers, directions: NDArray[np.float64]) -> Numbers:
    """renderPreScaledSH3Bands, libs/ibl/src/CubemapSH.cpp, which is what the shader sums, too."""
    return np.asarray(polynomials(directions)[:, : len(sh)] @ sh)


def three(coefficients: Numbers, directions: NDArray[np.float64]) -> Numbers:
    """getAt, src/math/SphericalHarmonics3.js: 0.282095, 0.488603, 1.092548, 0.315392, 0.546274."""
    constants = np.array([1 / 4, 3 / 4, 3 / 4, 3 / 4, 15 / 4, 15 / 4, 5 / 16, 15 / 4, 15 / 16])
    return np.asarray(polynomials(directions) * np.sqrt(constants / PI) @ coefficients)


def unity(sh: Numbers, directions: NDArray[np.float64]) -> Numbers:
    """PackCoefficients of HDRP's SphericalHarmonics.cs, then ShadeSH9 of UnityCG.cginc."""
    x, y, z = directions.T
    channels = []
    for c in sh.T:
        a, b, last = (c[3], c[1], c[2], c[0] - c[6]), (c[4], c[5], 3 * c[6], c[7]), c[8]
        linear = a[0] * x + a[1] * y + a[2] * z + a[3]
        quadratic = b[0] * x * y + b[1] * y * z + b[2] * z * z + b[3] * z * x
        channels.append(linear + quadratic + last * (x * x - y * y))
    return np.stack(channels, axis=1)


def unreal(v: Numbers, directions: NDArray[np.float64]) -> Numbers:
    """SHBasisFunction of Math/SHMath.h: NormalizationConstants times sin or cos(m phi) times LegendrePolynomial(L, |M|, Z)."""
    x, y, z = directions.T
    phi, s = np.arctan2(y, x), np.sqrt(1 - z * z)
    legendre = {
        (0, 0): 1 + 0 * z,
        (1, 0): z,
        (1, 1): -s,
        (2, 0): (3 * z * z - 1) / 2,
        (2, 1): -3 * z * s,
        (2, 2): 3 * s * s,
    }
    value = np.zeros((len(directions), v.shape[1]))
    for l in range(math.isqrt(len(v))):
        for m in range(-l, l + 1):
            constant = (2 * l + 1) / (4 * PI) * math.factorial(l - abs(m)) / math.factorial(l + abs(m))
            azimuth = np.sqrt(2) * np.cos(m * phi) if m > 0 else np.sqrt(2) * np.sin(-m * phi) if m else 1
            value += (math.sqrt(constant) * azimuth * legendre[l, abs(m)])[:, None] * v[l * (l + 1) + m]
    return value


def ambix(channels: Numbers, directions: NDArray[np.float64]) -> Numbers:
    """Channels are integrals with N P(sin elevation) cos or sin(m azimuth), SN3D and no phase; the sum undoes |Y|^2 = 1."""
    return np.asarray(
        (sn3d(directions, math.isqrt(len(channels))) * (2 * degree(len(channels)) + 1) / (4 * PI)) @ channels
    )


def sn3d(directions: NDArray[np.float64], n_bands: int) -> NDArray[np.float64]:
    """ACN, SN3D: sqrt((2 - [m = 0]) (l-|m|)!/(l+|m|)!) P(l, |m|)(sin elevation) cos(m a) or sin(|m| a), (d, n_bands**2)."""
    from scipy.special import assoc_legendre_p

    x, y, z = directions.T
    azimuth, columns = np.arctan2(y, x), []
    for l in range(n_bands):
        for m in range(-l, l + 1):
            ratio = math.factorial(l - abs(m)) / math.factorial(l + abs(m))
            without_phase = (-1) ** m * assoc_legendre_p(l, abs(m), z)[0]  # SciPy keeps the phase
            turn = np.cos(m * azimuth) if m >= 0 else np.sin(-m * azimuth)
            columns.append(math.sqrt((2 - (m == 0)) * ratio) * without_phase * turn)
    return np.stack(columns, axis=1)


def degree(count: int) -> NDArray[np.int64]:
    return np.array([math.isqrt(i) for i in range(count)])


def sphericart(coefficients: Numbers, directions: NDArray[np.float64]) -> Numbers:
    import sphericart as package

    basis = package.SphericalHarmonics(math.isqrt(len(coefficients)) - 1).compute(np.ascontiguousarray(directions))
    return np.asarray(basis @ coefficients)


def scipy(coefficients: Numbers, directions: NDArray[np.float64]) -> Numbers:
    from scipy.special import sph_harm_y

    x, y, z = directions.T
    theta, phi = np.arccos(z), np.arctan2(y, x)
    pairs = [(l, m) for l in range(math.isqrt(len(coefficients))) for m in range(-l, l + 1)]
    value = np.stack([sph_harm_y(l, m, theta, phi) for l, m in pairs], axis=1) @ coefficients
    np.testing.assert_allclose(value.imag, 0, rtol=0, atol=1e-12)
    return np.asarray(value.real)


def pyshtools(coefficients: Numbers, directions: NDArray[np.float64], normalization: str, phase: bool) -> Numbers:
    """SHCoeffs.expand: real harmonics in `cilm[sine, l, m]`, degrees of latitude and longitude."""
    from pyshtools import SHCoeffs

    n_bands, (x, y, z) = math.isqrt(len(coefficients)), directions.T
    latitude, longitude = np.degrees(np.arcsin(z)), np.degrees(np.arctan2(y, x))
    channels = []
    for channel in coefficients.T:
        cilm = np.zeros((2, n_bands, n_bands))
        for l in range(n_bands):
            for m in range(-l, l + 1):
                cilm[int(m < 0), l, abs(m)] = channel[l * (l + 1) + m]
        table = SHCoeffs.from_array(cilm, normalization=normalization, csphase=-1 if phase else 1)
        channels.append(table.expand(lat=latitude, lon=longitude))
    return np.stack(channels, axis=1)


def e3nn(coefficients: Numbers, directions: NDArray[np.float64]) -> Numbers:
    """Degrees 0 to 3 as e3nn/o3/_spherical_harmonics.py (0.4.4) generates them, with normalization="integral"; y is its pole.

    The package itself needs torch.
    """
    x, y, z = directions.T
    s3, around = math.sqrt(3), x * x + z * z
    s20, s21, s23, s24 = s3 * x * z, s3 * x * y, s3 * y * z, s3 / 2 * (z * z - x * x)
    s30, s31 = math.sqrt(5 / 6) * (s20 * z + s24 * x), math.sqrt(5) * s20 * y
    s32, s33 = math.sqrt(3 / 8) * (4 * y * y - around) * x, y / 2 * (2 * y * y - 3 * around)
    s34, s35 = math.sqrt(3 / 8) * z * (4 * y * y - around), math.sqrt(5) * s24 * y
    s36 = math.sqrt(5 / 6) * (s24 * z - s20 * x)
    norm = np.stack(
        [1 + 0 * x, x, y, z, s20, s21, y * y - around / 2, s23, s24, s30, s31, s32, s33, s34, s35, s36], axis=1
    )
    scale = np.sqrt((2 * degree(16) + 1) / (4 * PI))
    return np.asarray((norm * scale)[:, : len(coefficients)] @ coefficients)
