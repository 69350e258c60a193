#!/usr/bin/env python3
"""Clients of pmesh that check every byte they get.

clients.py passes URL ORIGIN DIR        asks URL for everything twice, one request after the other;
                                        prints how many requests each pass made and how many a
                                        cache answered (X-Cache: HIT)
clients.py load URL ORIGIN DIR SECONDS  asks URL for everything in random order on 16 connections;
                                        prints requests, failures and cut answers that were
                                        resumed, and "started" on stderr when it begins
clients.py busiest SOCKET               HAProxy's server with the most requests, by its stats socket

ORIGIN is a server that is asked first, what the answers are; DIR holds the PM files it serves. What
is wrong with an answer is printed on stderr, and the exit status is 1.
"""

import csv
import http.client
import json
import random
import socket
import sys
import threading
import time
import urllib.parse
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Wanted:
    """A request, and the body that answers it."""

    target: str
    body: bytes
    range: str = ""
    resumable: bool = False  # the target knows ranges

    @property
    def status(self):
        return 206 if self.range else 200


class Client:
    """One kept-alive connection."""

    def __init__(self, url):
        parts = urllib.parse.urlsplit(url)
        self.connection = http.client.HTTPConnection(parts.hostname, parts.port, timeout=30)

    def get(self, target, byte_range=""):
        """Status, fields and body; the body may be cut short of its Content-Length."""
        self.connection.request("GET", target, headers={"Range": byte_range} if byte_range else {})
        response = self.connection.getresponse()
        try:
            body = response.read()
        except http.client.IncompleteRead as cut:
            body = cut.partial
            self.connection.close()
        except ConnectionResetError:
            body = b""
            self.connection.close()
        return response.status, response.headers, body


def ranges_of(target, body):
    """Ranges of a body of at least 100 bytes: its head, its last byte, and what crosses a MiB."""
    middle = len(body) // 2
    spans = [(0, 99), (len(body) - 1, len(body) - 1), (middle - 20, len(body) - 1)]
    if len(body) > 1100000:
        spans.append((1048000, 1049000))
    for first, last in spans:
        yield Wanted(target, body[first : last + 1], f"bytes={first}-{last}", resumable=True)


def wanted_of_mesh(origin, info, file):
    """Everything that can be had of a mesh, with the bytes that its file says."""
    path = info["url"]
    chunks = info["chunks"]
    yield Wanted(path, file, resumable=True)
    yield from ranges_of(path, file)
    for number, chunk in enumerate(chunks):
        body = file[chunk["offset"] : chunk["offset"] + chunk["bytes"]]
        yield Wanted(f"{path.removesuffix('.pmesh')}/c/{number}", body)
    wishes = ["ratio=0.5", "faces=1", "vertices=100", "bytes=100000", "error=3", "error=10%25"]
    for wish in wishes + ["chunks=0-1", "chunks=2-3"]:
        begin = chunks[2]["offset"] if wish == "chunks=2-3" else 0
        status, fields, body = origin.get(f"{path}?{wish}")
        assert status == 200 and len(body) == int(fields["Content-Length"]), wish
        assert file[begin : begin + len(body)] == body, wish
        yield Wanted(f"{path}?{wish}", body, resumable=True)
        yield from ranges_of(f"{path}?{wish}", body)


def everything(origin_url, directory):
    """Every request and its answer; names are a small part of them, as in life."""
    origin = Client(origin_url)
    catalogue = origin.get("/catalog")[2]
    wanted = [Wanted("/catalog", catalogue)]
    for mesh in json.loads(catalogue):
        file = (Path(directory) / (mesh["id"] + ".pmesh")).read_bytes()
        info = origin.get("/" + mesh["id"])[2]
        wanted.append(Wanted("/" + mesh["id"], info))
        wanted.extend(wanted_of_mesh(origin, json.loads(info), file))
    return wanted


def fault_of(wanted, status, body):
    if status != wanted.status:
        return f"status {status} instead of {wanted.status}"
    if body != wanted.body:
        return f"{len(body)} bytes, not the {len(wanted.body)} of the file"
    return ""


def one_pass(client, all_wanted):
    hits = faults = 0
    for wanted in all_wanted:
        status, fields, body = client.get(wanted.target, wanted.range)
        hits += fields.get("X-Cache") == "HIT"
        if fault := fault_of(wanted, status, body):
            faults += 1
            print(f"{wanted.target} {wanted.range}: {fault}", file=sys.stderr)
    return hits, faults


def passes(url, origin, directory):
    all_wanted = everything(origin, directory)
    client = Client(url)
    first_hits, first_faults = one_pass(client, all_wanted)
    second_hits, second_faults = one_pass(client, all_wanted)
    print(json.dumps({"requests": len(all_wanted), "first_hits": first_hits,
                      "second_hits": second_hits}))
    return first_faults + second_faults == 0


class Load:
    """What the threads of `load` share."""

    def __init__(self, url, all_wanted, until):
        self.url, self.all_wanted, self.until = url, all_wanted, until
        self.lock = threading.Lock()
        self.requests = self.resumed = self.failures = 0

    def resumed_body(self, client, wanted, body):
        """The rest of an answer that was cut, as docs/protocol.md 2.6 has it."""
        first = len(body)
        if wanted.range:
            first += int(wanted.range.removeprefix("bytes=").split("-")[0])
        whole = first - len(body) + len(wanted.body)
        status, _, rest = client.get(wanted.target, f"bytes={first}-{whole - 1}")
        return body + rest if status == 206 else body

    def ask(self, client, wanted):
        status, _, body = client.get(wanted.target, wanted.range)
        is_cut = status == wanted.status and len(body) < len(wanted.body)
        if is_cut and wanted.resumable:
            body = self.resumed_body(client, wanted, body)
        elif is_cut:
            status, _, body = client.get(wanted.target, wanted.range)
        with self.lock:
            self.resumed += is_cut
        return fault_of(wanted, status, body)

    def run(self, seed):
        choice = random.Random(seed)
        client = Client(self.url)
        while time.monotonic() < self.until:
            wanted = choice.choice(self.all_wanted)
            try:
                fault = self.ask(client, wanted)
            except (OSError, http.client.HTTPException) as error:
                fault = repr(error)
            with self.lock:
                self.requests += 1
                self.failures += bool(fault)
            if fault:
                print(f"{wanted.target} {wanted.range}: {fault}", file=sys.stderr)


def load(url, origin, directory, seconds):
    all_wanted = everything(origin, directory)
    shared = Load(url, all_wanted, time.monotonic() + float(seconds))
    threads = [threading.Thread(target=shared.run, args=(seed,)) for seed in range(16)]
    for thread in threads:
        thread.start()
    print("started", file=sys.stderr, flush=True)
    for thread in threads:
        thread.join()
    print(json.dumps({"requests": shared.requests, "failures": shared.failures,
                      "resumed": shared.resumed}))
    return shared.failures == 0


def busiest(path):
    with socket.socket(socket.AF_UNIX) as stats:
        stats.connect(path)
        stats.sendall(b"show stat\n")
        text = stats.makefile().read()
    rows = csv.DictReader(text.removeprefix("# ").splitlines())
    servers = [row for row in rows if row["svname"] not in ("FRONTEND", "BACKEND")]
    print(max(servers, key=lambda row: int(row["stot"]))["svname"])
    return True


if __name__ == "__main__":
    verbs = {"passes": passes, "load": load, "busiest": busiest}
    sys.exit(0 if verbs[sys.argv[1]](*sys.argv[2:]) else 1)
