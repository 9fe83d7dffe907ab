"""What a daemon must refuse, and not be changed by."""

from __future__ import annotations

import copy
import json
import random
import struct
import time
from collections.abc import Iterator

YEAR_US = 366 * 86_400 * 1_000_000


def bad_frames(good: dict, dice: random.Random) -> list[tuple[str, bytes, int]]:
    """What it is, a body for POST /v1/detections, and the status that answers it. `good` is the
    newest frame that was acknowledged, changed so that it would be news."""
    base = copy.deepcopy(good)
    base["utime"] += 1
    base["detections"] = [
        {"position": [1.0, 0.5, -0.3], "score": 0.9, "attributes": {"class": {"cup": 0.8}}}
    ]

    def with_(change) -> bytes:
        frame = copy.deepcopy(base)
        change(frame)
        return json.dumps(frame).encode()

    def detection(**members) -> bytes:
        return with_(lambda f: f["detections"][0].update(members))

    def second(frame) -> None:
        frame["utime"] += 1
        frame["detections"][0]["score"] = -1

    text = json.dumps(base).encode()
    cut = text[: dice.randrange(1, len(text) - 1)]
    garbage = bytes(dice.randrange(256) for _ in range(dice.randrange(1, 300)))
    now = int(time.time() * 1e6)
    return [
        ("nothing", b"", 400),
        ("cut off", cut, 400),
        ("random bytes", b"\xff" + garbage, 400),
        ("deep nesting", b"[" * 100_000, 400),
        ("NaN", text.replace(b"0.5", b"NaN"), 400),
        ("infinite", text.replace(b"0.5", b"1e999"), 400),
        ("text for a time", with_(lambda f: f.update(utime="now")), 400),
        ("1970", with_(lambda f: f.update(utime=0)), 400),
        ("a negative time", with_(lambda f: f.update(utime=-1)), 400),
        ("no sensor", with_(lambda f: f.pop("sensor")), 400),
        ("detections that are none", with_(lambda f: f.update(detections=7)), 400),
        ("null in a position", detection(position=[1, None, 2]), 400),
        ("two coordinates", detection(position=[1, 2]), 400),
        ("negative variance", detection(covariance=[-1, 0, 0, 0, 1, 0, 0, 0, 1]), 400),
        ("indefinite", detection(covariance=[1, 2, 0, 2, 1, 0, 0, 0, 1]), 400),
        ("score over 1", detection(score=1.5), 400),
        ("unknown symbol", detection(attributes={"class": {"unicorn": 0.5}}), 400),
        ("negative probability", detection(attributes={"class": {"cup": -0.5}}), 400),
        ("unknown attribute", detection(attributes={"weight": {"heavy": 1}}), 400),
        ("20,000 detections", with_(lambda f: f.update(detections=f["detections"] * 20_000)), 400),
        ("5,000 frames", b"[" + b",".join([text] * 5000) + b"]", 413),
        ("one bad of two", b"[" + text + b"," + with_(second) + b"]", 400),
        ("runs backwards", with_(lambda f: f.update(utime=good["utime"] - 1)), 409),
        ("another at the same time", with_(lambda f: f.update(utime=good["utime"])), 409),
        ("a minute late", with_(lambda f: f.update(utime=good["utime"] - 60_000_000)), 409),
        ("a year ahead", with_(lambda f: f.update(utime=now + YEAR_US)), 409),
    ]


def bad_questions() -> list[tuple[str, str, bytes | None, int]]:
    """Method, target, body and status."""
    return [
        ("GET", "/v1/nothing", None, 404),
        ("GET", "/../../etc/passwd", None, 404),
        ("GET", "/v1/objects/unicorn-1", None, 404),
        ("GET", "/v1/where?class=unicorn", None, 400),
        ("GET", "/v1/objects?min_p=NaN", None, 400),
        ("GET", "/v1/count?place=narnia", None, 400),
        ("GET", "/v1/hypotheses?limit=-1", None, 400),
        ("GET", "/v1/objects?class=%ff%00", None, 400),
        ("DELETE", "/v1/objects", None, 405),
        ("POST", "/v1/events", b"{}", 400),
        ("POST", "/v1/events", b'{"utime": 1700000000000000, "event": "eaten"}', 400),
        ("POST", "/v1/verifications", b'{"object": "unicorn-1"}', 404),
        ("POST", "/v1/verifications", b"[1, 2", 400),
        ("GET", "/v1/verifications/999999999", None, 404),
    ]


def bad_requests() -> list[tuple[str, bytes, int]]:
    """What is no HTTP, or too much of it; to be sent as it is on a connection of its own."""
    head = b"POST /v1/detections HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\n"
    return [
        ("no HTTP", b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03\r\n\r\n", 400),
        ("9 MiB announced", head + b"Content-Length: 9437184\r\n\r\n", 413),
        ("a length that is none", head + b"Content-Length: -5\r\n\r\n", 400),
        ("a header of 64 kB", head + b"X: " + b"x" * 65536 + b"\r\n\r\n", 431),
    ]


def bad_messages(good: bytes, dice: random.Random) -> Iterator[bytes]:
    """frame_t that are none, or not to be believed. `good` is one that was taken already, so that
    even what is changed beside the point would be refused."""
    yield b""
    yield good[: dice.randrange(1, len(good))]
    yield good + b"\0"
    yield bytes(dice.randrange(256) for _ in range(dice.randrange(1, 400)))
    yield bytes([good[0] ^ 1]) + good[1:]  # another type
    yield good[:24] + struct.pack("!i", -1) + good[28:]  # robot: a text of -1 bytes
    yield good[:24] + struct.pack("!i", 0x7FFFFFFF) + good[28:]
    yield good[:8] + struct.pack("!q", int(time.time() * 1e6) + YEAR_US) + good[16:]
    yield good[:8] + struct.pack("!q", -1) + good[16:]
