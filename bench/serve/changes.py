"""Changes under load: sections `reload` (settings and files) and `drain` (the end)."""

import http.client
import itertools
import json
import os
import shutil
import signal
import threading
import time

import report

TIMES = 100


class Reader(threading.Thread):
    """Asks for a mesh by name, then for its file by hash, again and again; the answer must be one
    of the `versions` ({hash: bytes}), whole."""

    def __init__(self, port, name, versions):
        super().__init__(daemon=True)
        self.port, self.name_of_mesh, self.versions = port, name, versions
        self.over = threading.Event()
        self.read, self.replaced, self.failures = 0, 0, []

    def run(self):
        client = http.client.HTTPConnection("127.0.0.1", self.port, timeout=10)
        while not self.over.is_set():
            try:
                self.read_once(client)
            except (OSError, http.client.HTTPException, ValueError) as problem:
                self.failures.append(repr(problem))
                client.close()

    def get(self, client, target):
        client.request("GET", target)
        answer = client.getresponse()
        return answer.status, answer.read()

    def read_once(self, client):
        status, text = self.get(client, f"/{self.name_of_mesh}")
        if status != 200:
            return self.failures.append(f"/{self.name_of_mesh}: {status}")
        mesh = json.loads(text)
        status, body = self.get(client, mesh["url"])
        if status == 404:  # right only if the file was replaced between both requests
            _, text = self.get(client, f"/{self.name_of_mesh}")
            if json.loads(text)["hash"] == mesh["hash"]:
                self.failures.append("404 for the hash that is served")
            self.replaced += 1
        elif status != 200 or body != self.versions[mesh["hash"]]:
            self.failures.append(f"{mesh['url']}: {status}, {len(body)} bytes, wrong ones")
        else:
            self.read += 1


def replace(path, source):
    """By rename, as writers should."""
    fresh = path.with_suffix(".fresh")
    shutil.copyfile(source, fresh)
    os.replace(fresh, path)


def reload(bench):
    """One mesh is replaced by another and back, the settings are reloaded, while both this mesh and
    one that stays are read."""
    stays = bench.sample("ten")
    turns = [bench.sample(name) for name in ("small", "other")]
    folder = bench.out / "reload"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    (folder / "ten.pmesh").symlink_to(stays.path)
    shutil.copyfile(stays.path, folder / "ten2.pmesh")
    replace(folder / "turn.pmesh", turns[0].path)
    versions = {sample.hash: sample.path.read_bytes() for sample in turns}
    with bench.pmesh(folder) as server:
        readers = [Reader(server.port, "turn", versions) for _ in range(8)]
        steady = bench.start_ask(server.port, "--connections", 50, "--addresses", 50, "--seconds",
                                 25, "--rate", 500, "--path", f"/ten2/{stays.hash}.pmesh",
                                 "--range", "0-1048575", "--file", stays.path, 0, 2**20)
        for reader in readers:
            reader.start()
        for turn in itertools.islice(itertools.cycle(turns[::-1]), TIMES):
            replace(folder / "turn.pmesh", turn.path)
            server.signal(signal.SIGHUP)
            time.sleep(0.2)
        for reader in readers:
            reader.over.set()
        for reader in readers:
            reader.join()
        steady = steady.result()
        alive = server.process.poll() is None
    failures = [failure for reader in readers for failure in reader.failures]
    read = sum(reader.read for reader in readers)
    found = report.Section(
        f"{TIMES} reloads and {TIMES} replaced files",
        f"{read} reads of the mesh that is replaced, {sum(r.replaced for r in readers)} of which "
        f"had to ask again for its new hash; {steady['requests']} ranges of a mesh that stays.\n"
        + "".join(f"- {failure}\n" for failure in failures[:10]),
        {"failures": failures, "steady": steady, "read": read})
    found.exactly("failed reads of the replaced mesh", len(failures), 0)
    found.exactly("failed reads of the other", steady["errors"], 0)
    found.exactly("the server runs on", alive, True)
    found.at_least("reads of the replaced mesh", read, TIMES)
    return found


def drain(bench, transfers=1000):
    """SIGTERM while so many transfers of 2 MiB are half done."""
    sample = bench.sample("ten")
    size = 2 * 2**20
    with bench.pmesh(sample.path.parent) as server:
        load = bench.start_ask(server.port, "--connections", transfers, "--addresses", transfers,
                               "--times", 1, "--seconds", 40, "--read-rate", size / 8, "--path",
                               sample.target, "--range", f"0-{size - 1}", "--file", sample.path,
                               0, size)
        time.sleep(4)
        start = time.monotonic()
        server.signal(signal.SIGTERM)
        status = server.process.wait(60)
        seconds = time.monotonic() - start
        result = load.result()
    found = report.Section(f"SIGTERM with {transfers} transfers under way", "",
                           {"load": result, "seconds": seconds, "status": status})
    found.at_most("seconds until the process ended", seconds, 30)
    found.exactly("exit status", status, 0)
    found.exactly("transfers that were whole", result["requests"] - result["errors"], transfers)
    return found
