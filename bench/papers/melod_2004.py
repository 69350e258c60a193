"""Table 1 and the drawings, figures 7, 9 and 10, of the MELOD paper. Figure 5 is in
error_curves.py."""

import json
import pathlib

import picture
import run as peers  # bench/peers/run.py
import tables

# The paper's table 1: faces, and the seconds of MELOD and of QSlim.
TABLE_1 = {"fandisk.obj": (12946, 0.98, 0.97), "bunny.obj": (69451, 4.65, 3.67),
           "horse.ply": (96966, 6.39, 5.28)}

RUNS = {"melod": ("peer_pmesh", "melod", "1"),
        "meshoptimizer": ("peer_meshoptimizer", "simplify", "1%")}

# The figures by number: model, the faces that are left, and from where it is seen.
DRAWN = {"7": ("cow.obj", "1198", picture.View(turn=120, rise=8, axes=(2, 0, 1), closed=True)),
         "9": ("horse.ply", "1596", picture.View(turn=60, rise=8, closed=True)),
         "10": ("happy_vrip_q14.ply", "3266",
                picture.View(turn=-90, rise=5, axes=(2, 0, 1), closed=True))}
DRAWN_METRICS = {"MELOD": "melod", "QEM": "qem:placement=solved"}


def measure(lab):
    """times[mesh][run] = {seconds, faces}, drawn[figure][metric] = file"""
    return {"times": {name: lab.seconds(RUNS, lab.mesh(name)) for name in TABLE_1},
            "drawn": {figure: {name: str(lab.level(metric, lab.mesh(mesh), faces))
                               for name, metric in DRAWN_METRICS.items()}
                      for figure, (mesh, faces, _) in DRAWN.items()}}


def report(data, plots):
    for figure, files in data["drawn"].items():
        _, faces, view = DRAWN[figure]
        plots[f"melod-figure-{figure}.svg"] = picture.strip(
            [(f"{name}, {faces} faces", *picture.read_ply(pathlib.Path(file)))
             for name, file in files.items()], view, size=300)
    return {"melod_table_1": table_1(data["times"])}


def table_1(times):
    earlier = json.loads((pathlib.Path(peers.__file__).parent / "earlier.json").read_text())
    qslim = earlier["speed"]["QSlim 2.1"]["time_to_meshoptimizer"]
    rows = []
    for mesh, (faces, melod, of_qslim) in TABLE_1.items():
        ours = times[mesh]["melod"]["seconds"]
        ratio = ours / times[mesh]["meshoptimizer"]["seconds"]
        name = pathlib.Path(mesh).stem
        rows.append([name, f"{faces:,}", f"{melod}", f"{of_qslim}", f"{melod / of_qslim:.2f}",
                     f"{ours:.3f}", f"{ratio:.1f}", f"{qslim[name]}", f"{ratio / qslim[name]:.2f}"])
    rows.append(["male", "605,902", "44.05", "35.58", "1.24", "-", "-", "-", "-"])
    header = ["model", "faces", "paper: MELOD, s", "paper: QSlim, s", "paper: MELOD / QSlim",
              "ours: MELOD, s", "ours / meshoptimizer", "QSlim / meshoptimizer", "ours / QSlim"]
    return tables.table(header, rows)
