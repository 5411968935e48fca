"""The peers behind one interface, each in its best documented configuration.

A peer's `prepare` configures a case and returns two functions: `solve()` computes the
case once, results in the peer's own memory; `read()` brings them into our conventions:
mu > 0 down, radiance[tau, mu, phi], diffuse fluxes. Its `sweep` returns a function that
does a whole sweep, of how many cases, and one that reads the last of them.

SPDX-License-Identifier: GPL-3.0-or-later
"""

import importlib
import importlib.metadata
import math
import warnings

import numpy as np

PI = math.pi


class Answer:
    def __init__(self, up, down, mean=None, radiance=None):
        self.up, self.down, self.mean, self.radiance = up, down, mean, radiance


def moments(case, streams, plain):
    """HG moments: cut at `streams` for the plain discrete problem, else to 1e-10."""
    if plain:
        chi = case.g ** np.arange(streams + 1.0)
        chi[streams:] = 0  # no delta-M: it starts when this moment is not zero
        return chi
    n = streams
    if 0 < abs(case.g) < 1:
        n = max(n, math.ceil(math.log(1e-10) / math.log(abs(case.g))))
    return case.g ** np.arange(n + 1.0)


def ascending(radiance, mu_up):
    """radiance[tau, mu, phi] at cosines that count upwards, in our order."""
    return radiance[:, np.argsort(-mu_up)]


class Peer:
    fluxes_only = False

    def __init__(self):
        self.module = importlib.import_module(self.package)
        self.version = importlib.metadata.version(self.package)

    def supports(self, case, streams):
        return True


class Nanodisort(Peer):
    """cdisort. Delta-M, every azimuthal order, Nakajima-Tanaka correction: here as
    accurate as the default one of Buras and Emde and 1.1 to 100 times faster."""

    package, name = "nanodisort", "peer:nanodisort"

    def prepare(self, case, streams, fluxes_only=False, plain=False):
        chi = moments(case, streams, plain)
        ds = self.module.DisortState()
        ds.nstr, ds.nlyr, ds.nmom, ds.ntau = streams, 1, len(chi) - 1, len(case.tau)
        ds.usrtau = ds.lamber = ds.quiet = True
        ds.onlyfl, ds.usrang = fluxes_only, not fluxes_only
        if not fluxes_only:
            ds.numu, ds.nphi = len(case.mu), len(case.phi)
        ds.intensity_correction = ds.old_intensity_correction = not plain
        ds.allocate()
        ds.dtauc, ds.ssalb = np.array([case.thickness]), np.array([case.albedo])
        ds.pmom, ds.utau = chi.reshape(-1, 1), case.tau
        if not fluxes_only:
            ds.umu, ds.phi = -case.mu[::-1], case.phi
        ds.fbeam, ds.umu0, ds.phi0 = 1.0, case.mu0, 0.0
        ds.albedo = ds.fisot = ds.accur = 0.0

        def read():
            mean = np.array(ds.uavgdn) + np.array(ds.uavgup)
            uu = None
            if not fluxes_only:
                uu = np.transpose(np.array(ds.uu), (1, 0, 2))[:, ::-1]
            return Answer(np.array(ds.flup), np.array(ds.rfldn), mean, uu)

        return ds.solve, read

    def sweep(self, lists, radiances):
        """A batch of all (albedo, g, thickness) for each mu0, on one thread; radiance
        at its nodes, uncorrected, which is cheaper for it."""
        slabs, n_mom = lists.slabs(), lists.streams
        solver = self.module.BatchSolver(nthreads=1)
        solver.nstr, solver.nlyr, solver.nmom = lists.streams, 1, n_mom
        solver.intensity_correction = solver.old_intensity_correction = False
        solver.ntau, solver.usrtau = lists.n_depths, True
        solver.usrang, solver.onlyfl = False, not radiances
        solver.lamber = solver.quiet = True
        solver.phi0 = solver.fisot = solver.accur = 0.0
        if radiances:
            solver.numu, solver.nphi = lists.streams, len(lists.phi)
            solver.set_phi(lists.phi)
        chi = np.stack([c.g ** np.arange(n_mom + 1.0) for c in slabs], axis=-1)

        def solve():
            for mu0 in lists.mu0:
                solver.umu0 = mu0
                solver.allocate(len(slabs))
                solver.set_dtauc(np.array([[c.thickness] for c in slabs]))
                solver.set_ssalb(np.array([[c.albedo] for c in slabs]))
                solver.set_pmom(np.asfortranarray(chi[:, None, :]))
                solver.set_utau_batched(np.stack([c.tau for c in slabs]))
                solver.set_fbeam(np.ones(len(slabs)))
                solver.set_albedo(np.zeros(len(slabs)))
                solver.solve()

        def read_last():
            up = np.array(solver.flup)[-1]
            if not radiances:
                return up, None
            uu = np.array(solver.uu)[-1]  # [mu up, ascending; tau; phi]
            return up, uu.transpose(1, 0, 2)[:, ::-1]

        return solve, lists.n_cases, read_last


class PythonicDisort(Peer):
    """Delta-M, every azimuthal order, radiance between its nodes by its own
    interpolation with the Nakajima-Tanaka correction at the directions asked for
    ("eval", its most accurate choice); Legendre table kept between cases."""

    package, name = "PythonicDISORT", "peer:PythonicDISORT"

    def __init__(self):
        super().__init__()
        self.subroutines = importlib.import_module("PythonicDISORT.subroutines")
        warnings.simplefilter("ignore")

    def prepare(self, case, streams, fluxes_only=False, plain=False):
        chi = moments(case, streams, plain)
        f = 0 if plain else case.g**streams
        correct = "eval" if f > 0 and len(chi) > streams else None
        mu, phi, last = -case.mu, np.radians(case.phi), []

        def solve():
            out = self.module.pydisort(
                case.thickness,
                case.albedo,
                streams,
                chi,
                case.mu0,
                1.0,
                0.0,
                NLeg=streams,
                f_arr=f,
                only_flux=fluxes_only,
                cache_asso_leg="no_mu0",
            )
            u = None
            if not fluxes_only:
                u = self.subroutines.interpolate(out[4], NT_cor=correct)
                u = u(mu, case.tau, phi)
            last[:] = [out[1](case.tau), out[2](case.tau)[0], out[3], u]

        def read():
            up, down, u0, u = last
            act = self.subroutines.generate_diff_act_flux_funcs(u0)
            mean = (act[0](case.tau) + act[1](case.tau)) / (4 * PI)
            return Answer(up, down, mean, None if u is None else u.transpose(1, 0, 2))

        return solve, read

    def sweep(self, lists, radiances):
        """Every eighth case: it is slow."""
        cases, phi, last = lists.cases()[7::8], np.radians(lists.phi), []

        def solve():
            for c in cases:
                out = self.module.pydisort(
                    c.thickness,
                    c.albedo,
                    lists.streams,
                    c.g ** np.arange(lists.streams + 1.0),
                    c.mu0,
                    1.0,
                    0.0,
                    NLeg=lists.streams,
                    f_arr=c.g**lists.streams,
                    only_flux=not radiances,
                    cache_asso_leg="no_mu0",
                )
                u = out[4](c.tau, phi) if radiances else None
                last[:] = out[0], out[1](c.tau), out[2](c.tau), u

        def read_last():
            mu, up, _, u = last
            return up, ascending(u.transpose(1, 0, 2), mu) if radiances else None

        return solve, len(cases), read_last


class Disortpp(Peer):
    """Delta-M, every azimuthal order, Nakajima-Tanaka correction (it takes both flags).
    Fluxes by the general solver: the flux-only one gives no depths inside a layer, and
    with ten layers for ten depths it is eight times slower."""

    package, name = "disortpp", "peer:disortpp"

    def supports(self, case, streams):
        return streams >= 4

    def config(self, streams, n_moments, n_tau, fluxes_only, corrected):
        c = self.module.DisortConfig(1, streams, n_moments)
        c.flags.use_lambertian_surface = c.flags.use_user_tau = True
        c.flags.comp_only_fluxes = fluxes_only
        c.flags.intensity_corr_buras = c.flags.intensity_corr_nakajima = corrected
        c.num_user_tau = n_tau
        c.accuracy_fourier_series = 0.0
        c.bc.direct_beam_flux, c.bc.direct_beam_phi = 1.0, 0.0
        c.bc.surface_albedo = 0.0
        return c

    def prepare(self, case, streams, fluxes_only=False, plain=False):
        chi = moments(case, streams, plain)
        corrected = not plain and not fluxes_only
        c = self.config(streams, len(chi) - 1, len(case.tau), fluxes_only, corrected)
        if not fluxes_only:
            c.flags.use_user_mu = True
            c.num_user_mu, c.num_phi = len(case.mu), len(case.phi)
        c.allocate()
        c.delta_tau, c.single_scat_albedo = [case.thickness], [case.albedo]
        c.phase_function_moments = [list(chi)]
        c.tau_user = list(case.tau)
        if not fluxes_only:
            c.mu_user, c.phi_user = list(-case.mu[::-1]), list(case.phi)
        c.bc.direct_beam_mu = case.mu0
        solver, last = self.module.DisortSolver(), [None]

        def solve():
            last[0] = solver.solve(c)

        def read():
            r = last[0]
            mean = np.array(r.mean_intensity_down) + np.array(r.mean_intensity_up)
            u = None if fluxes_only else np.array(r.intensity)[:, ::-1]
            return Answer(np.array(r.flux_up), np.array(r.flux_down), mean, u)

        return solve, read

    def sweep(self, lists, radiances):
        """Its spectral loop over the (albedo, g), for each thickness and mu0. It has
        radiance only in directions asked for: those of its nodes."""
        pairs = [(a, g) for a in lists.albedo for g in lists.g]
        n_mom = lists.streams + 1
        c = self.config(lists.streams, n_mom, lists.n_depths, not radiances, False)
        if radiances:
            c.flags.use_user_mu = True
            c.num_user_mu, c.num_phi = lists.streams, len(lists.phi)
        c.allocate()
        if radiances:
            x = np.polynomial.legendre.leggauss(lists.streams // 2)[0]
            mu = (x + 1) / 2
            c.mu_user = list(np.concatenate([-mu[::-1], mu]))
            c.phi_user = list(lists.phi)
        last = [None]
        chi = [[list(g ** np.arange(n_mom + 1.0))] for _, g in pairs]
        albedo = [[a] for a, _ in pairs]

        def solve():
            for w in lists.thickness:
                c.tau_user = list(np.linspace(0, w, lists.n_depths))
                for mu0 in lists.mu0:
                    c.bc.direct_beam_mu = mu0
                    last[0] = self.module.solve_spectral(
                        c,
                        [1.0] * len(pairs),
                        delta_tau=[[w]] * len(pairs),
                        single_scat_albedo=albedo,
                        phase_function_moments=chi,
                    )

        def read_last():
            r = last[0][-1]
            u = np.array(r.intensity)[:, ::-1] if radiances else None
            return np.array(r.flux_up), u

        return solve, lists.n_cases, read_last


class Iadpython(Peer):
    """Adding-doubling, total reflectance and transmittance at normal incidence: all
    that it offers. Its quadrature points are those of a hemisphere: half the streams.
    """

    package, name = "iadpython", "peer:iadpython"
    fluxes_only = True

    def supports(self, case, streams):
        return case.mu0 == 1 and streams >= 4

    def prepare(self, case, streams, fluxes_only=True, plain=False):
        last = [None]

        def solve():
            sample = self.module.Sample(
                a=case.albedo, b=case.thickness, g=case.g, n=1, quad_pts=streams // 2
            )
            last[0] = sample.rt()

        def read():
            r, t = last[0][:2]
            diffuse = t - math.exp(-case.thickness)
            return Answer(np.array([r, 0.0]), np.array([0.0, diffuse]))

        return solve, read


def installed():
    """The peers that can be imported, and why the others cannot."""
    have, missing = [], []
    for kind in (Nanodisort, PythonicDisort, Disortpp, Iadpython):
        try:
            have.append(kind())
        except Exception as error:  # whatever a broken installation raises
            missing.append((kind.name, f"{type(error).__name__}: {error}"))
    return have, missing
