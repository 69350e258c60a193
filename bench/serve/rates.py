"""CPU time a request and requests a second, beside nginx: sections `http` and `tls`; and the system
calls of both: section `calls`."""

import contextlib
import os
import re
import signal
import statistics
import subprocess
import sys
import time
from dataclasses import dataclass

import report
import samples
import servers
import system

CONNECTIONS = [1, 64, 1000]
UNLIMITED = ["--max-connections-per-address", "0"]
# wrk takes its TLS version and cipher from OpenSSL's settings, so that both servers get the same.
OPENSSL_SETTINGS = f"""openssl_conf = top
[top]
ssl_conf = ssl
[ssl]
system_default = default
[default]
MinProtocol = TLSv1.3
Ciphersuites = {servers.CIPHER}
"""


@dataclass(frozen=True)
class Case:
    name: str
    ours: str  # targets
    theirs: str
    range: str = ""


def make_cases(bench, files):
    """The cases, on pmesh and as files of nginx's folder `files`, which are written here."""
    files.mkdir(parents=True, exist_ok=True)
    small, sample = bench.sample("small"), bench.sample("ten")
    chunk = small.chunk_near(64 * 1024)
    offset, length = small.chunks[chunk]
    (files / "chunk.bin").write_bytes(small.part(offset, length))
    (files / "prefix.bin").write_bytes(sample.part(0, sample.prefix_within(2**20)))
    whole = files / "whole.bin"
    whole.unlink(missing_ok=True)
    whole.symlink_to(sample.path.resolve())
    for path in (small.path, sample.path, files / "chunk.bin", files / "prefix.bin"):
        samples.warm(path)
    middle = 5 * 2**20 + 321
    return [
        Case(f"chunk, {length} bytes", f"/{small.id}/{small.hash}/c/{chunk}", "/chunk.bin"),
        Case("wish of 1 MiB", f"{sample.target}?bytes={2**20}", "/prefix.bin"),
        Case("range of 1 MiB", sample.target, "/whole.bin", f"{middle}-{middle + 2**20 - 1}"),
        Case("range of 64 KiB", sample.target, "/whole.bin", f"{middle}-{middle + 2**16 - 1}"),
    ]


def start_servers(bench, tls):
    """pmesh, nginx, nginx with open_file_cache: running until the stack is closed."""
    stack = contextlib.ExitStack()
    files = bench.cache / "nginx-files"
    tls_folder = bench.out / "tls"
    if tls:
        servers.make_certificate(tls_folder)
    started = [stack.enter_context(server) for server in (
        bench.pmesh(bench.cache / "meshes", UNLIMITED, tls_folder if tls else None),
        servers.Nginx(files, tls_folder.with_name("nginx"), False, tls),
        servers.Nginx(files, tls_folder.with_name("nginx-cached"), True, tls))]
    return stack, started


def wrk(server, target, case, connections, seconds, bench):
    """One run: {cpu_us: CPU time a request in microseconds, rate: requests a second, errors}. With
    one connection wrk and the server share a CPU: on two, waking the other one costs either of the
    servers three times the request, or nothing, as the scheduler pleases."""
    cpus = {0} if connections == 1 else system.all_cpus()
    system.pin(server.pid, cpus)
    settings = bench.out / "openssl.cnf"
    settings.write_text(OPENSSL_SETTINGS)
    command = ["wrk", "-t", "1" if connections == 1 else "2", "-c", str(connections),
               "-d", str(seconds), "--timeout", "30s"]
    if case.range:
        command += ["-H", f"Range: bytes={case.range}"]
    url = f"{'https' if server.tls else 'http'}://127.0.0.1:{server.port}{target}"
    before = server.cpu_seconds()
    done = subprocess.run(command + [url], check=True, capture_output=True, text=True,
                          env={**os.environ, "OPENSSL_CONF": str(settings)},
                          preexec_fn=lambda: os.sched_setaffinity(0, cpus))
    spent = server.cpu_seconds() - before
    requests, elapsed = re.search(r"(\d+) requests in ([\d.]+)s", done.stdout).groups()
    if int(requests) == 0:
        sys.exit(f"{server.name} answered no request for {target}:\n{done.stdout}")
    errors = sum(map(int, re.findall(r"(?:connect|read|write|timeout|responses:?) (\d+)",
                                     done.stdout)))
    return {"cpu_us": 1e6 * spent / int(requests),
            "rate": int(requests) / float(elapsed), "errors": errors}


def target_on(server, case):
    return case.ours if server.name == "pmesh" else case.theirs


def measure(bench, cases, started):
    """A row a case and number of connections; the servers take turns in every round."""
    rows = []
    for case in cases:
        for connections in CONNECTIONS:
            rounds = []
            for _ in range(bench.rounds):
                rounds.append({server.name: wrk(server, target_on(server, case), case,
                                                connections, bench.seconds, bench)
                               for server in started})
            rows.append({"case": case.name, "connections": connections, "rounds": rounds})
            print(f"  {case.name}, {connections} connections: "
                  f"{worst_ratio(rounds, 'cpu_us'):.2f}", flush=True)
    return rows


def worst_ratio(rounds, figure):
    """pmesh's figure beside that of the better nginx, more than 1 if pmesh's is better: the median
    of the rounds."""
    def ratio(one, name):
        ours, theirs = one["pmesh"][figure], one[name][figure]
        return ours / theirs if figure == "rate" else theirs / ours

    names = [name for name in rounds[0] if name != "pmesh"]
    return min(statistics.median(ratio(one, name) for one in rounds) for name in names)


def rates_table(rows):
    names = list(rows[0]["rounds"][0])
    lines = []
    for row in rows:
        def middle(name, figure, row=row):
            return statistics.median(one[name][figure] for one in row["rounds"])

        lines.append([row["case"], str(row["connections"])]
                     + [f"{middle(name, 'cpu_us'):.1f}" for name in names]
                     + [f"{worst_ratio(row['rounds'], 'cpu_us'):.2f}"]
                     + [f"{middle(name, 'rate'):.0f}" for name in names]
                     + [f"{worst_ratio(row['rounds'], 'rate'):.2f}"])
    head = (["case", "connections"] + [f"{name}, CPU us a request" for name in names]
            + ["ratio"] + [f"{name}, requests a second" for name in names] + ["ratio"])
    return report.table(head, lines)


def section(bench, tls):
    cases = make_cases(bench, bench.cache / "nginx-files")
    stack, started = start_servers(bench, tls)
    with stack:
        rows = measure(bench, cases, started)
    found = report.Section(
        "TLS 1.3, " + servers.CIPHER if tls else "HTTP",
        f"`pmesh serve` with `{' '.join(UNLIMITED)}`; wrk on 127.0.0.1, {bench.rounds} rounds of "
        f"{bench.seconds} s; ratios to the better nginx, above 1 if pmesh is better.\n\n"
        + rates_table(rows), {"rows": rows})
    for row in rows:
        found.at_least(f"{row['case']}, {row['connections']} connections: CPU against nginx",
                       worst_ratio(row["rounds"], "cpu_us"), 0.8 if tls else 0.9)
    found.exactly("errors", sum(run["errors"] for row in rows for one in row["rounds"]
                                for run in one.values()), 0)
    return found


def http(bench):
    return section(bench, False)


def tls(bench):
    return section(bench, True)


def count_calls(server, case, bench):
    """{system call: how many a request}, by strace, which counts what begins while it looks."""
    summary = bench.out / "strace.txt"
    attach = [option for pid in system.family(server.pid) for option in ("-p", str(pid))]
    tracer = subprocess.Popen(["strace", "-f", "-c", "-o", summary, *attach],
                              stderr=subprocess.DEVNULL)
    time.sleep(1)
    run = wrk(server, target_on(server, case), case, 64, 2, bench)
    tracer.send_signal(signal.SIGINT)
    tracer.wait()
    calls = re.findall(r"^ *[\d.]+ +[\d.]+ +\d+ +(\d+)(?: +\d+)? +([a-z]\w*)$",
                       summary.read_text(), re.MULTILINE)
    return {name: int(count) / (2 * run["rate"]) for count, name in calls if name != "total"}


def calls(bench):
    case = make_cases(bench, bench.cache / "nginx-files")[3]
    stack, started = start_servers(bench, False)
    with stack:
        counts = {server.name: count_calls(server, case, bench) for server in started}
    names = sorted({name for of in counts.values() for name, share in of.items() if share > 0.005})
    rows = [[f"`{name}`"] + [f"{of.get(name, 0):.2f}" for of in counts.values()] for name in names]
    rows.append(["all"] + [f"{sum(of.values()):.2f}" for of in counts.values()])
    found = report.Section("System calls a request: " + case.name + ", 64 connections",
                           report.table(["call", *counts], rows), counts)
    found.at_least("sendfile(2) a request", counts["pmesh"].get("sendfile", 0), 0.9)
    return found
