#!/usr/bin/env python3
"""Feeds one frame to anchord: over HTTP, which needs nothing, or over LCM.

    python3 publish.py [--server ADDR:PORT] [--token-file FILE]
    python3 publish.py --lcm [URL]

LCM needs the module `lcm` and the generated types, the package `anchord`: put
PREFIX/lib/python3/dist-packages on PYTHONPATH.
"""

import argparse
import json
import os
import sys
import time
import urllib.error
import urllib.request

# A blue cup, 1.5 m ahead and 0.4 m below the `kinect` of config/home.json, which knows the noise
# and the view already. The camera stands 1.2 m above (3, 1) and looks along +y, placed to 1 cm.
COVARIANCE = [1e-4 if row == column < 3 else 0 for row in range(6) for column in range(6)]
FRAME = {
    "utime": 0,  # set below: microseconds since 1970, when it was seen
    "sensor": "kinect",
    "pose": {
        "position": [3, 1, 1.2],
        "orientation": [0.70710678, 0, 0, 0.70710678],
        "covariance": COVARIANCE,
    },
    "detections": [
        {
            "position": [1.5, 0, -0.4],
            "score": 0.9,
            "attributes": {"class": {"cup": 0.8}, "color": {"blue": 0.7}},
        }
    ],
}


def over_http(frame, server, token_file=None):
    """Returns when the frame is applied and durable, or raises with what the daemon refuses."""
    headers = {"Content-Type": "application/json"}
    if token_file:  # of a daemon that was started with one
        with open(token_file, encoding="ascii") as file:
            headers["Authorization"] = "Bearer " + file.read().strip()
    request = urllib.request.Request(
        f"http://{server}/v1/detections",
        data=json.dumps(frame).encode(),
        headers=headers,
    )
    try:
        with urllib.request.urlopen(request, timeout=10) as answer:
            return json.load(answer)
    except urllib.error.HTTPError as refusal:
        error = json.load(refusal)["error"]
        raise SystemExit(f"refused: {error.get('field', '')} {error['message']}") from None
    except urllib.error.URLError as failure:
        raise SystemExit(f"no daemon at {server}: {failure.reason}") from None


def to_message(frame):
    """The same frame as the LCM type frame_t."""
    import anchord

    message = anchord.frame_t()
    message.utime = frame["utime"]
    message.sensor = frame["sensor"]
    message.has_pose = True
    for name, value in frame["pose"].items():
        setattr(message.pose, name, value)
    message.view.type = anchord.view_t.CONFIGURED
    for seen in frame["detections"]:
        detection = anchord.detection_t()
        detection.kind = anchord.detection_t.POSITION
        detection.measurement = seen["position"]
        detection.has_score = True
        detection.score = seen["score"]
        for name, symbols in seen["attributes"].items():
            attribute = anchord.attribute_t()
            attribute.name = name
            attribute.kind = anchord.attribute_t.SYMBOLS
            attribute.symbols = list(symbols)
            attribute.probabilities = list(symbols.values())
            attribute.num_symbols = len(symbols)
            detection.attributes.append(attribute)
        detection.num_attributes = len(detection.attributes)
        message.detections.append(detection)
    message.num_detections = len(message.detections)
    return message


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--server", default="127.0.0.1:7780", help="ADDR:PORT of the daemon")
    parser.add_argument(
        "--token-file",
        default=os.environ.get("ANCHORD_TOKEN_FILE"),
        help="file with the daemon's token; default: ANCHORD_TOKEN_FILE",
    )
    parser.add_argument("--lcm", nargs="?", const="", metavar="URL", help="publish over LCM")
    given = parser.parse_args()

    frame = FRAME | {"utime": time.time_ns() // 1000}
    if given.lcm is None:
        print(over_http(frame, given.server, given.token_file))
        return
    try:
        import lcm
    except ImportError:
        sys.exit("the module lcm is not installed; without --lcm this needs none")
    bus = lcm.LCM(given.lcm) if given.lcm else lcm.LCM()
    bus.publish("ANCHORD_DETECTIONS", to_message(frame).encode())


if __name__ == "__main__":
    main()
