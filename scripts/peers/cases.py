"""Cases, sweeps and directions.

SPDX-License-Identifier: GPL-3.0-or-later
"""

from dataclasses import dataclass, field, replace

import numpy as np


def gauss_sphere(n):
    """n Gauss nodes a hemisphere, and weights that sum to 1."""
    x, w = np.polynomial.legendre.leggauss(n)
    mu = (x + 1) / 2
    return np.concatenate([-mu[::-1], mu]), np.concatenate([w[::-1], w]) / 4


def even_azimuths(n):
    weight = np.full(n, 1 / (n - 1))
    weight[[0, -1]] /= 2
    return np.linspace(0, 180, n), weight


@dataclass
class Case:
    albedo: float
    g: float
    thickness: float
    mu0: float
    tau: np.ndarray = field(default_factory=lambda: np.zeros(1))
    mu: np.ndarray = field(default_factory=lambda: np.zeros(0))
    phi: np.ndarray = field(default_factory=lambda: np.zeros(0))


@dataclass
class SweepLists:
    albedo: np.ndarray
    g: np.ndarray
    thickness: np.ndarray
    mu0: np.ndarray
    phi: np.ndarray
    streams: int = 16
    n_depths: int = 5

    @property
    def n_cases(self):
        return len(self.albedo) * len(self.g) * len(self.thickness) * len(self.mu0)

    def slabs(self):
        return [
            Case(a, g, w, 1.0, np.linspace(0, w, self.n_depths))
            for a in self.albedo
            for g in self.g
            for w in self.thickness
        ]

    def cases(self):
        return [replace(c, mu0=m) for c in self.slabs() for m in self.mu0]
