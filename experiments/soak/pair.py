"""Two daemons that are told the same and must believe the same."""

from __future__ import annotations

import signal
import time
from collections.abc import Callable

from home_feed import Feed
from invariants import Violations
from process import PATIENCE, Daemon


class Pair:
    """`shaken` is restarted and gets everything; `steady` all but restarts and what kills liblcm.
    Both take the same frames and events, so that their beliefs must be the same bytes: whoever was
    never killed tells what whoever was must believe."""

    def __init__(self, shaken: Daemon, steady: Daemon, feed: Feed, v: Violations):
        self.shaken, self.steady, self.feed, self.v = shaken, steady, feed, v
        self.daemons = [shaken, steady]
        self.on_restart: Callable[[], None] = lambda: None

    def compare(self) -> bytes:
        """With the home at rest: both hold all that was acknowledged, and believe the same."""
        beliefs = [self._check(daemon) for daemon in self.daemons]
        self.v.hold(beliefs[0] == beliefs[1], "beliefs differ", difference(*beliefs))
        return beliefs[0]

    def _check(self, daemon: Daemon) -> bytes:
        door = daemon.door()
        status = door.status()
        give_up = time.monotonic() + PATIENCE
        while status["queue"]["frames"] and time.monotonic() < give_up:
            time.sleep(0.01)
            status = door.status()
        frames, hold = status["frames"], self.v.hold
        hold(status["log"]["frames"] == self.feed.log_length, "the log's length",
             f"{daemon.name} has {status['log']['frames']}, {self.feed.log_length} were taken")
        for counter in ("overrun", "unstored"):
            hold(frames[counter] == 0, counter, f"{daemon.name}: {status}")
        hold(status["log"]["failures"] == 0, "commits", f"{daemon.name}: {status}")
        if daemon is self.steady:
            hold(frames["accepted"] == self.feed.frames, "accepted",
                 f"{frames['accepted']} counted, {self.feed.frames} taken")
            hold(status["http"]["client_errors"] >= daemon.refused, "client errors",
                 f"{status['http']['client_errors']} counted, {daemon.refused} answered")
        belief = door.belief()
        door.close()
        return belief

    def at_rest(self, deed: Callable[[], None]) -> None:
        """Does it while the home stands still; the belief must be what it was."""
        with self.feed.still():
            before = self.compare()
            deed()
            after = self.compare()
            self.v.hold(before == after, "the belief has changed", difference(before, after))

    def restart(self, number: int) -> None:
        """Ends the shaken one by that signal, and starts it again."""
        status = self.shaken.end(number)
        wanted = 0 if number == signal.SIGTERM else -number
        self.v.hold(status == wanted, "exit status", f"{status} after signal {number}")
        self.on_restart()
        self.shaken.start()


def difference(a: bytes, b: bytes) -> str:
    """Where two answers begin to differ."""
    at = next((i for i, (x, y) in enumerate(zip(a, b)) if x != y), min(len(a), len(b)))
    begin = max(0, at - 40)
    return (f"{len(a)} and {len(b)} bytes, from {at} on: {a[begin:at + 80]!r} and "
            f"{b[begin:at + 80]!r}")
