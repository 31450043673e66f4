"""Sums over the faces of a cube against many bands, axis by axis.

About the z axis, a point (1, u, w) on the face of +x has the azimuth atan(u), whatever w is: the columns of a face lie on
meridians. So the sums over w come first, with the waves in theta of each meridian, and those over u afterwards, with the waves
in phi. The point (u, 1, w) has the azimuth pi/2 - atan(u), whose waves are the same but for signs, as in eightfold.py. For the
upper and the lower face axes are exchanged.
"""

from __future__ import annotations

import numpy as np

from shviewer.harmonics.areas.boxes import folded
from shviewer.harmonics.areas.cycling import cycled
from shviewer.harmonics.areas.eightfold import waves
from shviewer.harmonics.basis import Array, check_bands
from shviewer.harmonics.theta_series import MAX_SEPARABLE_BANDS, from_waves


def project_faces(points: Array, values: Array, n_bands: int) -> Array:
    """Sum of value * Y over points of the six faces and their mirror images, (n_bands**2, channels).

    points: (n,), the places u and w in [0, 1]. values: (2, 2, 2, 3, u, w, channels): by the mirror images, index 1 where x, y
    or z is negative; by the axis of the face, in points (1, u, w), (u, 1, w) and (w, u, 1).
    """
    check_bands(n_bands, MAX_SEPARABLE_BANDS)
    values = folded(values)
    front, left, up = np.moveaxis(values, 3, 0)
    out = np.sqrt(1 + points**2)[:, None]
    length = np.sqrt(out**2 + points**2)
    polar = np.stack(waves((points / length).ravel(), (out / length).ravel(), n_bands)).reshape(
        2, n_bands, *length.shape
    )
    azimuth = np.stack(waves(1 / out[:, 0], points / out[:, 0], n_bands))
    turned = up.transpose(1, 2, 0, 3, 4, 5)  # (w, u, 1) is (u, 1, w) with y, z and x for x, y and z
    sides = from_waves(_around(polar, azimuth, front, left))
    return sides + cycled(from_waves(_around(polar, azimuth, np.zeros_like(turned), turned)))


def _around(polar: Array, azimuth: Array, own: Array, exchanged: Array) -> Array:
    """Sums over points (1, u, w) and (u, 1, w), folded, with the waves: (m, {cos, sin}, channel, k by parity).

    polar: ({cos, sin}(k theta), k, u, w). azimuth: ({cos, sin}(m phi), m, u).
    """
    n_bands, n_points, channels = polar.shape[1], polar.shape[2], own.shape[-1]
    q = 1 - np.arange(n_bands)[:, None] % 4 // 2 * 2
    along = np.empty((2, n_points, n_bands, channels))
    sums = np.empty((n_bands, 2, channels, n_bands))
    for odd, part in np.ndindex(2, 2):
        for odd_k in (0, 1):
            kept = slice((n_bands + 1) // 2, None) if odd_k else slice((n_bands + 1) // 2)
            functions = polar[odd, odd_k::2].swapaxes(0, 1)
            for face, values in enumerate((own, exchanged)):
                np.matmul(functions, values[(odd + part) % 2, part, (odd + odd_k) % 2], out=along[face, :, kept])
        found = azimuth[part, odd::2] @ along[0].reshape(n_points, -1)
        found += (1 - 2 * (part & ~odd)) * q[odd::2] * (azimuth[part ^ odd, odd::2] @ along[1].reshape(n_points, -1))
        sums[odd::2, part] = found.reshape(-1, n_bands, channels).swapaxes(1, 2)
    return sums
