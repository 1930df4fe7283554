# SPDX-License-Identifier: BSD-3-Clause
"""The boxes that particles stand for, for the scripts that draw them: whole boxes of a lattice, or what a surface has cut
out of one."""
import numpy as np


def whole_particles(amount):
    """Which particles are whole boxes of the main lattice: those of the mass (or volume) in which most of the body comes. Boxes
    that are split may be more, but each of their parts is less."""
    step = 1e-5 * np.median(amount)
    values, count = np.unique(np.round(amount / step), return_counts=True)
    return np.abs(amount - step * values[np.argmax(count * values)]) <= 1.5 * step


def lattice_intervals(positions):
    """The smallest distance between coordinates along each axis; nan where there is one coordinate alone."""
    intervals = []
    for x in positions.T:
        extent = max(np.ptp(x), 1e-300)
        steps = np.diff(np.unique(np.round(x / extent, 7)))
        intervals.append(steps.min() * extent if len(steps) else np.nan)
    return np.array(intervals)


def particle_sizes(start, volume, mass=None):
    """Edge lengths of the particles' boxes. `start`: where they began, [particle][dimension]. Whole ones have the lattice's
    intervals, if their volume is that of such a box; those that are cut a box of the same form and of their own volume; and
    where particles lie on no lattice (rings, jitter), each has a cube."""
    dimension = start.shape[1]
    whole = whole_particles(volume if mass is None else mass)
    usual = np.median(volume[whole])
    edges = lattice_intervals(start[whole])
    edge = usual ** (1 / dimension)
    alone = np.isnan(edges)  # a single layer: what the volume leaves
    if alone.any() and not alone.all():
        edges[alone] = (usual / np.prod(edges[~alone])) ** (1 / alone.sum())
    if alone.all() or not 0.6 < np.prod(edges) / usual < 1.6:  # volumes change as the body strains
        edges = np.full(dimension, edge)
    sizes = edges * (volume / usual)[:, None] ** (1 / dimension)
    sizes[whole] = edges
    return sizes


def middle_layer(start, sizes, mass, axis):
    """Which particles meet a plane just above the middles of the boxes next to the middle of the body along an axis. Boxes
    that are split have one half of them above it."""
    z = start[:, axis]
    whole = np.flatnonzero(whole_particles(mass))
    level = z[whole[np.argmin(np.abs(z[whole] - 0.5 * (z.min() + z.max())))]]
    height = sizes[whole[0], axis]
    return (z - level > -1e-6 * height) & (z - level < 0.499 * height)


def boxes(x, sizes, axes):
    """The corners of a rectangle for each particle, in the plane of two axes."""
    corners = 0.5 * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    return x[:, axes][:, None, :] + sizes[:, axes][:, None, :] * corners[None]
