"""The daemon as a process, and as a server to ask."""

from __future__ import annotations

import ctypes
import http.client
import json
import os
import pathlib
import signal
import socket
import subprocess
import threading
import time
from concurrent.futures import ThreadPoolExecutor

PATIENCE = 60  # s: nothing takes as long unless it hangs


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


# That signal comes when the thread ends that has started the process: this one lasts.
_STARTER = ThreadPoolExecutor(1)


def _with_parent() -> None:
    """In the child: ends when the soak does, however that ends."""
    ctypes.CDLL(None).prctl(1, signal.SIGKILL)  # PR_SET_PDEATHSIG


class Gone(Exception):
    """The daemon does not answer: it was killed, or it restores its belief."""


class Daemon:
    """One anchord with a data directory of its own, which survives its restarts."""

    def __init__(self, name: str, program: str, config: str, folder: pathlib.Path, lcm_url: str):
        self.name = name
        self.data = folder / name
        self.data.mkdir(parents=True)
        self.port = free_port()
        self.command = [program, "--config", config, "--data", str(self.data), "--lcm", lcm_url]
        self.command += ["--http", f"127.0.0.1:{self.port}"]
        self.errors = folder / f"{name}.log"
        self.process: subprocess.Popen | None = None
        self.generation = 0  # how often it was started
        self.up = threading.Event()
        self.refused = 0  # answers with status 4xx that were read, of this generation
        self.restart_s: list[float] = []
        self._lock = threading.Lock()

    def start(self) -> None:
        """Starts it and waits until it is ready."""
        begin = time.monotonic()
        with open(self.errors, "ab") as errors:
            self.process = _STARTER.submit(
                subprocess.Popen, self.command, stdout=subprocess.DEVNULL, stderr=errors,
                preexec_fn=_with_parent,
            ).result()
        self.generation += 1
        self.refused = 0
        while True:
            try:
                if self.door().status()["ready"]:
                    break
            except Gone:
                pass
            if self.process.poll() is not None or time.monotonic() - begin > PATIENCE:
                raise RuntimeError(f"{self.name} does not start: see {self.errors}")
            time.sleep(0.005)
        self.restart_s.append(time.monotonic() - begin)
        self.up.set()

    def end(self, number: int) -> int:
        """Sends it a signal and waits for its end: its exit status, or minus the signal."""
        self.up.clear()
        self.process.send_signal(number)
        return self.process.wait(PATIENCE)

    def door(self, timeout: float = PATIENCE) -> "Door":
        return Door(self, timeout)

    def count_refused(self) -> None:
        with self._lock:
            self.refused += 1

    def child(self) -> int:
        """The process that receives LCM; 0 while there is none."""
        pid = self.process.pid
        try:
            for task in os.listdir(f"/proc/{pid}/task"):
                children = pathlib.Path(f"/proc/{pid}/task/{task}/children").read_text().split()
                if children:
                    return int(children[0])
        except OSError:
            pass
        return 0

    def wal_bytes(self) -> int:
        try:
            return (self.data / "anchord.db-wal").stat().st_size
        except OSError:
            return 0


def proc(pid: int) -> dict[str, float]:
    """Memory (MB), threads and open files of a process; empty if there is none."""
    try:
        lines = pathlib.Path(f"/proc/{pid}/status").read_text().splitlines()
        fields = dict(line.split(":", 1) for line in lines)
        return {
            "rss_mb": int(fields["VmRSS"].split()[0]) / 1024,
            "threads": int(fields["Threads"]),
            "fds": len(os.listdir(f"/proc/{pid}/fd")),
        }
    except (OSError, KeyError):
        return {}


class Door:
    """A connection to one daemon. Not for several threads at once."""

    def __init__(self, daemon: Daemon, timeout: float):
        self.daemon = daemon
        self._connection = http.client.HTTPConnection("127.0.0.1", daemon.port, timeout=timeout)

    def ask(self, method: str, target: str, body: bytes | None = None) -> tuple[int, bytes]:
        """Status and body; Gone where there is no answer."""
        headers = {"Content-Type": "application/json"} if body is not None else {}
        try:
            self._connection.request(method, target, body, headers)
            answer = self._connection.getresponse()
            content = answer.read()
        except (OSError, http.client.HTTPException) as error:
            self._connection.close()
            raise Gone(f"{method} {target}: {error!r}") from error
        if answer.status == 503 and b"not_ready" in content:
            raise Gone(f"{method} {target}: not ready")
        if 400 <= answer.status < 500:
            self.daemon.count_refused()
        return answer.status, content

    def get(self, target: str) -> bytes:
        """The body of what must be answered 200."""
        status, body = self.ask("GET", target)
        if status != 200:
            raise RuntimeError(f"GET {target} is answered {status}: {body[:200]!r}")
        return body

    def post(self, target: str, value: object) -> tuple[int, dict]:
        status, body = self.ask("POST", target, json.dumps(value).encode())
        return status, json.loads(body)

    def status(self) -> dict:
        return json.loads(self.get("/v1/status"))

    def belief(self) -> bytes:
        """All that there is to ask of a belief: equal beliefs give equal bytes."""
        targets = ["/v1/objects?min_p=0", "/v1/hypotheses", "/v1/count", "/v1/where?class=cup"]
        return b"".join(self.get(target) for target in targets)

    def close(self) -> None:
        self._connection.close()
