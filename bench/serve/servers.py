"""The servers that are compared, each as a process that lives as long as a `with` block."""

import os
import pathlib
import re
import signal
import socket
import subprocess
import sys
import time

import system

HERE = pathlib.Path(__file__).resolve().parent
CIPHER = "TLS_AES_128_GCM_SHA256"


def make_certificate(folder):
    """A certificate of our own and its key, as certificate.pem and key.pem."""
    folder.mkdir(parents=True, exist_ok=True)
    if not (folder / "certificate.pem").exists():
        subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt",
                        "ec_paramgen_curve:P-256", "-nodes", "-days", "3650", "-subj",
                        "/CN=localhost", "-addext", "subjectAltName=DNS:localhost,IP:127.0.0.1",
                        "-keyout", folder / "key.pem", "-out", folder / "certificate.pem"],
                       check=True, capture_output=True)


class Server:
    """Subclasses set `process` and `port`."""

    def __enter__(self):
        self.start()
        for _ in range(200):
            try:
                socket.create_connection(("127.0.0.1", self.port)).close()
                return self
            except ConnectionRefusedError:
                time.sleep(0.05)
        sys.exit(f"{self.name} does not start: {' '.join(map(str, self.process.args))}")

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.terminate()
            try:
                self.process.wait(40)
            except subprocess.TimeoutExpired:
                self.process.kill()
                self.process.wait()

    @property
    def pid(self):
        return self.process.pid

    def cpu_seconds(self):
        return system.cpu_seconds(self.pid)

    def memory(self):
        return system.memory(self.pid)

    def signal(self, number=signal.SIGTERM):
        self.process.send_signal(number)


class Pmesh(Server):
    """`pmesh serve` with its defaults but for `flags`."""

    name = "pmesh"

    def __init__(self, program, files, log, flags=(), tls_folder=None):
        self.port, self.tls = system.free_port(), tls_folder is not None
        self.log = log
        self.flags = list(flags)
        if self.tls:
            self.flags += ["--tls-certificate", str(tls_folder / "certificate.pem"),
                           "--tls-key", str(tls_folder / "key.pem")]
        self.command = [str(program), "serve", str(files), "--http", f"127.0.0.1:{self.port}",
                        *self.flags]

    def start(self):
        self.process = subprocess.Popen(self.command, stdout=subprocess.DEVNULL,
                                        stderr=self.log.open("ab"))


class Nginx(Server):
    """nginx with two workers on `files`, a folder; `cached`: it keeps files open."""

    def __init__(self, files, folder, cached, tls=False):
        self.name = "nginx + open_file_cache" if cached else "nginx"
        make_certificate(folder)
        self.tls = tls
        ports = {"port": system.free_port(), "tls_port": system.free_port()}
        self.port = ports["tls_port" if tls else "port"]
        cache = ("open_file_cache max=10000 inactive=60s; open_file_cache_valid 60s; "
                 "open_file_cache_min_uses 1; open_file_cache_errors on;" if cached else "")
        values = {"user": "user root;" if os.geteuid() == 0 else "", "folder": str(folder),
                  "files": str(files), "cipher": CIPHER, "open_file_cache": cache} | ports
        template = (HERE / "nginx.conf.in").read_text()
        self.configuration = folder / "nginx.conf"
        self.configuration.write_text(
            re.sub(r"\{(\w+)\}", lambda match: str(values[match.group(1)]), template))

    def start(self):
        self.process = subprocess.Popen(["nginx", "-c", self.configuration, "-e", "stderr"],
                                        stderr=subprocess.DEVNULL)
