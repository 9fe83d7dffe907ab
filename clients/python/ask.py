#!/usr/bin/env python3
"""Asks anchord where something is: python3 ask.py class=cup color=blue"""

import json
import os
import sys
import urllib.error
import urllib.parse
import urllib.request

SERVER = os.environ.get("ANCHORD_SERVER", "127.0.0.1:7780")
TOKEN_FILE = os.environ.get("ANCHORD_TOKEN_FILE")  # of a daemon with --token-file


def where(**description):
    """The answer to /v1/where: `answers`, best first, and the expected `undetected` ones."""
    query = urllib.parse.urlencode(description)
    request = urllib.request.Request(f"http://{SERVER}/v1/where?{query}", headers=authorization())
    with urllib.request.urlopen(request, timeout=10) as answer:
        return json.load(answer)


def authorization():
    """The header field by which a daemon with a token lets us in."""
    if not TOKEN_FILE:
        return {}
    with open(TOKEN_FILE, encoding="ascii") as file:
        return {"Authorization": "Bearer " + file.read().strip()}


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
    if not answer["answers"]:
        print("nothing seen so far fits")
    for found in answer["answers"]:
        position = ", ".join(f"{x:.2f}" for x in found["position"])
        places = ", ".join(f"{p['place']} {p['p']:.2f}" for p in likely(found["places"], "p"))
        print(
            f"{found['object']}: exists {found['p']:.2f}, fits {found['match']:.2f}, "
            f"at {position} m ({places or 'in no place'})"
        )
    for place in likely(answer["undetected"], "expected"):
        print(f"not seen yet: {place['expected']:.2f} expected in {place['place']}")


def likely(places, key, least=0.05):
    """Those that are named and matter. Places nest: a table's share is part of its room's."""
    return [place for place in places if place["place"] and place[key] >= least]


if __name__ == "__main__":
    main()
