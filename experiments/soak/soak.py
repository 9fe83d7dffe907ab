"""Two daemons live through a simulated home at 20 times real time, with kills, restarts and
hostile bytes; what must hold is checked throughout. See docs/soak.md.

Usage: soak.py MINUTES [--seed N] [--build DIR] [--out DIR]. Exit status 1: something did not hold.
"""

from __future__ import annotations

import argparse
import json
import pathlib
import random
import shutil
import signal
import sys
import threading
import time

import report
from home_feed import Feed
from invariants import Violations, Worlds
from pair import Pair
from process import Daemon, free_port
from questions import Asker
from refusals import Refusals
from sampling import Sampler, quantile
from taken import Taken
from trouble import Trouble
from truth import Truth
from wire import Bus, multicast_works

CONFIG = pathlib.Path(__file__).resolve().parent / "home.json"
SAMPLE_S = 5.0
BETWEEN_DEEDS_S = 5.0  # mean; in a short run there are at least DEEDS
DEEDS = 60


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("minutes", type=float)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--build", type=pathlib.Path, default=pathlib.Path("build"))
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("soak"))
    parser.add_argument("--sanitized", action="store_true", help="memory is not bounded")
    chosen = parser.parse_args()
    if not chosen.minutes > 0:
        parser.error("MINUTES must be above 0")
    return chosen


class Soak:
    def __init__(self, a: argparse.Namespace):
        self.a, self.seconds = a, 60 * a.minutes
        self.v = Violations(a.seed)
        shutil.rmtree(a.out, ignore_errors=True)
        a.out.mkdir(parents=True)
        with_lcm = multicast_works()
        if not with_lcm:
            print("no multicast route here: nothing goes over LCM")
        # A network for each, so that what kills liblcm reaches one of them only.
        self.buses = [Bus(free_port()) for _ in range(2)] if with_lcm else []
        daemons = [
            Daemon(name, str(a.build / "anchord"), str(CONFIG), a.out,
                   self.buses[i].url if with_lcm else "memq://")
            for i, name in enumerate(("shaken", "steady"))
        ]
        for daemon in daemons:
            daemon.start()
        self.feed = Feed([str(a.build / "soak_home"), "--config", str(CONFIG), "--seed",
                          str(a.seed)], daemons, self.buses, a.seed, self.v)
        self.pair = Pair(*daemons, self.feed, self.v)
        dice = random.Random(a.seed + 1)
        self.trouble = Trouble(self.pair, Refusals(self.pair, self.buses, dice),
                               Taken(self.pair, self.buses, self.feed.query, dice), with_lcm,
                               a.seed + 2)
        self.askers = [Asker(d, a.seed + 3 + i, self.v) for i, d in enumerate(daemons)]
        self.truth = Truth(self.pair, self.v)
        self.worlds = [Worlds(self.v) for _ in self.buses]
        for bus, worlds in zip(self.buses, self.worlds):
            bus.handlers["ANCHORD_WORLD"] = worlds.hear
            bus.listen()
        if with_lcm:
            self.pair.on_restart = self.worlds[0].begin_again
        self.sampler = Sampler(self.pair, self.askers[1], self.trouble, self.feed, self.v,
                               a.out / "samples.csv", min(SAMPLE_S, self.seconds / 10),
                               a.sanitized)

    def run(self) -> None:
        helpers = [*self.askers, self.sampler]
        for helper in helpers:
            helper.start()
        over = threading.Event()
        troubler = threading.Thread(target=self._make_trouble, args=(over,))
        troubler.start()
        try:
            self.feed.play(self.seconds)
        finally:
            over.set()
            troubler.join()
            for helper in helpers:
                helper.ended.set()
            for helper in helpers:
                helper.join()
        self._end()

    def _make_trouble(self, over: threading.Event) -> None:
        dice = random.Random(self.a.seed + 9)
        mean = min(BETWEEN_DEEDS_S, self.seconds / DEEDS)
        while not over.wait(dice.expovariate(1 / mean)):
            self.trouble.one()

    def _end(self) -> None:
        """Both are ended and started once more: the belief is the log's."""
        before = self.pair.compare()
        for daemon, number in zip(self.pair.daemons, (signal.SIGKILL, signal.SIGTERM)):
            daemon.end(number)
            daemon.start()
        beliefs = []
        for daemon in self.pair.daemons:
            door = daemon.door()
            beliefs.append(door.belief())
            door.close()
            daemon.end(signal.SIGTERM)
        self.v.hold(beliefs == [before, before], "the end", "the belief is not what it was")
        self.feed.close()

    def summary(self) -> dict:
        s, t = self.sampler, self.trouble
        restarts = sorted(self.pair.shaken.restart_s[1:])
        acks, questions = sorted(s.acks), sorted(s.questions)
        elapsed = s.rows[-1]["elapsed_s"] if s.rows else self.seconds
        home = self.feed.home_seconds()
        lines = [
            ("seed", self.a.seed),
            ("lasted", f"{elapsed / 60:.1f} min; {home / 3600:.1f} h of the home, "
                       f"{home / elapsed:.1f} times real time"),
            ("frames", f"{self.feed.frames}, {self.feed.repeated} of them over LCM before"),
            ("durable acknowledgement of a batch", f"{quantile(acks, 0.5):.1f} ms, 99 %: "
                                                   f"{quantile(acks, 0.99):.1f} ms"),
            ("questions", f"{sum(a.asked for a in self.askers)}; {quantile(questions, 0.5):.1f} ms,"
                          f" 99 %: {quantile(questions, 0.99):.1f} ms"),
            ("restarts", f"{len(restarts)}; ready after {quantile(restarts, 0.5):.2f} s, at most "
                         f"{max(restarts, default=0):.2f} s"),
            ("worlds heard over LCM", sum(w.heard for w in self.worlds)),
        ]
        lines += [(name, number) for name, number in sorted(t.done.items())]
        lines += [(f"mean of {name}", f"{x:.2f}") for name, x in self.truth.means().items()]
        lines += [("checks", self.v.checked), ("violations", self.v.count())]
        return {"lines": lines, "violations": self.v.kinds}


def main() -> int:
    sys.setswitchinterval(0.0005)  # s: threads that measure wait for others no longer than that
    a = arguments()
    soak = Soak(a)
    print(f"a home for {a.minutes:g} minutes, seed {a.seed}; results go to {a.out}/", flush=True)
    begin = time.monotonic()
    soak.run()
    summary = soak.summary()
    (a.out / "summary.json").write_text(json.dumps(summary, indent=1), encoding="utf-8")
    print(report.write(a.out), end="")
    print(f"{a.out}/: samples.csv, summary.json, table.md, soak.svg ({time.monotonic() - begin:.0f}"
          " s)")
    for kind, number in sorted(soak.v.kinds.items()):
        print(f"{number} x {kind}")
    return 1 if soak.v.count() else 0


if __name__ == "__main__":
    sys.exit(main())
