"""Crowds that do no work, and what they do to those who do: sections `idle`, `stalled`, `slow`."""

import statistics
import subprocess
import time

import report
import servers
import system

ACTIVE = 50
ACTIVE_RATE = 1000  # requests a second, of all
BYTES = 64 * 1024


def ask_for_ranges(bench, server, sample):
    """The active ones: ranges of 64 KiB at a fixed rate, every byte checked."""
    return bench.ask(server.port, "--connections", ACTIVE, "--addresses", ACTIVE,
                     "--first-address", 500_000, "--rate", ACTIVE_RATE,
                     "--seconds", 2 * bench.seconds, "--path", sample.target,
                     "--range", f"{2**20}-{2**20 + BYTES - 1}",
                     "--file", sample.path, 2**20, BYTES)


def middle_p99(runs):
    return statistics.median(run["p99_ms"] for run in runs)


def judge_active(found, alone, among):
    """The active ones' errors, and what the others cost them."""
    found.text += report.table(
        ["active connections", "requests", "errors", "p50 ms", "p99 ms", "max ms"],
        [[name, *(str(run[key]) for key in ("requests", "errors")),
          *(f"{run[key]:.2f}" for key in ("p50_ms", "p99_ms", "max_ms"))]
         for name, runs in (("alone", alone), ("among them", among)) for run in runs])
    found.exactly("errors of the active", sum(run["errors"] for run in alone + among), 0)
    found.at_most("p99 against that without them", middle_p99(among) / middle_p99(alone), 2)
    found.figures |= {"alone": alone, "among": among}


def idle(bench, count=10_000):
    """Alone and among the idle ones in turns."""
    sample = bench.sample("ten")
    alone, among, sizes, lost = [], [], [], 0
    with bench.pmesh(sample.path.parent) as server:
        for _ in range(bench.rounds):
            alone.append(ask_for_ranges(bench, server, sample))
            crowd = bench.hold(server.port, "idle", count, seconds=2 * bench.seconds + 5)
            among.append(ask_for_ranges(bench, server, sample))
            sizes.append(server.memory())
            lost += crowd.result()["ended"]
    found = report.Section(f"{count} idle and {ACTIVE} active connections",
                           "`pmesh serve` with its defaults, one address an idle "
                           f"connection; {ACTIVE_RATE} ranges of 64 KiB a second.\n\n",
                           {"memory": sizes})
    judge_active(found, alone, among)
    found.exactly("idle connections ended", lost, 0)
    most = {key: max(size[key] for size in sizes) for key in sizes[0]}
    found.at_most("resident memory", most["rss"], 64 * 2**20, report.mib)
    found.text += f"\nPrivate memory: {report.mib(most['private'])}.\n"
    return found


def stalled(bench, count=1000, timeout=30):
    sample = bench.sample("large")
    with bench.pmesh(sample.path.parent) as server:
        alone = [ask_for_ranges(bench, server, sample) for _ in range(bench.rounds)]
        private, kernel = server.memory()["private"], system.tcp_bytes()
        with system.Sampler(system.tcp_bytes, 0.2) as sampler:
            crowd = bench.hold(server.port, "stall", count, seconds=timeout + 15,
                               path=sample.target)
            time.sleep(1)
            each = (server.memory()["private"] - private) / count
            rounds = min(bench.rounds, int((timeout - 5) // (2 * bench.seconds)))
            among = [ask_for_ranges(bench, server, sample) for _ in range(rounds)]
            gone = crowd.result()
    found = report.Section(f"{count} readers of {report.mib(sample.file_bytes)} who read nothing",
                           f"`pmesh serve` with its defaults, one address a connection; the "
                           f"others: {ACTIVE_RATE} ranges of 64 KiB a second.\n\n",
                           {"gone": gone, "bytes_each": each, "kernel": sampler.most - kernel})
    judge_active(found, alone, among)
    found.at_most("server memory for each, KiB", each / 1024, 16)
    found.at_most("kernel TCP memory", sampler.most - kernel, 2**29, report.mib)
    found.exactly("ended by the server", gone["ended"] - gone["refused"], count)
    found.at_most("seconds until the last was gone", gone["longest_seconds"], timeout + 2)
    return found


def drip_headers(bench, server, count, health):
    """`count` connections with headers that never end, while /health is asked."""
    with system.Sampler(lambda: system.health_milliseconds(server.port, health), 0.02) as sampler:
        gone = bench.hold(server.port, "drip", count, seconds=30).result()
    return {"gone": gone, "health_ms": sampler.most}


def slowhttptest(server, mode):
    """Slow headers (H), bodies (B) or reading (X), from 127.0.0.1, while /health is asked."""
    options = {"H": ["-H"], "B": ["-B", "-s", "8192"], "X": ["-X", "-w", "512", "-y", "1024",
                                                             "-n", "5", "-z", "32"]}[mode]
    with system.Sampler(lambda: system.health_milliseconds(server.port), 0.02) as sampler:
        subprocess.run(["slowhttptest", *options, "-c", "5000", "-r", "2500", "-i", "2", "-l", "15",
                        "-u", f"http://127.0.0.1:{server.port}/health"],
                       check=True, capture_output=True)
    return sampler.most


def slow(bench, count=5000):
    sample = bench.sample("ten")
    with bench.pmesh(sample.path.parent) as server:
        ours = drip_headers(bench, server, count, "/health")
        tools = {mode: slowhttptest(server, mode) for mode in "HBX"}
    files = bench.cache / "nginx-files"
    files.mkdir(parents=True, exist_ok=True)
    (files / "health").write_text("ok\n")
    with servers.Nginx(files, bench.out / "nginx", cached=True) as server:
        theirs = drip_headers(bench, server, count, "/health")
    rows = [[name, str(run["gone"]["ended"]), f"{run['gone']['longest_seconds']:.1f}",
             str(run["gone"]["statuses"]), f"{run['health_ms']:.1f}"]
            for name, run in (("pmesh", ours), ("nginx", theirs))]
    rows += [[f"pmesh, slowhttptest -{mode}", "", "", "", f"{most:.1f}"]
             for mode, most in tools.items()]
    found = report.Section(
        f"{count} connections with headers that never end",
        "`pmesh serve` with its defaults, one address a connection, a field a second; slowhttptest "
        "comes from one address.\n\n"
        + report.table(["server", "ended", "seconds until the last", "answers",
                        "/health at most, ms"], rows),
        {"pmesh": ours, "nginx": theirs, "slowhttptest": tools})
    found.exactly("ended", ours["gone"]["ended"], count)
    found.at_most("seconds until the last was gone", ours["gone"]["longest_seconds"], 10)
    found.at_most("/health meanwhile, ms", ours["health_ms"], 200)
    for mode, most in tools.items():
        found.at_most(f"/health during slowhttptest -{mode}, ms", most, 200)
    return found
