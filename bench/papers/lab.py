"""The programs and meshes that every section measures with."""

import pathlib
import sys
from dataclasses import dataclass

import tools  # of bench/peers


def wanted(command):
    """The JSON that a command prints. Ends the run if it fails."""
    printed = tools.run_json(command)
    if printed is None:
        sys.exit("failed: " + " ".join(map(str, command)))
    return printed


@dataclass(frozen=True)
class Lab:
    meshes: pathlib.Path  # folder of mesh files
    build: pathlib.Path
    lods: pathlib.Path  # folder to write levels of detail to
    rounds: int

    @property
    def peers(self):
        return self.build / "bench" / "peers"

    @property
    def pmesh(self):
        return self.build / "cli" / "pmesh"

    def papers(self, name):
        return self.build / "bench" / "papers" / f"papers_{name}"

    def mesh(self, name):
        path = self.meshes / name
        if not path.is_file():
            sys.exit(f"{path}: no such mesh")
        return path

    def levels(self, variant, mesh, levels, name=None):
        """[{level, faces, file}] of pmesh's metric, finest first.

        `name` begins the files' names, if that of the mesh does not do."""
        prefix = self.lods / f"{name or mesh.stem}_pmesh_{variant.replace(':', '_')}"
        run = wanted([self.peers / "peer_pmesh", variant, mesh, *levels, "--write", prefix])
        return run["lods"]

    def level(self, variant, mesh, level, name=None):
        """The file of that level."""
        return pathlib.Path(self.levels(variant, mesh, [level], name)[0]["file"])

    def distance(self, original, lod):
        """max, rms in the meshes' unit, max_relative, rms_relative to the diagonal."""
        return wanted([self.pmesh, "compare", original, lod, "--json"])

    def sharp_shares(self, original, lods):
        """By lod, the share of its faces in the most curved tenth of the original."""
        return wanted([self.papers("sharpest_tenth"), original, *lods])

    def feature_distance(self, original, lod, weight):
        """longest_side in the mesh's unit; max, rms in feature-sensitive space, where it is 1."""
        return wanted([self.papers("feature_distance"), original, lod, weight])

    def seconds(self, runs, mesh, rounds=None):
        """By name of `runs`, {name: (program of bench/peers, variant, level)}: the least CPU time
        of the rounds, in which they take turns."""
        found = {name: [] for name in runs}
        for _ in range(rounds or self.rounds):
            for name, (program, variant, level) in runs.items():
                found[name].append(wanted([self.peers / program, variant, mesh, level]))
        return {name: {"seconds": min(run["seconds"] for run in of_name),
                       "faces": of_name[0]["faces"]} for name, of_name in found.items()}
