#!/usr/bin/env python3
"""How fast the server is beside nginx, and what crowds and changes do to it.

Builds what it needs, prints Markdown, and leaves it as OUT/serve.md with the figures as
OUT/serve.json. Ends with 1 if a limit does not hold. See bench/README.md.
"""

import argparse
import json
import os
import pathlib
import shutil
import subprocess
import sys

sys.dont_write_bytecode = True  # no __pycache__ in the source tree

import changes
import crowds
import rates
import samples
import servers

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
SECTIONS = {"http": rates.http, "tls": rates.tls, "calls": rates.calls, "idle": crowds.idle,
            "stalled": crowds.stalled, "slow": crowds.slow, "reload": changes.reload,
            "drain": changes.drain}
PROGRAMS = ["ip", "nginx", "openssl", "slowhttptest", "strace", "wrk"]


NETWORK = """ip link set lo up
for range in 127.0.0.0/8 127.0.0.1; do
  ip route change table local local $range dev lo proto kernel scope host src 127.0.0.1 \\
    congctl cubic
done
exec "$@"
"""


def enter_own_network():
    """Starts this program again in a network namespace that has nothing but a loopback interface,
    with Debian's default congestion control. (BBR, which some machines have, paces even that.)"""
    if "PMESH_BENCH_NETWORK" in os.environ:
        return
    os.environ["PMESH_BENCH_NETWORK"] = "1"
    as_root = [] if os.geteuid() == 0 else ["--map-root-user"]
    os.execvp("unshare", ["unshare", *as_root, "--net", "sh", "-ec", NETWORK, "sh",
                          sys.executable, *sys.argv])


class Load:
    """A serve_load that runs; its last line is its result."""

    def __init__(self, command):
        self.process = subprocess.Popen([str(word) for word in command], stdout=subprocess.PIPE,
                                        text=True)

    def wait_until_open(self):
        if self.process.stdout.readline() != "open\n":
            sys.exit(f"{' '.join(self.process.args)}: failed")

    def result(self):
        output, _ = self.process.communicate()
        if self.process.returncode != 0:
            sys.exit(f"{' '.join(self.process.args)}: failed")
        return json.loads(output.splitlines()[-1])


class Bench:
    """What the sections share: the programs, the samples, how long to measure."""

    def __init__(self, arguments):
        self.program = arguments.pmesh or arguments.build / "cli" / "pmesh"
        self.load_program = arguments.build / "bench" / "serve" / "serve_load"
        self.cache = arguments.build / "cache"
        self.out = arguments.out
        self.seconds, self.rounds = arguments.seconds, arguments.rounds

    def sample(self, name):
        return samples.noise(self.program, self.cache / "meshes", name)

    def pmesh(self, files, flags=(), tls_folder=None):
        return servers.Pmesh(self.program, files, self.out / "pmesh.log", flags, tls_folder)

    def start_ask(self, port, *options):
        return Load([self.load_program, "ask", "--port", port, *options])

    def ask(self, port, *options):
        return self.start_ask(port, *options).result()

    def hold(self, port, kind, count, seconds, path="/health"):
        """A crowd; returns once all its connections are open."""
        load = Load([self.load_program, "hold", "--port", port, "--kind", kind, "--connections",
                     count, "--addresses", count, "--seconds", seconds, "--path", path])
        load.wait_until_open()
        return load


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("sections", nargs="*", metavar="SECTION", default=list(SECTIONS),
                        help=f"default: all of {' '.join(SECTIONS)}")
    parser.add_argument("--seconds", type=int, default=3, help="of one run of wrk")
    parser.add_argument("--rounds", type=int, default=5, help="in which the servers take turns")
    parser.add_argument("--pmesh", type=pathlib.Path, help="this program, instead of building it")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build" / "serve",
                        metavar="DIR")
    parser.add_argument("--out", type=pathlib.Path, metavar="DIR", help="default: BUILD/out")
    arguments = parser.parse_args()
    if unknown := set(arguments.sections) - set(SECTIONS):
        parser.error(f"unknown sections: {' '.join(unknown)}")
    arguments.build = arguments.build.resolve()
    arguments.out = (arguments.out or arguments.build / "out").resolve()
    arguments.out.mkdir(parents=True, exist_ok=True)
    return arguments


def build(arguments):
    missing = [program for program in PROGRAMS if not shutil.which(program)]
    if missing:
        sys.exit(f"missing: {' '.join(missing)}; scripts/deps.sh bench installs them")
    for command in (["cmake", "-S", ROOT, "-B", arguments.build, "-G", "Ninja",
                     "-DCMAKE_BUILD_TYPE=Release", "-DPMESH_BUILD_TESTS=OFF",
                     "-DPMESH_BUILD_BENCH=ON"],
                    ["cmake", "--build", arguments.build, "--target", "serve_load"]
                    + ([] if arguments.pmesh else ["pmesh"])):
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"{command[0]} failed:\n{done.stdout}{done.stderr}")


def main():
    arguments = parse_arguments()
    build(arguments)
    enter_own_network()
    bench = Bench(arguments)
    found = {}
    for name in arguments.sections:
        print(f"section {name}", flush=True)
        found[name] = SECTIONS[name](bench)
        print(found[name].markdown(), flush=True)
    verdicts = [verdict for section in found.values() for verdict in section.verdicts]
    failed = [f"- {what}: {measured}, wanted {limit}\n"
              for what, measured, limit, passed in verdicts if not passed]
    summary = f"\n{len(verdicts) - len(failed)} of {len(verdicts)} limits hold.\n" + "".join(failed)
    text = "# The server, measured\n" + "".join(s.markdown() for s in found.values()) + summary
    (arguments.out / "serve.md").write_text(text)
    (arguments.out / "serve.json").write_text(
        json.dumps({name: section.figures for name, section in found.items()}, indent=1) + "\n")
    print(summary)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
