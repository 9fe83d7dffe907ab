"""What happens to the daemons while they serve, one thing after the other, in random order."""

from __future__ import annotations

import random
import signal
from collections import Counter
from collections.abc import Callable

from pair import Pair
from process import Gone
from refusals import Refusals
from taken import Taken


class Trouble:
    """A bag of deeds, drawn until it is empty and filled again."""

    def __init__(self, pair: Pair, refusals: Refusals, taken: Taken, with_lcm: bool, seed: int):
        self.pair, self.refusals, self.taken, self.with_lcm = pair, refusals, taken, with_lcm
        self.dice = random.Random(seed)
        self.done: Counter[str] = Counter()
        self._bag: list[tuple[str, Callable[[], None]]] = []

    def one(self) -> None:
        if not self._bag:
            self._bag = self._deeds()
            self.dice.shuffle(self._bag)
        name, deed = self._bag.pop()
        try:
            deed()
        except (Gone, RuntimeError, OSError, KeyError, ValueError) as error:
            self.pair.v.tell("trouble", f"{name}: {error!r}")
        self.done[name] += 1

    def _deeds(self) -> list[tuple[str, Callable[[], None]]]:
        pair, refusals, taken = self.pair, self.refusals, self.taken
        deeds = [
            ("kill -9 while frames come", self._kill_under_load, 3),
            ("kill -9 at rest", lambda: self._restart_at_rest(signal.SIGKILL), 2),
            ("SIGTERM at rest", lambda: self._restart_at_rest(signal.SIGTERM), 2),
            ("kill -9 of anchord-lcm", refusals.kill_child, 2),
            ("bad frames over HTTP", refusals.frames, 4),
            ("bad questions over HTTP", refusals.questions, 2),
            ("no HTTP, or too much", refusals.requests, 1),
            ("half-open connections", refusals.half_open_connections, 3),
            ("frames sent again", taken.frames_again, 3),
            ("events", taken.event, 4),
            ("verification tasks", taken.verification, 3),
            ("comparisons", lambda: pair.at_rest(lambda: None), 2),
        ]
        if self.with_lcm:
            deeds += [
                ("bad messages over LCM", refusals.messages, 3),
                ("a fragment that kills liblcm", refusals.deadly_fragment, 1),
                ("fragment floods", refusals.fragment_flood, 1),
                ("channel floods", refusals.channel_flood, 1),
                ("questions over LCM", taken.question_over_lcm, 2),
            ]
        return [(name, deed) for name, deed, times in deeds for _ in range(times)]

    def _restart_at_rest(self, number: int) -> None:
        self.pair.at_rest(lambda: self.pair.restart(number))

    def _kill_under_load(self) -> None:
        self.pair.restart(signal.SIGKILL)
        with self.pair.feed.still():
            self.pair.compare()
