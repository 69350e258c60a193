"""Decoding rates, and when the full mesh stands at the other end of a link."""

import draco
import tables  # of bench/peers
from lab import wanted

BITS = 12
MBITS = (5, 20, 100)  # a second


def measure(lab, mesh):
    return wanted([lab.program("decode_rates"), lab.pm_file(mesh, BITS),
                   draco.of_lattice(lab, mesh, BITS), lab.rounds])


def pm_stands(rates, mbits):
    """Seconds until the last split is applied: a section is decoded once its last byte is there
    and the section before is decoded."""
    decoded = 0
    for section in rates["sections"]:
        decoded = max(decoded, transfer(section["end"], mbits)) + section["seconds"]
    return decoded


def draco_stands(rates, mbits):
    return transfer(rates["draco"]["bytes"], mbits) + rates["draco"]["seconds"]


def base_stands(rates, mbits):
    """Seconds until there is a first picture."""
    return pm_stands({"sections": rates["sections"][:2]}, mbits)


def transfer(size, mbits):
    return 8 * size / (1e6 * mbits)


def report(figures, _counted, _plots):
    return {"decode_rates": rates_table(figures), "link_times": link_table(figures)}


def rates_table(figures):
    def row(mesh, f):
        draco_rate = f["vertices"] / f["draco"]["seconds"] / 1e6
        rate = f["splits"] / f["seconds"] / 1e6
        return [mesh, f"{f['splits']:,}", f"{rate:.2f}", f"{draco_rate:.2f}",
                f"{rate / draco_rate:.2f}"]

    return tables.table(["mesh", "splits", "pmesh, million splits a second",
                         "Draco, million vertices a second", "pmesh / Draco"],
                        [row(mesh, f) for mesh, f in figures.items()])


def link_table(figures):
    def cells(f, mbits):
        ours, theirs = pm_stands(f, mbits), draco_stands(f, mbits)
        return [f"{1000 * base_stands(f, mbits):.1f}", f"{1000 * ours:.1f}",
                f"{1000 * theirs:.1f}", f"{ours / theirs:.2f}"]

    header = ["mesh"]
    for mbits in MBITS:
        header += [f"{mbits} Mbit/s: base", "full", "Draco", "ratio"]
    return tables.table(header, [[mesh, *(cell for mbits in MBITS for cell in cells(f, mbits))]
                                 for mesh, f in figures.items()])
