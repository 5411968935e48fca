"""ppscat through its shared library and the loops of tests/bench/peers_ppscat.c.

SPDX-License-Identifier: GPL-3.0-or-later
"""

import ctypes
from ctypes import POINTER, Structure, byref, c_double, c_int, c_size_t

import numpy as np

DOUBLES = POINTER(c_double)
WHOLE_CASE, CREATE, ONE_MORE_BEAM = range(3)
NODES_AUTO, NODES_GAUSS = 0, 1
DELTA_M_AUTO, DELTA_M_ON, DELTA_M_OFF = range(3)
TOLERANCE_MISSED = 5
FLUX_FIELDS = ("up", "down", "direct", "mean_diffuse", "mean")


class _Slab(Structure):
    _fields_ = [(name, c_double) for name in ("albedo", "g", "thickness")]


class _Grid(Structure):
    _fields_ = [(name, c_size_t) for name in ("n_tau", "n_mu", "n_phi")] + [
        (name, DOUBLES) for name in ("tau", "mu", "phi")
    ]


class _Case(Structure):
    _fields_ = [
        ("slab", _Slab),
        ("mu0", c_double),
        ("streams", c_int),
        ("nodes", c_int),
        ("delta_m", c_int),
        ("orders", c_int),
        ("at", _Grid),
    ]


class _Sweep(Structure):
    _fields_ = (
        [(name, DOUBLES) for name in ("albedo", "g", "thickness", "mu0", "phi")]
        + [
            (name, c_size_t)
            for name in ("n_albedo", "n_g", "n_thickness", "n_mu0", "n_depths", "n_phi")
        ]
        + [("streams", c_int), ("nodes", c_int)]
    )


class Refused(Exception):
    """ppscat returned a status other than success."""


def _pointer(array):
    return array.ctypes.data_as(DOUBLES)


class Ppscat:
    def __init__(self, shim):
        self.lib = ctypes.CDLL(shim)
        self.lib.pps_status_string.restype = ctypes.c_char_p
        self.lib.pps_version.restype = ctypes.c_char_p

    @property
    def version(self):
        return self.lib.pps_version().decode()

    def _judge(self, status):
        if status:
            raise Refused(self.lib.pps_status_string(status).decode())

    def _case(self, case, streams=0, nodes=NODES_AUTO, delta_m=DELTA_M_AUTO, orders=0):
        n_mu, n_phi = len(case.mu), len(case.phi)
        grid = _Grid(
            len(case.tau),
            n_mu,
            n_phi,
            _pointer(case.tau),
            _pointer(case.mu),
            _pointer(case.phi),
        )
        slab = _Slab(case.albedo, case.g, case.thickness)
        radiance = np.empty((len(case.tau), n_mu, n_phi))
        flux = np.empty((len(case.tau), len(FLUX_FIELDS)))
        c = _Case(slab, case.mu0, streams, nodes, delta_m, orders, grid)
        return c, radiance, flux

    def run(self, case, what=WHOLE_CASE, repeats=1, with_flux=True, **opts):
        """Seconds a repeat, radiance[tau, mu, phi], flux[tau, FLUX_FIELDS]."""
        c, radiance, flux = self._case(case, **opts)
        seconds = c_double()
        self._judge(
            self.lib.peers_run(
                byref(c),
                what,
                repeats,
                _pointer(radiance),
                _pointer(flux) if with_flux else None,
                byref(seconds),
            )
        )
        return seconds.value, radiance, flux

    def reference(self, case):
        """`exact` to 1e-10, or to the next tolerance that it does not refuse."""
        c, radiance, flux = self._case(case)
        for tolerance in (1e-10, 1e-9, 1e-8, 1e-6):
            status = self.lib.peers_reference(
                byref(c), c_double(tolerance), _pointer(radiance), _pointer(flux)
            )
            if status != TOLERANCE_MISSED:
                break
        self._judge(status)
        return tolerance, radiance, flux

    def eigenvalues(self, case, m, **opts):
        c, _, _ = self._case(case, **opts)
        k = np.empty(opts["streams"] // 2)
        self._judge(self.lib.peers_eigenvalues(byref(c), m, _pointer(k)))
        return k

    def nodes(self, case, **opts):
        c, _, _ = self._case(case, **opts)
        mu = np.empty(opts["streams"] // 2)
        self._judge(self.lib.peers_nodes(byref(c), _pointer(mu)))
        return mu

    def sweep(self, lists, radiances, nodes):
        """Seconds of the sweep, its radiances (if asked for) and fluxes."""
        phi = lists.phi if radiances else lists.phi[:0]
        s = _Sweep(
            *(
                _pointer(a)
                for a in (lists.albedo, lists.g, lists.thickness, lists.mu0, phi)
            ),
            *(len(a) for a in (lists.albedo, lists.g, lists.thickness, lists.mu0)),
            lists.n_depths,
            len(phi),
            lists.streams,
            nodes,
        )
        n = lists.n_cases
        flux = np.empty((n, lists.n_depths, len(FLUX_FIELDS)))
        radiance = np.empty(
            (n if radiances else 0, lists.n_depths, lists.streams, len(phi))
        )
        seconds = c_double()
        self._judge(
            self.lib.peers_sweep(
                byref(s), _pointer(radiance), _pointer(flux), byref(seconds)
            )
        )
        return seconds.value, radiance, flux
