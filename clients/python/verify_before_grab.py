#!/usr/bin/env python3
"""A planner that has the robot look before it grabs, over LCM.

    python3 verify_before_grab.py OBJECT [--robot NAME] [--timeout SECONDS]

It announces the grab, waits until the verification task has ended, grabs if the object was found,
and tells that it holds it. Needs the module `lcm` and the generated types, the package `anchord`:
put PREFIX/lib/python3/dist-packages on PYTHONPATH.
"""

import argparse
import sys
import time

import anchord
import lcm

ENDS = {
    anchord.verify_task_t.FOUND: "found",
    anchord.verify_task_t.MISSING: "missing",
    anchord.verify_task_t.OCCLUDED: "occluded",
    anchord.verify_task_t.EXPIRED: "expired",
    anchord.verify_task_t.CANCELLED: "cancelled",
}


class Look:
    """Hears what becomes of one trigger, known by its tag."""

    def __init__(self, bus, tag):
        self.tag = tag
        self.ended = None  # the task as it ended
        self.heard_at = 0.0
        self.refusal = None
        bus.subscribe("ANCHORD_VERIFY_TASK", self._task)
        bus.subscribe("ANCHORD_REJECTED", self._rejected)

    def _task(self, _, data):
        task = anchord.verify_task_t.decode(data)
        if self.tag not in task.tags:
            return  # another planner's
        if task.state in ENDS:
            self.ended, self.heard_at = task, time.monotonic()

    def _rejected(self, _, data):
        rejected = anchord.rejected_t.decode(data)
        if rejected.channel == "ANCHORD_VERIFY_TRIGGER":  # it has no tag: perhaps another's
            self.refusal = f"{rejected.field}: {rejected.reason}"


def look_at(bus, name, robot, timeout_s):
    """Demands the look and waits for its end, which may never be told."""
    trigger = anchord.verify_trigger_t()
    trigger.utime = time.time_ns() // 1000
    trigger.object = name
    trigger.action = "grab"
    trigger.robot = robot
    trigger.timeout_s = timeout_s
    trigger.tag = time.time_ns()  # any number that nobody else has
    look = Look(bus, trigger.tag)
    bus.publish("ANCHORD_VERIFY_TRIGGER", trigger.encode())
    until = time.monotonic() + timeout_s + 2  # LCM promises nothing: it may be lost
    while not look.ended and time.monotonic() < until:
        bus.handle_timeout(200)
        if look.refusal:
            sys.exit(f"refused: {look.refusal}")
    return look


def tell_grasped(bus, look, robot):
    """The world's time may be a recording's: it goes on from when the task had ended."""
    event = anchord.event_t()
    event.utime = look.ended.ended + int((time.monotonic() - look.heard_at) * 1e6)
    event.kind = anchord.event_t.GRASPED
    event.robot = robot
    event.object = look.ended.object
    bus.publish("ANCHORD_EVENT", event.encode())


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("object", help="id or alias, such as cup-1")
    parser.add_argument("--robot", default="", help="who looks and grabs; default: the only one")
    parser.add_argument("--timeout", type=float, default=60, help="seconds for the look")
    given = parser.parse_args()

    bus = lcm.LCM()
    look = look_at(bus, given.object, given.robot, given.timeout)
    if not look.ended:
        sys.exit("nothing was heard of the look: is the daemon on this LCM network?")
    print(f"{look.ended.object}: {ENDS[look.ended.state]}, {look.ended.reason}", flush=True)
    if look.ended.state != anchord.verify_task_t.FOUND:
        sys.exit(1)
    # Here your robot grabs it; tell so only if that went well.
    tell_grasped(bus, look, given.robot)
    print(f"{look.ended.object} is grasped")


if __name__ == "__main__":
    main()
