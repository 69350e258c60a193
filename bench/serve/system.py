"""What the system knows: CPU time and memory of processes, memory of the kernel's TCP."""

import os
import pathlib
import re
import socket
import threading
import time

TICKS = os.sysconf("SC_CLK_TCK")
PAGE = os.sysconf("SC_PAGE_SIZE")


def family(pid):
    """The process and all that descend from it."""
    children = pathlib.Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
    return [pid] + [member for child in children for member in family(int(child))]


def all_cpus():
    return set(range(os.cpu_count()))


def pin(pid, cpus):
    """Keeps all threads of the process, and of all that descend from it, on these CPUs."""
    for member in family(pid):
        for thread in os.listdir(f"/proc/{member}/task"):
            os.sched_setaffinity(int(thread), cpus)


def cpu_seconds(pid):
    """utime + stime of the process and all that descend from it."""
    total = 0
    for member in family(pid):
        fields = pathlib.Path(f"/proc/{member}/stat").read_text().rpartition(")")[2].split()
        total += int(fields[11]) + int(fields[12])
    return total / TICKS


def memory(pid):
    """{rss, private} in bytes, of the process and all that descend from it."""
    sums = {"rss": 0, "private": 0}
    for member in family(pid):
        text = pathlib.Path(f"/proc/{member}/smaps_rollup").read_text()
        kib = {name: int(value) for name, value in re.findall(r"(\w+):\s+(\d+) kB", text)}
        sums["rss"] += 1024 * kib["Rss"]
        sums["private"] += 1024 * (kib["Private_Clean"] + kib["Private_Dirty"])
    return sums


def tcp_bytes():
    """What the kernel holds in the buffers of all TCP sockets, both ends of loopback together."""
    text = pathlib.Path("/proc/net/sockstat").read_text()
    return PAGE * int(re.search(r"^TCP:.* mem (\d+)", text, re.MULTILINE).group(1))


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Sampler(threading.Thread):
    """Calls `sample` again and again until stopped, and keeps the greatest result."""

    def __init__(self, sample, interval):
        super().__init__(daemon=True)
        self.sample, self.interval, self.most = sample, interval, 0
        self.over = threading.Event()

    def run(self):
        while not self.over.is_set():
            self.most = max(self.most, self.sample())
            self.over.wait(self.interval)

    def __enter__(self):
        self.start()
        return self

    def __exit__(self, *_):
        self.over.set()
        self.join()


def health_milliseconds(port, path="/health"):
    """How long a fresh connection, from an address of its own, waits for its answer; ten seconds
    stand for a failure."""
    start = time.monotonic()
    try:
        with socket.create_connection(("127.0.0.1", port), timeout=10,
                                      source_address=("127.254.0.1", 0)) as client:
            client.sendall(f"GET {path} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n"
                           .encode())
            answered = client.recv(12) == b"HTTP/1.1 200"
    except OSError:
        answered = False
    return 1000 * (time.monotonic() - start) if answered else 10_000
