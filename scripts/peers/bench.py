"""ppscat beside its peers: speed and error on the slabs of `ppscat chart`, the work of
a few typical calls, and the places where methods fail. Run by scripts/bench-peers.sh.

Seconds are CPU time a case, the least of several rounds in which the programs take
turns.

SPDX-License-Identifier: GPL-3.0-or-later
"""

import argparse
import contextlib
import csv
import math
import os
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

import peers
import ppscat
from cases import Case, SweepLists, even_azimuths, gauss_sphere
from failures import failures, relative

SLABS = {
    "thin": (0.9, 0.5, 0.1),
    "thick": (0.95, 0.0, 10.0),
    "forward-peaked": (0.95, 0.8, 10.0),
    "near-conservative": (0.999, 0.5, 50.0),
}
MU0 = (0.25, 0.6, 1.0)
STREAMS = (4, 8, 16, 32, 64)
CHART = (
    "method,setting,albedo,g,thickness,mu0,rms_abs,rms_rel,reflectance_error,"
    "setup_seconds,seconds,evaluations"
).split(",")


# ---- time ----


@contextlib.contextmanager
def quiet_errors():
    """Without what a C library writes to standard error whatever it is told."""
    kept, null = os.dup(2), os.open(os.devnull, os.O_WRONLY)
    os.dup2(null, 2)
    try:
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)
        os.close(null)


def repeat(function):
    """The timer of a Python callable: seconds of one of n repeats."""

    def timer(n):
        start = time.process_time()
        for _ in range(n):
            function()
        return (time.process_time() - start) / n

    return timer


def take_turns(timers, rounds, batch):
    """Least seconds and number of evaluations of every timer, in interleaved rounds of
    about `batch` seconds each."""
    best, count, n = {}, {}, {}
    for name, timer in timers.items():
        first = min(timer(1), timer(1))
        n[name] = max(1, min(100000, int(batch / max(first, 1e-9))))
        best[name], count[name] = first, 2
    for _ in range(rounds):
        for name, timer in timers.items():
            best[name] = min(best[name], timer(n[name]))
            count[name] += n[name]
    return best, count


class Clock:
    def __init__(self, quick):
        self.rounds, self.batch = (3, 0.005) if quick else (5, 0.03)

    def __call__(self, timers):
        return take_turns(timers, self.rounds, self.batch)


# ---- error ----


def errors(got, want, mu_weight, phi_weight):
    """rms_abs and rms_rel as `ppscat error` has them."""
    weight = mu_weight[:, None] * phi_weight
    square = (weight * (got - want) ** 2).sum(axis=(1, 2))
    mean = (weight * want).sum(axis=(1, 2))
    return math.sqrt(square.mean()), (np.sqrt(square) / mean).mean()


# ---- the chart ----


def exact_settings(g, streams):
    """Its defaults; and the very discretisation of the peers, every order summed (at
    g = 0 nobody sums the orders that are zero)."""
    orders = streams if g else 0
    return {
        f"streams={streams}": dict(streams=streams),
        f"streams={streams} nodes=gauss orders=all": dict(
            streams=streams, nodes=ppscat.NODES_GAUSS, orders=orders
        ),
    }


class Chart:
    def __init__(self, lib, have, clock):
        self.lib, self.have, self.clock, self.rows = lib, have, clock, []
        self.mu, self.mu_weight = gauss_sphere(16)
        self.phi, self.phi_weight = even_azimuths(19)

    def case(self, slab, mu0):
        share = np.array([0, 5, 10, 20, 30, 40, 50, 60, 75, 90, 100]) / 100
        tau = share * min(slab[2], 10)
        return Case(*slab, mu0, tau, self.mu, self.phi)

    def row(self, method, setting, c, radiance, reflectance, want, times):
        rms = ("", "")
        if radiance is not None:
            rms = errors(radiance, want[0], self.mu_weight, self.phi_weight)
        off = relative(reflectance, want[1])
        values = (method, setting, c.albedo, c.g, c.thickness, c.mu0, *rms, off, *times)
        self.rows.append(dict(zip(CHART, values)))

    def add(self, c, streams, want):
        timers, configure, answers = {}, {}, {}
        for setting, opts in exact_settings(c.g, streams).items():
            for what in (ppscat.CREATE, ppscat.ONE_MORE_BEAM):
                timers["exact", setting, what] = (
                    lambda n, what=what, opts=opts: self.lib.run(c, what, n, **opts)[0]
                )
            _, radiance, flux = self.lib.run(c, **opts)
            answers["exact", setting] = radiance, flux[0, 0]
        for peer in self.have:
            if not peer.supports(c, streams):
                continue
            setting = f"streams={streams}"
            start = time.process_time()
            solve, read = peer.prepare(c, streams)
            configure[peer.name] = time.process_time() - start
            timers[peer.name, setting, 0] = repeat(solve)
            solve()
            answer = read()
            answers[peer.name, setting] = answer.radiance, answer.up[0]
        best, count = self.clock(timers)
        for (method, setting), (radiance, reflectance) in answers.items():
            if method == "exact":
                setup = best[method, setting, ppscat.CREATE]
                key = method, setting, ppscat.ONE_MORE_BEAM
            else:
                setup, key = configure[method], (method, setting, 0)
            times = setup, best[key], count[key]
            self.row(method, setting, c, radiance, reflectance, want, times)

    def run(self):
        for name, slab in SLABS.items():
            for mu0 in MU0:
                c = self.case(slab, mu0)
                tolerance, radiance, flux = self.lib.reference(c)
                print(f"{name}, mu0 = {mu0}: reference to {tolerance}", flush=True)
                for streams in STREAMS:
                    self.add(c, streams, (radiance, flux[0, 0]))
        return self.rows


# ---- typical work at equal streams ----


def sweep_lists():
    return SweepLists(
        albedo=np.array([0.1, 0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 0.98, 0.99, 0.999]),
        g=np.array([0.75, 0.5, 0.0]),  # ends with 0: see check_last
        thickness=np.array([0.1, 0.3, 1.0, 2.0, 5.0, 10.0, 30.0, 100.0]),
        mu0=np.linspace(0.08, 0.98, 10),
        phi=even_azimuths(19)[0],
    )


def work_one_case(lib, have, clock, fluxes_only, mu0):
    """Streams and, a program, the seconds of a case from nothing."""
    tau = np.linspace(0, 10, 10)
    mu, phi = gauss_sphere(8)[0], even_azimuths(19)[0]
    c = Case(0.95, 0.5, 10.0, mu0, tau, mu, phi)
    if fluxes_only:
        c = replace(c, mu=mu[:0], phi=phi[:0])
    for streams in STREAMS:
        timers = {}
        for setting, opts in exact_settings(c.g, streams).items():
            opts = dict(opts, orders=1) if fluxes_only else opts
            name = "exact, gauss" if "gauss" in setting else "exact"
            timers[name] = lambda n, opts=opts: lib.run(
                c, ppscat.WHOLE_CASE, n, **opts
            )[0]
        for peer in have:
            if peer.fluxes_only or not peer.supports(c, streams):
                continue
            solve, _ = peer.prepare(c, streams, fluxes_only=fluxes_only)
            timers[peer.name] = repeat(solve)
        yield streams, clock(timers)[0]


def check_last(lib, lists, radiances, name, up, radiance):
    """A peer's last case against ours, which at g = 0 are one problem, uncorrected."""
    _, ours, flux = lib.sweep(lists, radiances, ppscat.NODES_GAUSS)
    off = np.max(np.abs(up[:-1] / flux[-1, :-1, 0] - 1))
    if radiances:
        off = max(off, np.max(np.abs(radiance - ours[-1])) / np.max(ours[-1]))
    print(f"{name}: the last case of its sweep differs by {off:.0e}", flush=True)
    if not off < 1e-6:
        sys.exit(f"{name} does not compute the sweep that is timed")


def work_sweep(lib, have, radiances, rounds):
    """Seconds a case of the 2,400-case sweep."""
    lists = sweep_lists()
    timers, cases, read_last = {}, {}, {}
    for name, nodes in (
        ("exact, gauss", ppscat.NODES_GAUSS),
        ("exact", ppscat.NODES_AUTO),
    ):
        timers[name] = lambda n, nodes=nodes: lib.sweep(lists, radiances, nodes)[0]
        cases[name] = lists.n_cases
    for peer in have:
        if hasattr(peer, "sweep"):
            solve, cases[peer.name], read_last[peer.name] = peer.sweep(lists, radiances)
            timers[peer.name] = repeat(solve)
    best = {name: math.inf for name in timers}
    with quiet_errors():
        for _ in range(rounds):
            for name, timer in timers.items():
                best[name] = min(best[name], timer(1) / cases[name])
    for name, read in read_last.items():
        check_last(lib, lists, radiances, name, *read())
    return best


# ---- tables ----


def markdown(path, rows):
    rows = [[str(x) for x in row] for row in rows]
    lines = ["| " + " | ".join(row) + " |" for row in rows]
    lines.insert(1, "|" + "---|" * len(rows[0]))
    path.write_text("\n".join(lines) + "\n")
    print("\n".join(lines), flush=True)


def short(seconds):
    for scale, unit in ((1, "s"), (1e-3, "ms"), (1e-6, "us")):
        if seconds >= scale:
            return f"{seconds / scale:.3g} {unit}"
    return f"{seconds * 1e9:.3g} ns"


def ratio(x):
    return f"{x:.0f}" if x >= 10 else f"{x:.1f}"


def work_row(name, best, others):
    ours = [best["exact, gauss"], best["exact"]]
    cells = [
        (
            f"{short(best[p])}: {ratio(best[p] / ours[0])} ({ratio(best[p] / ours[1])})"
            if p in best
            else "-"
        )
        for p in others
    ]
    return [name, *map(short, ours), *cells]


def work_tables(lib, have, clock, quick):
    others = [p.name for p in have if not p.fluxes_only]
    yield ["work", "ppscat, gauss", "ppscat, defaults", *others]
    for fluxes_only, mu0, what in (
        (True, 0.6, "fluxes at 10 depths"),
        (False, 0.6, "radiance 10 x 16 x 19"),
        (False, 1.0, "radiance 10 x 16 x 19, mu0 = 1"),
    ):
        for streams, best in work_one_case(lib, have, clock, fluxes_only, mu0):
            yield work_row(f"{what}, {streams} streams", best, others)
    for radiances in (False, True):
        best = work_sweep(lib, have, radiances, 1 if quick else 3)
        name = "2,400-case sweep, " + ("radiance" if radiances else "fluxes")
        yield work_row(name + ", a case", best, others)


def mean_ratio(rows, other, column):
    logs = [
        math.log(max(float(b[column]), 1e-17) / max(float(a[column]), 1e-17))
        for a, b in zip(rows, other)
    ]
    return math.exp(sum(logs) / len(logs)) if logs else math.nan


def equal_streams(rows, have):
    """Peer over ppscat at equal streams, means over mu0 = .25 and .6: time of a case
    from nothing, time of one more beam, rms_rel."""
    names = [p.name for p in have if not p.fluxes_only]
    yield ["slab", "streams", "ppscat rms_rel", *names]
    for slab, (albedo, g, thickness) in SLABS.items():
        for streams in STREAMS:
            chosen = [
                r
                for r in rows
                if (r["albedo"], r["g"], r["thickness"]) == (albedo, g, thickness)
                and r["mu0"] < 1
                and r["setting"] == f"streams={streams}"
            ]
            ours = [r for r in chosen if r["method"] == "exact"]
            whole = [dict(r, seconds=r["seconds"] + r["setup_seconds"]) for r in ours]
            cells = []
            for name in names:
                other = [r for r in chosen if r["method"] == name]
                cells.append(
                    f"{ratio(mean_ratio(whole, other, 'seconds'))} / "
                    f"{ratio(mean_ratio(ours, other, 'seconds'))} / "
                    f"{ratio(mean_ratio(ours, other, 'rms_rel'))}"
                )
            error = math.exp(sum(math.log(r["rms_rel"]) for r in ours) / len(ours))
            yield [slab, streams, f"{error:.1e}", *cells]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument(
        "--shim", required=True, help="tests/bench/peers_ppscat.c, built"
    )
    parser.add_argument("--out", type=Path, required=True, help="folder of the results")
    parser.add_argument("--hard-cases", required=True, help="the 113-bit cases, CSV")
    parser.add_argument("--quick", action="store_true", help="rough times")
    args = parser.parse_args()

    lib, clock = ppscat.Ppscat(args.shim), Clock(args.quick)
    have, missing = peers.installed()
    versions = [("ppscat", lib.version)] + [(p.name, p.version) for p in have]
    markdown(args.out / "versions.md", [("program", "version"), *versions, *missing])

    rows = Chart(lib, have, clock).run()
    with open(args.out / "chart.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, CHART, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    markdown(args.out / "equal-streams.md", list(equal_streams(rows, have)))
    markdown(args.out / "work.md", list(work_tables(lib, have, clock, args.quick)))
    markdown(args.out / "failures.md", list(failures(lib, have, args.hard_cases)))


if __name__ == "__main__":
    main()
