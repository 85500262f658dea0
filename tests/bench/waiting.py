"""How long a hover takes while the server works on something else.

    python3 tests/bench/waiting.py [--lines 100000] "SERVER --stdio"

For each request about a whole document, hovers follow each other until it is answered; the longest counts.
"""

from __future__ import annotations

import argparse
import re
import shlex

from client import MAX_WAIT, URI, Client
from program import program

DOCUMENT: dict[str, object] = {"textDocument": {"uri": URI}}
WHOLE: dict[str, object] = {
    "range": {
        "start": {"line": 0, "character": 0},
        "end": {"line": 1_000_000, "character": 0},
    }
}
POSITION: dict[str, object] = {"position": {"line": 2, "character": 8}}

REQUESTS: dict[str, dict[str, object]] = {
    "textDocument/documentSymbol": DOCUMENT,
    "textDocument/semanticTokens/full": DOCUMENT,
    "textDocument/semanticTokens/range": DOCUMENT | WHOLE,
    "textDocument/foldingRange": DOCUMENT,
    "textDocument/formatting": DOCUMENT
    | {"options": {"tabSize": 2, "insertSpaces": True}},
    "textDocument/codeLens": DOCUMENT,
    "textDocument/inlayHint": DOCUMENT | WHOLE,
    "textDocument/codeAction": DOCUMENT | WHOLE | {"context": {"diagnostics": []}},
    "textDocument/references": DOCUMENT
    | POSITION
    | {"context": {"includeDeclaration": True}},
    "textDocument/diagnostic": DOCUMENT,
    "workspace/symbol": {"query": "a"},
    "pydslrep/plannedPath": {"uri": URI, "environment": "area_00001"},
}


def main() -> None:
    """Prints a row for each request."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", 1)[0])
    parser.add_argument("server", help="a command that starts a server on stdio")
    parser.add_argument("--lines", type=int, default=100_000)
    options = parser.parse_args()
    print(f"{'request':36} {'takes ms':>9} {'hovers':>7} {'longest ms':>11}")
    with Client(shlex.split(options.server)) as client:
        client.open(program(options.lines).text)
        client.settled([])  # Else the first hover waits for the document to be opened.
        for method, params in REQUESTS.items():
            takes, hovers = waiting(client, method, params)
            longest = max(hovers) * 1000
            print(f"{method:36} {takes * 1000:9.1f} {len(hovers):7} {longest:11.2f}")


def waiting(
    client: Client, method: str, params: dict[str, object]
) -> tuple[float, list[float]]:
    """The seconds until the response to a request, and those of each hover meanwhile."""
    slow, begun = client.send(method, params)
    hovers: list[float] = []
    ended = 0.0
    while not ended:
        ident, started = client.send("textDocument/hover", DOCUMENT | POSITION)
        while True:
            arrived, body = client.arrived.get(timeout=MAX_WAIT)
            answered = id_of(body or b"")
            if answered == slow:
                ended = arrived
            elif answered == ident:
                break
        hovers.append(arrived - started)
    return ended - begun, hovers


def id_of(body: bytes) -> int | None:
    """The id of a response. Megabytes are not parsed, which would keep the hover waiting here."""
    found = re.match(rb'{"jsonrpc":"2.0","id":(\d+),"(result|error)"', body)
    return int(found[1]) if found else None


if __name__ == "__main__":
    main()
