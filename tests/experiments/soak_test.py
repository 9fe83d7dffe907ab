#!/usr/bin/env python3
"""Whether the soak's checks tell what must not be from what may be."""

import contextlib
import io
import json
import pathlib
import struct
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "experiments" / "soak"))

import invariants  # noqa: E402
import report  # noqa: E402
import truth  # noqa: E402
import wire  # noqa: E402

UNIT = [1, 0, 0, 0, 1, 0, 0, 0, 1]


def told(check, *arguments):
    """What a check says of its arguments, by kind."""
    violations = invariants.Violations(1)
    with contextlib.redirect_stdout(io.StringIO()):
        check(*arguments, violations)
    return violations.kinds


def an_object(**changed):
    return {"id": "cup-1", "p": 0.9, "position": [1, 2, 3], "covariance": UNIT, "last_seen": 5,
            "attributes": {"class": {"cup": 0.9, "mug": 0.1}}, **changed}


def objects(**changed):
    return json.dumps({"utime": 9, "objects": [an_object(**changed)]}).encode()


class Invariants(unittest.TestCase):
    def test_covariances(self):
        self.assertTrue(invariants.positive_definite([2, 1, 0, 1, 2, 0, 0, 0, 1]))
        for bad in ([1, 2, 0, 2, 1, 0, 0, 0, 1], [1, 0, 0, 0, -1, 0, 0, 0, -1], [0] * 9,
                    [1, 0.5, 0, 0, 1, 0, 0, 0, 1], [float("nan")] * 9, UNIT[:8], [None] * 9):
            self.assertFalse(invariants.positive_definite(bad), bad)

    def test_objects(self):
        self.assertEqual(told(invariants.check_objects, objects()), {})
        for kind, bad in (("probability", {"p": 1.1}), ("covariance", {"covariance": [0] * 9}),
                          ("position", {"position": [1, float("inf"), 0]}),
                          ("last_seen", {"last_seen": 10}),
                          ("attribute", {"attributes": {"class": {"cup": 0.9, "mug": 0.2}}})):
            self.assertEqual(told(invariants.check_objects, objects(**bad)), {kind: 1})

    def test_counts(self):
        def count(distribution, expected):
            answer = {"distribution": distribution, "expected": expected}
            return told(invariants.check_count, json.dumps(answer).encode())

        self.assertEqual(count([0.25, 0.5, 0.25], 1), {})
        self.assertIn("distribution", count([0.25, 0.5, 0.2], 0.9))
        self.assertIn("expected", count([0.25, 0.5, 0.25], 2))
        self.assertIn("probability", count([-0.25, 1, 0.25], 1.5))

    def test_hypotheses(self):
        def worlds(*ps):
            answer = {"worlds": [{"p": p} for p in ps]}
            return told(invariants.check_hypotheses, json.dumps(answer).encode())

        self.assertEqual(worlds(0.6, 0.4), {})
        self.assertEqual(worlds(0.4, 0.6), {}, "names that are kept may be less probable")
        self.assertEqual(worlds(0.4, 0.2, 0.3), {"hypotheses": 1})
        self.assertEqual(worlds(0.6, 0.6), {"hypotheses": 1})

    def test_names_are_never_used_again(self):
        names = invariants.Names()
        second = 0

        def poll(*ids):
            nonlocal second
            second += 1
            answer = {"utime": 1_000_000 * second, "objects": [{"id": i} for i in ids]}
            return told(names.follow, answer)

        self.assertEqual(poll("cup-1", "cup-2", "new-7"), {})
        self.assertEqual(poll("cup-2", "mug-1", "cup-4"), {})
        self.assertEqual(poll("cup-4", "cup-3"), {"name": 1})
        self.assertEqual(poll("cup-1", "cup-4"), {}, "a late frame may bring one back")
        self.assertEqual(poll("cup-1"), {})
        for _ in range(3):
            self.assertEqual(poll("cup-1"), {})
        self.assertEqual(poll("cup-1", "cup-4"), {"name": 1}, "but not after that")

    def test_worlds_count_up(self):
        def message(utime, seq):
            return bytes(8) + struct.pack("!qq", utime, seq)

        violations = invariants.Violations(1)
        worlds = invariants.Worlds(violations)
        for utime, seq in ((5, 1), (5, 2), (6, 4), (2, 1)):  # one left out; a new run
            worlds.hear(message(utime, seq))
        self.assertEqual(violations.kinds, {})
        with contextlib.redirect_stdout(io.StringIO()):
            worlds.hear(message(3, 1 + 1))
            worlds.hear(message(3, 2))
            worlds.hear(message(2, 9))
        self.assertEqual(violations.kinds, {"world seq": 1, "world utime": 1})


class Reports(unittest.TestCase):
    def test_slope_is_that_of_a_line(self):
        b, error = report.slope([(t, 3 + 2 * t / 3600) for t in range(0, 7200, 5)])
        self.assertAlmostEqual(b, 2)
        self.assertAlmostEqual(error, 0)
        _, error = report.slope([(t, t % 2) for t in range(100)])
        self.assertGreater(error, 1)

    def test_only_the_process_that_lasts_counts(self):
        rows = [{"elapsed_s": float(t), "m": 50.0 if t < 500 else 10.0,
                 "pid": 1.0 if t < 500 else 2.0} for t in range(0, 900, 5)]
        self.assertEqual({m for _, m in report.memory(rows, "m", "pid")}, {10.0})
        self.assertEqual(report.memory(rows, "m")[0], (300.0, 50.0))  # after a third of it

    def test_each_real_object_counts_once(self):
        cup = an_object(position=[0, 0, 0])
        self.assertEqual(truth.matched([("cup", [0, 0, 0])], [cup, cup]), 1)
        self.assertEqual(truth.matched([("cup", [0, 0, 0]), ("cup", [0.1, 0, 0])], [cup]), 1)
        self.assertEqual(truth.matched([("mug", [0, 0, 0])], [cup]), 0)
        self.assertEqual(truth.matched([("cup", [2, 0, 0])], [cup]), 0)


class Wire(unittest.TestCase):
    def test_datagrams(self):
        self.assertEqual(wire.short("A", b"xy"), b"LC02\0\0\0\1A\0xy")
        self.assertEqual(wire.text("ab"), b"\0\0\0\3ab\0")


if __name__ == "__main__":
    unittest.main()
