"""The smallest change per band that leaves no negative radiance.

P.-P. Sloan ("Deringing Spherical Harmonics", 2017) narrows a window of one parameter until nothing is negative. No such
family contains the best answer: for Green's light a Lanczos window has to go down to two bands. Here every band has a
factor h(l) of its own, except band 0, the mean. The squared L2 change, which is exactly
    sum over l of (1 - h(l))^2 p(l),   p(l) the energy of band l,
is made as small as possible while no channel is negative in any direction. That is a least-distance problem with one linear
constraint per direction. Only the few lowest valleys matter; they are found on the function itself and added until none is
below zero, and until a bound of the whole sphere (extremes/band_limited.py) finds no other. There is a solution whenever the
mean is not negative, since the mean alone is one.

Source
    [LH] C. Lawson, R. Hanson, "Solving Least Squares Problems" (1974), chapter 23: NNLS and LDP.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array, check_bands, count_bands, evaluate_basis
from shviewer.harmonics.extremes.band_limited import BandLimited
from shviewer.harmonics.extremes.bands import band_heights
from shviewer.harmonics.extremes.climbing import valleys
from shviewer.harmonics.filters import per_coefficient
from shviewer.harmonics.metrics import band_power
from shviewer.harmonics.quadrature import column_azimuths, directions_from_angles, row_angles
from shviewer.harmonics.synthesis import Synthesis

MAX_DERINGED_BANDS = 32

TOLERANCE = 1e-6
"""Valleys this far below zero, relative to the mean radiance, get a constraint; a trace of the mean lifts the rest."""

ROUNDS, QUICK_ROUNDS, QUICK_VALLEYS = 60, 7, 40
"""The search is quick while constraints are collected; when it finds none, the whole sphere is searched."""

GRID_ROWS, EFFORT = 12, 32
"""Rows a band of the grid for that, and the effort of the search on it."""

EMPTY = 1e-10
"""A band with less than this share of the L2 norm keeps the factor 1."""


@dataclass(frozen=True, eq=False)
class Deringing:
    """factors: h(l), (n,). minimum: no direction and channel of the result is below. change: L2, relative to the norm."""

    factors: Array
    minimum: float
    change: float


def dering(coefficients: Array) -> Deringing:
    """Find the factors h(l) (see above) for coefficients (n**2, 3), n up to MAX_DERINGED_BANDS.

    One factor per band for all channels, so that no hue shifts; 1 where nothing is negative. ValueError for too many
    bands, or for a negative mean, which no window can make non-negative.
    """
    n_bands = count_bands(coefficients)
    check_bands(n_bands, MAX_DERINGED_BANDS)
    mean = coefficients[0] / np.sqrt(4 * np.pi)
    if (mean < 0).any():
        raise ValueError(f"mean radiance {mean.min():.3g} in a channel: no window makes a negative mean non-negative")
    power = band_power(coefficients).sum(axis=1)
    norm = np.sqrt(power.sum())
    if norm == 0:
        return Deringing(np.ones(n_bands), 0.0, 0.0)
    strength = np.sqrt(power) / norm
    movable = (strength > EMPTY) & (np.arange(n_bands) > 0)
    factors = np.ones(n_bands)
    movables = int(movable.sum())
    rows, limits = np.zeros((0, movables)), np.zeros(0)
    for _ in range(ROUNDS):
        lowest, directions, channels = valleys(coefficients * per_coefficient(factors), QUICK_ROUNDS, QUICK_VALLEYS)
        below = lowest < -TOLERANCE * mean.max()
        if not below.any():
            bounds, lowest, directions = _searched(coefficients * per_coefficient(factors), TOLERANCE * mean.max() / 8)
            channels, below = np.arange(3), lowest < -TOLERANCE * mean.max()
            if not below.any():
                break
        by_band = _band_values(coefficients, directions[below], channels[below]) / norm
        rows = np.concatenate([rows, -by_band[:, movable] / strength[movable]])
        limits = np.concatenate([limits, -by_band.sum(axis=1)])
        # with u(l) = strength(l) (1 - h(l)), a radiance is its value at u = 0 minus by_band / strength . u
        u, binding = least_distance(rows, limits)
        rows, limits = rows[binding], limits[binding]  # the others hold by themselves
        factors[movable] = 1 - u / strength[movable]
    else:
        bounds, _, _ = _searched(coefficients * per_coefficient(factors), TOLERANCE * mean.max() / 8)
    lift = float((np.maximum(-bounds, 0) / np.maximum(mean - bounds, np.finfo(float).tiny)).max())
    factors[1:] *= 1 - lift  # a trace of the mean lifts what the rounds and the quick search left below zero
    change = float((power * (1 - factors) ** 2).sum())
    return Deringing(factors, float(((1 - lift) * bounds + lift * mean).min()), float(np.sqrt(change)) / norm)


def _searched(coefficients: Array, tolerance: float) -> tuple[Array, Array, Array]:
    """A lower bound of each channel, (3,), and the lowest values found, (3,), with their directions, (3, 3)."""
    synthesis = Synthesis(coefficients)
    rows = GRID_ROWS * max(synthesis.n_bands, 4)
    theta, phi = row_angles(rows), column_azimuths(2 * rows)
    values = synthesis.on_rows(theta, len(phi))
    heights = band_heights(coefficients)
    bounds, lowest, directions = np.empty(3), np.empty(3), np.empty((3, 3))
    for channel in range(3):
        same = next(c for c in range(channel + 1) if np.array_equal(coefficients[:, c], coefficients[:, channel]))
        if same < channel:
            bounds[channel], lowest[channel], directions[channel] = bounds[same], lowest[same], directions[same]
            continue
        own = np.ascontiguousarray(values[:, [channel]])
        row, column = divmod(int(own.argmin()), len(phi))
        found = BandLimited(own, heights[:, [channel]]).lowest(float(own.min()), tolerance, EFFORT)
        bounds[channel], lowest[channel] = found.bound, found.lowest
        angles = (found.theta, found.phi) if found.lowest < own.min() else (theta[row], phi[column])
        directions[channel] = directions_from_angles(*map(np.asarray, angles))
    return bounds, lowest, directions


def least_distance(rows: Array, limits: Array) -> tuple[Array, NDArray[np.bool_]]:
    """The shortest u with rows @ u >= limits [LH, LDP]: (k, n), (k,) -> (n,), and which rows are binding, (k,).

    ValueError if there is none.
    """
    system = np.vstack([rows.T, limits])
    target = np.zeros(len(system))
    target[-1] = 1
    pull = _non_negative_least_squares(system, target)
    residual = system @ pull - target
    if abs(residual[-1]) < 1e-14:
        raise ValueError("no vector satisfies all the inequalities")
    return np.asarray(-residual[:-1] / residual[-1]), pull > 0


def _non_negative_least_squares(system: Array, target: Array) -> Array:
    """The y >= 0 that minimises |system @ y - target| [LH, NNLS]."""
    count = system.shape[1]
    free = np.zeros(count, dtype=bool)
    y = np.zeros(count)
    for _ in range(3 * count + 10):
        gain = system.T @ (target - system @ y)
        gain[free] = -np.inf
        if gain.max(initial=-np.inf) <= 1e-13 * np.abs(system).max():
            break
        free[int(gain.argmax())] = True
        while True:
            trial = np.zeros(count)
            trial[free] = np.linalg.lstsq(system[:, free], target, rcond=None)[0]
            stuck = free & (trial <= 0)
            if not stuck.any():
                break
            step = float((y[stuck] / (y[stuck] - trial[stuck])).min())
            y += step * (trial - y)
            free &= y > 1e-15 * y.max(initial=0)
            y[~free] = 0
        y = trial
    return y


def _band_values(coefficients: Array, directions: Array, channels: NDArray[np.int64]) -> Array:
    """The value of each band in one channel and one direction: (k, n)."""
    terms = evaluate_basis(directions, count_bands(coefficients)) * coefficients[:, channels].T
    return np.asarray(np.add.reduceat(terms, np.arange(count_bands(coefficients)) ** 2, axis=1))
