"""Integrals of the basis over areas of the sphere from their boundaries alone.

On the sphere the Laplacian of Y(l, m) is -l(l+1) Y(l, m), so by Green's theorem
    integral of Y(l, m) over an area = -1/(l(l+1)) times the integral of t . (r x grad) Y(l, m) along its boundary,
with the boundary's tangent t, counterclockwise as seen from outside. The operator r x grad takes Y(l, m) to functions of the
same degree, by the algebra of angular momentum (DLMF 14.30; Y = sqrt(2) {Re, Im} of the complex functions):
    (r x grad)_z Y(m) = i m Y(m),     (r x grad)_x +- i (r x grad)_y = i {L+, L-},
    L+- Y(m) = sqrt((l -+ m)(l +- m + 1)) Y(m +- 1).
So three plain projections, of the components of t, are all that is needed. For l = 0 the area itself is.
"""

from __future__ import annotations

import numpy as np

from shviewer.harmonics.basis import Array, count_bands
from shviewer.harmonics.theta_series import degrees_and_orders


def from_boundary(tangents: Array) -> Array:
    """Coefficients (n**2, ...) of areas of constant value from sums along their boundaries; 0 for l = 0.

    tangents: (3, n**2, ...), the projections of the x, y and z component of value times tangent.
    """
    n_bands = count_bands(tangents[0])
    degree, order, sine = degrees_and_orders(n_bands)
    flat = tangents.reshape(3, n_bands**2, -1)
    x, y, z = np.zeros((3, n_bands, n_bands + 2, flat.shape[-1]), np.complex128)  # l, m from -1
    cosines, sines = sine == 0, sine == 1
    for table, sums in zip((x, y, z), flat, strict=True):
        table[degree[cosines], order[cosines] + 1] = sums[cosines]
        table[degree[sines], order[sines] + 1] += 1j * sums[sines]
        table[:, 2:] /= np.sqrt(2)
        table[:, 0] = -np.conj(table[:, 2])
    l, m = np.arange(n_bands)[:, None], np.arange(n_bands)
    up = np.sqrt(np.maximum((l - m) * (l + m + 1), 0))[..., None] / 2
    down = np.sqrt(np.maximum((l + m) * (l - m + 1), 0))[..., None] / 2
    higher, lower = slice(2, None), slice(0, -2)
    flux = 1j * (up * x[:, higher] + down * x[:, lower])
    flux += up * y[:, higher] - down * y[:, lower]
    flux += 1j * m[:, None] * z[:, 1:-1]
    flux /= -np.maximum(l * (l + 1), 1)[..., None]
    flux[0] = 0
    flux[:, 1:] *= np.sqrt(2)
    found = np.where(sine[:, None] == 1, flux[degree, order].imag, flux[degree, order].real)
    return np.asarray(found.reshape(tangents.shape[1:]))
