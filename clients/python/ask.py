#!/usr/bin/env python3
"""Asks anchord where something is: python3 ask.py class=cup color=blue"""

import json
import os
import sys
import urllib.error
import urllib.parse
import urllib.request

SERVER = os.environ.get("ANCHORD_SERVER", "127.0.0.1:7780")


def where(**description):
    """The answer to /v1/where: `answers`, best first, and the expected `undetected` ones."""
    query = urllib.parse.urlencode(description)
    with urllib.request.urlopen(f"http://{SERVER}/v1/where?{query}", timeout=10) as answer:
        return json.load(answer)


def main():
    words = [word.partition("=") for word in sys.argv[1:]]
    if not words or not all(equals for _, equals, _ in words):
        sys.exit("usage: ask.py KEY=VALUE..., for example class=cup color=blue, or object=cup-1")
    try:
        answer = where(**{key: value for key, _, value in words})
    except urllib.error.HTTPError as refusal:
        error = json.load(refusal)["error"]
        sys.exit(f"refused: {error.get('field', '')} {error['message']}")
    except urllib.error.URLError as failure:
        sys.exit(f"no daemon at {SERVER}: {failure.reason}")
    for found in answer["answers"]:
        position = ", ".join(f"{x:.2f}" for x in found["position"])
        best = found["places"][0]
        print(
            f"{found['object']}: exists {found['p']:.2f}, fits {found['match']:.2f}, "
            f"at {position} m, {best['place'] or 'outside every place'} {best['p']:.2f}"
        )
    if not answer["answers"]:
        print("nothing seen so far fits")
    for unseen in answer["undetected"]:
        print(f"not seen yet: {unseen['expected']:.2f} expected in {unseen['place']}")


if __name__ == "__main__":
    main()
