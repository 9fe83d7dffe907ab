"""What is measured while it runs: a row of samples.csv every few seconds."""

from __future__ import annotations

import csv
import pathlib
import threading
import time

from home_feed import Feed
from invariants import Violations
from pair import Pair
from process import Daemon, Gone, proc
from questions import Asker
from trouble import Trouble

MB = 1 << 20
# What bounds a run; each is about twice what an hour takes.
RSS_MB, FDS, THREADS, WAL_MB = 256, 128, 64, 64

COLUMNS = (
    ["elapsed_s", "home_s", "frames_per_s", "ack_p50_ms", "ack_p99_ms"]
    + ["questions_per_s", "question_p50_ms", "question_p99_ms"]
    + [f"{who}_{what}" for who in ("steady", "shaken")
       for what in ("rss_mb", "fds", "threads", "wal_mb", "lcm_pid", "lcm_rss_mb")]
    + ["anchors", "hypotheses", "objects", "update_p99_us", "log_mb", "restarts", "deeds"]
    + ["checked", "violations"]
)


def quantile(values: list[float], q: float) -> float:
    """Of sorted values; NaN without any."""
    return values[min(len(values) - 1, int(q * len(values)))] if values else float("nan")


def drain(latencies) -> list[float]:
    """Takes out what has come so far, sorted."""
    taken = []
    while latencies:
        taken.append(latencies.popleft())
    return sorted(taken)


class Sampler(threading.Thread):
    """Writes samples.csv, and keeps all latencies for the table."""

    def __init__(self, pair: Pair, asker: Asker, trouble: Trouble, feed: Feed, v: Violations,
                 file: pathlib.Path, period: float, sanitized: bool):
        super().__init__(daemon=True)
        self.pair, self.asker, self.trouble, self.feed, self.v = pair, asker, trouble, feed, v
        self.file, self.period, self.sanitized = file, period, sanitized
        self.rows: list[dict[str, float]] = []
        self.acks: list[float] = []
        self.questions: list[float] = []
        self.ended = threading.Event()
        self._begin = self._last = time.monotonic()
        self._frames = self._asked = 0

    def run(self) -> None:
        with open(self.file, "w", newline="", encoding="utf-8") as out:
            writer = csv.DictWriter(out, COLUMNS, restval="")
            writer.writeheader()
            while not self.ended.wait(self.period):
                row = self._sample()
                self.rows.append(row)
                writer.writerow({k: round(x, 3) for k, x in row.items()})
                out.flush()

    def _sample(self) -> dict[str, float]:
        now = time.monotonic()
        dt, self._last = now - self._last, now
        acks, questions = drain(self.feed.ack_ms), drain(self.asker.latency_ms)
        self.acks += acks
        self.questions += questions
        frames, asked = self.feed.frames, self.asker.asked
        row = {
            "elapsed_s": now - self._begin,
            "home_s": self.feed.home_seconds(),
            "frames_per_s": (frames - self._frames) / dt,
            "ack_p50_ms": quantile(acks, 0.5),
            "ack_p99_ms": quantile(acks, 0.99),
            "questions_per_s": (asked - self._asked) / dt,
            "question_p50_ms": quantile(questions, 0.5),
            "question_p99_ms": quantile(questions, 0.99),
            "restarts": self.pair.shaken.generation - 1,
            "deeds": sum(self.trouble.done.values()),
            "checked": self.v.checked,
            "violations": self.v.count(),
        }
        self._frames, self._asked = frames, asked
        for who in ("steady", "shaken"):
            row.update(self._process(who, getattr(self.pair, who)))
        door = self.pair.steady.door()
        try:
            status = door.status()
        except (Gone, RuntimeError) as error:
            self.v.tell("no answer", f"status: {error}")
            return row
        finally:
            door.close()
        row.update({k: status[k] for k in ("anchors", "hypotheses", "objects")})
        row["update_p99_us"] = status["update_us"]["p99"]
        row["log_mb"] = status["log"]["bytes"] / MB
        return row

    def _process(self, who: str, daemon: Daemon) -> dict[str, float]:
        own = proc(daemon.process.pid)
        if not own:  # it was killed a moment ago
            return {}
        wal = daemon.wal_bytes() / MB
        child = daemon.child()
        lcm = proc(child) if child else {}
        hold = self.v.hold
        if not self.sanitized:
            hold(own["rss_mb"] < RSS_MB, "memory", f"{who}: {own}")
            hold(lcm.get("rss_mb", 0) < RSS_MB, "memory", f"{who}'s anchord-lcm: {lcm}")
        hold(own["fds"] < FDS, "open files", f"{who}: {own}")
        hold(own["threads"] < THREADS, "threads", f"{who}: {own}")
        hold(wal < WAL_MB, "WAL", f"{who}: {wal} MB")
        row = {f"{who}_{k}": x for k, x in own.items()}
        row[f"{who}_wal_mb"] = wal
        if lcm:
            row[f"{who}_lcm_pid"] = child
            row[f"{who}_lcm_rss_mb"] = lcm["rss_mb"]
        return row
