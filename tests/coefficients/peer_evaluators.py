"""How other programs turn their coefficients into a value, written from their own sources and without shviewer.

Each takes the numbers as that program stores them, (n**2, k), and unit directions in that program's own axes, (d, 3), and
returns (d, k). Constants are exact where the sources print six digits.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[Any]

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


def babylon(c: Numbers, directions: NDArray[np.float64]) -> Numbers:
    """preScaleForRendering of Maths/sphericalPolynomial.ts (SH3ylmBasisConstants), then harmonicsFunctions of its shaders."""
    constants = np.sqrt(np.array([1, 3, 3, 3, 15, 15, 5 / 4, 15, 15 / 4]) / (4 * PI))
    return np.asarray(polynomials(directions) * constants * [1, -1, 1, -1, 1, -1, 1, -1, 1] @ c)


def gltf(c: Numbers, directions: NDArray[np.float64]) -> Numbers:
    """EXT_lights_image_based.ts: convertIrradianceToLambertianRadiance, which divides by pi, and then as above."""
    return babylon(c / PI, directions)


def playcanvas(sh: Numbers, directions: NDArray[np.float64]) -> Numbers:
    """addAmbient of the shader chunk ambient.js."""
    x, y, z = directions.T
    basis = np.stack([1 + 0 * x, x, y, z, x * z, z * y, y * x, 3 * z * z - 1, x * x - y * y], axis=1)
    return np.asarray(basis @ sh)


def godot(sh: Numbers, directions: NDArray[np.float64]) -> Numbers:
    """The lightmap capture of scene_forward_clustered.glsl: c[5] with the products and the quotients in its comments."""
    c = np.sqrt(np.array([1, 3, 15, 5 / 4, 15 / 4]) / (4 * PI)) * PI * np.array([1, 2 / 3, 1 / 4, 1 / 4, 1 / 4])
    return np.asarray(polynomials(directions) * c[[0, 1, 1, 1, 2, 2, 3, 2, 4]] @ sh)


def gaussian_splatting(sh: Numbers, directions: NDArray[np.float64]) -> Numbers:
    """eval_sh of utils/sh_utils.py plus 0.5: C0, C1, C2 and C3 are the roots that they are printed digits of."""
    x, y, z = directions.T
    xx, yy, zz = x * x, y * y, z * z
    c0, c1 = math.sqrt(1 / (4 * PI)), math.sqrt(3 / (4 * PI))
    c2 = np.sqrt(np.array([15, 15, 5 / 4, 15, 15 / 4]) / (4 * PI)) * [1, -1, 1, -1, 1]
    c3 = -np.sqrt(np.array([35 / 8, 105, 21 / 8, 7 / 4, 21 / 8, 105 / 4, 35 / 8]) / (4 * PI)) * [1, -1, 1, -1, 1, -1, 1]
    degree2 = [x * y, y * z, 2 * zz - xx - yy, x * z, xx - yy]
    last = 4 * zz - xx - yy
    degree3 = [
        y * (3 * xx - yy),
        x * y * z,
        y * last,
        z * (2 * zz - 3 * xx - 3 * yy),
        x * last,
        z * (xx - yy),
        x * (xx - 3 * yy),
    ]
    basis = np.stack([c0 + 0 * x, -c1 * y, c1 * z, -c1 * x, *(c2[:, None] * degree2), *(c3[:, None] * degree3)], axis=1)
    return np.asarray(0.5 + basis[:, : len(sh)] @ sh)


def b_format(directions: NDArray[np.float64]) -> NDArray[np.float64]:
    """The gains of W X Y Z R S T U V K L M N O P Q for a plane wave from azimuth A and elevation E, after Malham, (d, 16)."""
    x, y, z = directions.T
    a, e = np.arctan2(y, x), np.arcsin(z)
    level, third, fourth = np.cos(e), math.sqrt(135 / 256), math.sqrt(27 / 4)
    gains = [math.sqrt(1 / 2) + 0 * x, np.cos(a) * level, np.sin(a) * level, z]
    gains += [(3 * z**2 - 1) / 2, np.cos(a) * np.sin(2 * e), np.sin(a) * np.sin(2 * e)]
    gains += [np.cos(2 * a) * level**2, np.sin(2 * a) * level**2]
    gains += [
        z * (5 * z**2 - 3) / 2,
        third * np.cos(a) * level * (5 * z**2 - 1),
        third * np.sin(a) * level * (5 * z**2 - 1),
    ]
    gains += [fourth * np.cos(2 * a) * z * level**2, fourth * np.sin(2 * a) * z * level**2]
    gains += [np.cos(3 * a) * level**3, np.sin(3 * a) * level**3]
    return np.stack(gains, axis=1)


def fuma(channels: Numbers, directions: NDArray[np.float64]) -> Numbers:
    """Channels are integrals with these gains, which are orthogonal: the sum undoes their mean squares, by quadrature."""
    nodes, weights = np.polynomial.legendre.leggauss(8)
    azimuth = np.arange(8) * PI / 4
    z, a = np.repeat(nodes, 8), np.tile(azimuth, 8)
    rule = np.stack([np.sqrt(1 - z * z) * np.cos(a), np.sqrt(1 - z * z) * np.sin(a), z], axis=1)
    squares = (PI / 4) * (np.repeat(weights, 8)[:, None] * b_format(rule) ** 2).sum(axis=0)
    return np.asarray((b_format(directions) / squares)[:, : len(channels)] @ channels)


def shtools(rows: Numbers, directions: NDArray[np.float64]) -> Numbers:
    """SHVectorToCilm, then SHCoeffs with its defaults."""
    import pyshtools

    x, y, z = directions.T
    latitude, longitude = np.degrees(np.arcsin(z)), np.degrees(np.arctan2(y, x))
    tables = [pyshtools.SHCoeffs.from_array(pyshtools.shio.SHVectorToCilm(channel)) for channel in rows.T]
    return np.stack([table.expand(lat=latitude, lon=longitude) for table in tables], axis=1)
