"""The places where methods fail: ppscat and its peers against 113-bit solutions,
against their own neighbours and against converged answers.

SPDX-License-Identifier: GPL-3.0-or-later
"""

import csv
import math
import os
import pickle

import numpy as np

import peers
import ppscat
from cases import Case


def relative(got, want):
    return abs(got / want - 1)


def isolated(function):
    """The value of function(), from a child that may print, exit or crash at will."""
    ours, theirs = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(ours)
        null = os.open(os.devnull, os.O_WRONLY)
        os.dup2(null, 1)
        os.dup2(null, 2)
        try:
            value = function()
        except Exception as error:
            value = f"{type(error).__name__}"
        with os.fdopen(theirs, "wb") as pipe:
            pickle.dump(value, pipe)
        os._exit(0)
    os.close(theirs)
    with os.fdopen(ours, "rb") as pipe:
        data = pipe.read()
    _, status = os.waitpid(child, 0)
    if not data:
        code = os.waitstatus_to_exitcode(status)
        return f"exits ({code})" if code >= 0 else f"killed by signal {-code}"
    return pickle.loads(data)


class Program:
    """ppscat or a peer, as functions of a case."""

    def __init__(self, name, flat, full, plain):
        self.name, self.flat, self.full, self.plain = name, flat, full, plain


def programs(lib, have):
    def answer_of(case, **opts):
        _, radiance, flux = lib.run(case, **opts)
        return peers.Answer(flux[:, 0], flux[:, 1], flux[:, 3], radiance)

    def of_peer(peer):
        def answer(case, streams, **opts):
            solve, read = peer.prepare(case, streams, **opts)
            solve()
            return read()

        return answer

    yield Program(
        "exact",
        lambda c, n: answer_of(c, streams=n, orders=1),
        lambda c, n: answer_of(c, streams=n),
        lambda c, n: answer_of(
            c, streams=n, nodes=ppscat.NODES_GAUSS, delta_m=ppscat.DELTA_M_OFF, orders=1
        ),
    )
    for peer in have:
        f = of_peer(peer)
        if peer.fluxes_only:
            yield Program(peer.name, f, None, None)
            continue
        yield Program(
            peer.name,
            lambda c, n, f=f: f(c, n, fluxes_only=True),
            f,
            lambda c, n, f=f: f(c, n, fluxes_only=True, plain=True),
        )


GROUPS = (
    ("albedo = 0", lambda c: c.albedo == 0),
    ("albedo = 1", lambda c: c.albedo == 1),
    ("1 - albedo = 1e-15 .. 1e-9", lambda c: 0 < 1 - c.albedo < 2e-9),
    (
        "1 - albedo = 1e-8 .. 1e-1",
        lambda c: 0 < 1 - c.albedo and c.tag == "albedo_limit",
    ),
    ("thickness <= 1e-3", lambda c: c.thickness <= 1e-3),
    ("thickness >= 1e2", lambda c: c.thickness >= 1e2),
    ("thickness between", lambda c: True),
)


def hard_cases(path):
    """The 113-bit cases: group, case, streams, [R, T, mean intensity at mid-depth]."""
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            w = float(row["tau"])
            tau = np.array([0, w / 2, w])
            c = Case(float(row["omega"]), float(row["g"]), w, float(row["mu0"]), tau)
            c.mu = c.phi = np.zeros(0)
            c.tag = row["tag"]
            want = [
                float(row[k])
                for k in (
                    "reflectance",
                    "transmittance_diffuse",
                    "mean_intensity_mid_diffuse",
                )
            ]
            name = next(name for name, member in GROUPS if member(c))
            yield name, c, int(row["n_streams"]), want


def score(program, c, streams, want):
    """Worst relative error; a string when there is no answer."""

    def compute():
        a = program.plain(c, streams)
        got = a.up[0] / c.mu0, a.down[2] / c.mu0, a.mean[1]
        pairs = [(g, w) for g, w in zip(got, want) if w == 0 or abs(w) > 1e-30]
        return max(relative(g, w) if w else abs(g) for g, w in pairs)

    value = isolated(compute)
    return value if isinstance(value, str) or math.isfinite(value) else "not finite"


def hard_table(all_programs, path):
    results = {}
    for group, c, streams, want in hard_cases(path):
        for p in all_programs:
            if p.plain:
                value = score(p, c, streams, want)
                results.setdefault(group, {}).setdefault(p.name, []).append(value)
    return results


def hard_cell(values):
    numbers = [v for v in values if not isinstance(v, str)]
    good = sum(v <= 1e-10 for v in numbers)
    text = f"{good}/{len(values)}"
    if numbers:
        text += f", worst {max(numbers):.0e}"
    if len(numbers) < len(values):
        kinds = sorted({v for v in values if isinstance(v, str)})
        text += f", {len(values) - len(numbers)} {' / '.join(kinds)}"
    return text


DIRECTIONS = np.array([-0.95, -0.45, -0.12, 0.12, 0.45, 0.95])
AZIMUTHS = np.array([0.0, 70.0, 180.0])


def roughness(program, mu0, streams):
    """Fluxes and radiances at mu0 against the fourth-order mean of the program's own
    answers at four neighbours: (worst flux, worst radiance), relative."""

    def all_of(m):
        c = Case(0.95, 0.5, 2.0, m, np.array([0, 1.0, 2.0]), DIRECTIONS, AZIMUTHS)
        a = program.full(c, streams)
        fluxes = np.array([a.up[0], a.up[1], a.down[1], a.down[2]])
        return fluxes, a.radiance

    def compute():
        here, h = all_of(mu0), 1e-3 * min(1, 1 / mu0 - 1)
        mean = [0, 0]
        for weight, step in zip((-1, 4, 4, -1), (-2, -1, 1, 2)):
            side = all_of(mu0 * (1 + h * step))
            mean = [m + weight / 6 * s for m, s in zip(mean, side)]
        flux = np.max(np.abs(here[0] / mean[0] - 1))
        radiance = np.max(np.abs(here[1] - mean[1])) / np.max(np.abs(mean[1]))
        return float(flux), float(radiance)

    return isolated(compute)


def worst_roughness(program, beams, streams, which):
    values = [roughness(program, mu0, streams) for mu0 in beams]
    failed = [v for v in values if isinstance(v, str)]
    numbers = [v[which] for v in values if not isinstance(v, str)]
    if not numbers:
        return failed[0]
    text = "not finite" if not np.all(np.isfinite(numbers)) else f"{max(numbers):.0e}"
    return text + (f", {len(failed)} of {len(values)} {failed[0]}" if failed else "")


def special_beams(lib, streams):
    """Beams on the nodes, and on the resonances of orders 0 and 1."""
    c = Case(0.95, 0.5, 2.0, 0.6)
    opts = dict(streams=streams, nodes=ppscat.NODES_GAUSS, delta_m=ppscat.DELTA_M_ON)
    on_node = [m for m in lib.nodes(c, **opts)]
    resonant = []
    for m in (0, 1):
        k = lib.eigenvalues(c, m, orders=2, **opts)
        resonant.append([1 / x for x in k if x > 1.01])
    return on_node, *resonant


def energy(program, thickness):
    c = Case(1.0, 0.5, thickness, 1.0, np.array([0, thickness]))

    def compute():
        a = program.flat(c, 16)
        return float(abs(a.up[0] + a.down[1] + math.exp(-thickness) - 1))

    return isolated(compute)


def truth(lib, c):
    """`exact` to its tolerance; where it refuses all, 384 streams."""
    try:
        return lib.reference(c)[1:]
    except ppscat.Refused:
        return lib.run(c, streams=384)[1:]


def against_truth(want, program, c, streams, with_radiance):
    want_radiance, want_flux = want

    def compute():
        a = (program.full if with_radiance else program.flat)(c, streams)
        if not with_radiance:
            return float(relative(a.up[0], want_flux[0, 0]))
        return float(np.max(np.abs(a.radiance - want_radiance)) / np.max(want_radiance))

    return isolated(compute)


def cell(value):
    if isinstance(value, str):
        return value
    return f"{value:.0e}" if math.isfinite(value) else "not finite"


def failures(lib, have, hard_path):
    """The rows of the table of failures: a name, and one cell a program."""
    every = list(programs(lib, have))
    yield ["", *(p.name for p in every)]
    hard = hard_table(every, hard_path)
    for name, _ in GROUPS:
        if name in hard:
            cells = [hard_cell(hard[name][p.name]) if p.plain else "-" for p in every]
            yield [f"113-bit cases, {name}", *cells]
    for w in (1.0, 100.0, 1e4):
        name = f"albedo 1, thickness {w:g}, mu0 1: energy lost"
        yield [name, *(cell(energy(p, w)) for p in every)]
    node, resonant, resonant1 = special_beams(lib, 16)
    for name, beams, which in (
        ("mu0 on a node: flux", node, 0),
        ("mu0 on a node: radiance", node, 1),
        ("1/mu0 = eigenvalue, order 0: flux", resonant, 0),
        ("1/mu0 = eigenvalue, order 0: radiance", resonant, 1),
        ("1/mu0 = eigenvalue, order 1: radiance", resonant1, 1),
    ):
        cells = [worst_roughness(p, beams, 16, which) if p.full else "-" for p in every]
        yield [name, *cells]
    thin = Case(0.9, 0.5, 1e-6, 0.6, np.array([0, 5e-7, 1e-6]), DIRECTIONS, AZIMUTHS)
    peaked = Case(0.95, 0.99, 10.0, 0.6, np.array([0, 5, 10.0]), DIRECTIONS, AZIMUTHS)
    truth_of = {id(c): truth(lib, c) for c in (thin, peaked)}
    for c, name, streams, with_radiance in (
        (thin, "thickness 1e-6, 16 streams: reflectance", 16, False),
        (thin, "thickness 1e-6, 16 streams: radiance", 16, True),
        (peaked, "g 0.99, 16 streams: reflectance", 16, False),
        (peaked, "g 0.99, 64 streams: reflectance", 64, False),
        (peaked, "g 0.99, 16 streams: radiance", 16, True),
        (peaked, "g 0.99, 64 streams: radiance", 64, True),
    ):
        cells = []
        for p in every:
            if p.full:
                want = truth_of[id(c)]
                cells.append(cell(against_truth(want, p, c, streams, with_radiance)))
            else:
                cells.append("-")
        yield [name, *cells]
