"""Whether the decoded full mesh has exactly the quantised input's triangles, for every metric."""

import tables  # of bench/peers

METRICS = ("blended-qem", "melod", "qem --placement subset", "qem --placement solved", "memoryless",
           "feature-sensitive", "feature-sensitive --blow-up", "triangle")
BITS = 12


def measure(lab, mesh):
    return {metric: verified(lab, mesh, metric) for metric in METRICS}


def verified(lab, mesh, metric):
    name = "_".join([mesh.stem, *metric.replace("--", "").split()])
    file = lab.precomputed(mesh, name, "--metric", *metric.split(), "--quantization", BITS,
                           "--no-measure")
    return lab.holds(file, mesh)


def report(figures, _counted, _plots):
    rows = [[mesh, *("yes" if f[metric] else "**no**" for metric in METRICS)]
            for mesh, f in figures.items()]
    return {"lossless": tables.table(["mesh", *METRICS], rows)}
