"""The programs that every section measures with, and the files that they share."""

import pathlib
import subprocess
import sys
from dataclasses import dataclass, field

import tools  # of bench/peers

LOD_BITS = 16  # of the files that LODs for Draco come from: as good as unquantised
SAMPLES = 200_000  # points a direction to measure distances with, besides all vertices


def wanted(command):
    """The JSON that a command prints. Ends the run if it fails."""
    printed = tools.run_json(command)
    if printed is None:
        sys.exit("failed: " + " ".join(map(str, command)))
    return printed


def run(command):
    return subprocess.run([str(word) for word in command], capture_output=True, text=True)


def carry_out(command):
    """Ends the run if the command fails."""
    done = run(command)
    if done.returncode != 0:
        sys.exit(f"failed: {' '.join(map(str, command))}\n{done.stdout}{done.stderr}")


@dataclass(frozen=True)
class Lab:
    build: pathlib.Path
    files: pathlib.Path  # folder to write to
    rounds: int  # of everything that is timed
    fineness: int  # of searches and curves: steps to a halving of the faces
    made: dict = field(default_factory=dict)  # what a file was made from: the file

    @property
    def pmesh(self):
        return self.build / "cli" / "pmesh"

    def program(self, name):
        return self.build / "bench" / "bytes" / f"bytes_{name}"

    def pm_file(self, mesh, bits):
        """The PM file that `pmesh precompute` makes by default at so many bits."""
        return self.precomputed(mesh, f"{mesh.stem}_q{bits}", "--quantization", bits)

    def precomputed(self, mesh, name, *options):
        file = self.files / f"{name}.pmesh"
        if file not in self.made:
            wanted([self.pmesh, "precompute", mesh, "-o", file, "--force", "--json", *options])
            self.made[file] = mesh
        return file

    def info(self, file):
        return wanted([self.pmesh, "info", file, "--json"])

    def lattice_mesh(self, pm_file):
        """A mesh file that Draco quantises, at the PM file's bits, to the PM file's lattice."""
        file = pm_file.with_suffix(".ply")
        if file not in self.made:
            self.made[file] = wanted([self.program("lattice_mesh"), pm_file, file])
        return file, self.made[file]

    def lod(self, mesh, faces):
        """The mesh file of the finest level of at most so many faces, by exact decimation."""
        source = self.precomputed(mesh, f"{mesh.stem}_lods", "--schedule", "exact", "--base-faces",
                                  4, "--quantization", LOD_BITS, "--no-measure")
        return self.extracted(source, faces)

    def extracted(self, pm_file, faces):
        file = self.files / f"{pm_file.stem}_{faces}.obj"
        if file not in self.made:
            file.unlink(missing_ok=True)
            carry_out([self.pmesh, "extract", pm_file, "--faces", faces, "-o", file])
            self.made[file] = pm_file
        return file

    def holds(self, pm_file, mesh):
        """Whether the PM file is sound and has exactly the triangles of the mesh, quantised."""
        done = run([self.pmesh, "verify", pm_file, "--source", mesh])
        if done.returncode != 0:
            print(f"  {done.stderr.strip()}", file=sys.stderr)
        return done.returncode == 0

    def distance(self, original, other):
        """max_relative and rms_relative: parts of the original's diagonal."""
        return wanted([self.pmesh, "compare", original, other, "--samples", SAMPLES, "--json"])
