"""How the time of the exact engine grows with the mesh."""

import math

import plot
import tables

MESHES = ["bunny.obj", "horse.ply", "igea.ply", "ct_engine_587k.ply", "dragon_vrip.ply",
          "happy_vrip_q14.ply", "terrain_sfbay_2.9m.ply"]
LARGE = MESHES[4:]  # one round of these is long
METRICS = ["blended-qem", "melod", "qem:placement=subset", "memoryless"]


def measure(lab):
    """times[mesh][metric] = {seconds, faces}"""
    runs = {metric: ("peer_pmesh", metric, "200") for metric in METRICS}
    times = {}
    for name in MESHES:
        mesh = lab.mesh(name)
        times[mesh.stem] = lab.seconds(runs, mesh, rounds=1 if name in LARGE else lab.rounds)
    return times


def report(times, plots):
    fits = {metric: fitted_constant([of_mesh[metric] for of_mesh in times.values()])
            for metric in METRICS}
    plots["growth.svg"] = plot.chart([time_panel(times, fits), constant_panel(times, fits)])
    rows = []
    for mesh, of_mesh in times.items():
        faces = of_mesh[METRICS[0]]["faces"]
        rows.append([mesh, f"{faces:,}"]
                    + [f"{of_mesh[m]['seconds']:.2f} ({constant(of_mesh[m]):.0f})"
                       for m in METRICS])
    rows.append(["fitted c, ns", ""] + [f"{fits[m]:.0f}" for m in METRICS])
    return {"growth_table": tables.table(["mesh", "faces n", *METRICS], rows),
            "growth_spread": spread(times, fits)}


def n_log_n(faces):
    return faces * math.log2(faces)


def constant(run):
    """Nanoseconds over n log2 n."""
    return 1e9 * run["seconds"] / n_log_n(run["faces"])


def fitted_constant(runs):
    """That of the curve c n log2 n with the least squares in the logarithm."""
    return math.exp(sum(math.log(constant(run)) for run in runs) / len(runs))


def spread(times, fits):
    """How far the measured times lie from the fitted curves, as factors."""
    factors = [constant(of_mesh[metric]) / fits[metric]
               for of_mesh in times.values() for metric in METRICS]
    return f"{min(factors):.2f} to {max(factors):.2f}"


def time_panel(times, fits):
    series = []
    faces = sorted(of_mesh[METRICS[0]]["faces"] for of_mesh in times.values())
    for number, metric in enumerate(METRICS):
        fit = [(n, 1e-9 * fits[metric] * n_log_n(n)) for n in faces]
        series.append(plot.Series(f"{metric}: c n log2 n, c = {fits[metric]:.0f} ns", fit,
                                  plot.colour(number), "dashed", marks=False))
        points = sorted((of_mesh[metric]["faces"], of_mesh[metric]["seconds"])
                        for of_mesh in times.values())
        series.append(plot.Series(f"{metric}: measured", points, plot.colour(number), "none"))
    return plot.Panel("time to 200 faces", faces_axis(), plot.Axis("CPU seconds"), series)


def constant_panel(times, fits):
    series = []
    for number, metric in enumerate(METRICS):
        runs = sorted((of_mesh[metric] for of_mesh in times.values()), key=lambda r: r["faces"])
        line = [(run["faces"], fits[metric]) for run in (runs[0], runs[-1])]
        series.append(plot.Series(f"{metric}: c n log2 n, c = {fits[metric]:.0f} ns", line,
                                  plot.colour(number), "dashed", marks=False))
        series.append(plot.Series(f"{metric}: measured",
                                  [(run["faces"], constant(run)) for run in runs],
                                  plot.colour(number), "none"))
    return plot.Panel("the same over n log2 n", faces_axis(),
                      plot.Axis("nanoseconds", log=False, from_zero=True), series)


def faces_axis():
    names = {1e5: "100 k", 2e5: "200 k", 5e5: "500 k", 1e6: "1 M", 2e6: "2 M"}
    return plot.Axis("faces n", names=names)
