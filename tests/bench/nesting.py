"""What a key costs in a movement with blocks and in one without, counted in instructions of the server.

    python3 tests/bench/nesting.py [--words 100,200,350] [--lines 10000] target/release/pydslrep-lsp

needs valgrind. Both movements have as many words, and other load on the machine does not matter. A key makes an error or
removes it, and the diagnostics are requested after each; where completion is measured, a list too. With `--lines`, more
movements of the same kind follow, until the program has that many lines.
"""

from __future__ import annotations

import argparse
import itertools
import pathlib
import re
import tempfile

from client import URI, Client

HEAD = """\
wheel l with radius 3.5
wheel r with radius 3.5
sensor front : distance
robot rover with port 20000 has { l r } wheels with sensors { front }

movement m of rover {
"""
TAIL = "}\n\nenvironment yard has { rover } robots with { m } moves\n"
STATEMENTS = (
    "move 3.2 meters at 18.7",
    "turn left until { front }",
    "turn right 45.0",
    "move 1.2 meters",
    "turn left 22.5",
    "move 143.3 centimeters at 2.4",
)
BLOCKS = (
    "repeat 5 times {",
    "if { front } detect within 1.0 meters {",
    "repeat 3 times {",
)
# Of each dozen lines, those that open a block and those that close one.
OPENS, CLOSES = (0, 3), (7, 10)
COMPLETION = "completion"
EDITS = {
    "syntax error": ("meters", 5),
    "broken reference": ("until { front", 13),
    COMPLETION: ("until { front", 13),
}
"""What a line has whose character at that place is taken away and typed again."""
# Words of a block that is worth opening: an empty one has a warning.
MIN_WORDS = 20
FEW, MANY = 50, 250
SLOW = 600.0  # s


def words(text: str) -> int:
    return len(re.findall(r"[\w.]+|[{}]", text))


def flat(size: int) -> str:
    """A movement of that many words without blocks."""
    lines: list[str] = []
    for statement in itertools.cycle(STATEMENTS):
        if words(" ".join(lines)) >= size:
            break
        lines.append(f"  {statement}\n")
    return "".join(lines)


def nested(size: int) -> str:
    """A movement of that many words with blocks in blocks."""
    lines: list[str] = []
    depth = 1
    for number, statement in enumerate(itertools.cycle(STATEMENTS)):
        left = size - words(" ".join(lines)) - depth + 1
        if left <= 0:
            break
        if number % 12 in OPENS and depth <= len(BLOCKS) and left > MIN_WORDS:
            lines.append(f"{'  ' * depth}{BLOCKS[depth - 1]}\n")
            depth += 1
        elif number % 12 in CLOSES and depth > 1:
            depth -= 1
            lines.append(f"{'  ' * depth}}}\n")
        else:
            lines.append(f"{'  ' * depth}{statement}\n")
    closing = (f"{'  ' * level}}}\n" for level in range(depth - 1, 0, -1))
    return "".join([*lines, *closing])


def instructions(server: pathlib.Path, text: str, edit: str, keys: int) -> int:
    """What a server takes from its start to its end."""
    with tempfile.TemporaryDirectory() as folder:
        log = pathlib.Path(folder, "log")
        valgrind = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null"]
        command = [*valgrind, f"--log-file={log}", str(server.resolve()), "--stdio"]
        client = Client(command, max_wait=SLOW)
        client.open(text)
        type_keys(client, keys, *place_of(text, edit), completes=edit == COMPLETION)
        client.ask("shutdown", None)
        client.tell("exit", None)
        client.process.wait(timeout=SLOW)
        counted = re.search(r"Collected : (\d+)", log.read_text(encoding="utf-8"))
    assert counted is not None
    return int(counted[1])


def place_of(text: str, edit: str) -> tuple[int, int, str]:
    """The line and the column of a letter in the middle of the first movement, and the letter."""
    part, offset = EDITS[edit]
    lines = text.split("\n}\n", 1)[0].splitlines()
    fitting = [
        number
        for number, line in enumerate(lines)
        if part in line and line.strip() in STATEMENTS
    ]
    line = fitting[len(fitting) // 2]
    start = lines[line].index(part) + offset - 1
    return line, start, lines[line][start]


def type_keys(
    client: Client, keys: int, line: int, start: int, letter: str, *, completes: bool
) -> None:
    """Takes a letter away and types it again, by turns; the answers must have an error, and none."""
    for key in range(keys):
        if key % 2 == 0:
            client.change(line, start, start + 1, "")
        else:
            client.change(line, start, start, letter)
        found, _ = client.settled([])
        assert found == [line] * (key % 2 == 0), found
        if completes and key % 2 == 0:
            complete(client, line, start - 1)


def complete(client: Client, line: int, column: int) -> None:
    """Asks for the list within what is left of a sensor's name, as a user does; it must have the name."""
    place = {"line": line, "character": column}
    parameters = {"textDocument": {"uri": URI}, "position": place}
    found, _ = client.ask("textDocument/completion", parameters)
    assert [item["label"] for item in found["items"]] == ["front"], found


def program(movement: str, lines: int) -> str:
    """A program of at least that many lines: the movement as `m`, and again under other names."""
    head, tail = f"{HEAD}{movement}", TAIL
    more = -(-max(lines - f"{head}{tail}".count("\n"), 0) // (movement.count("\n") + 2))
    names = [f"m{number}" for number in range(more)]
    others = [f"}}\nmovement {name} of rover {{\n{movement}" for name in names]
    return "".join(
        [head, *others, tail.replace("{ m }", f"{{ {' '.join(['m', *names])} }}")]
    )


def per_key(server: pathlib.Path, text: str, edit: str) -> float:
    """Thousands of instructions; what a server takes besides its keys does not count."""
    few, many = (instructions(server, text, edit, keys) for keys in (FEW, MANY))
    return (many - few) / (MANY - FEW) / 1000.0


def main() -> None:
    """Prints a row for each edit and size."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", 1)[0])
    parser.add_argument("server", type=pathlib.Path)
    parser.add_argument("--words", default="100,200,350")
    parser.add_argument("--lines", type=int, default=0, help="of the program")
    options = parser.parse_args()
    print(f"{'thousands of instructions per key':36} {'flat':>8} {'nested':>8} ratio")
    for edit, size in itertools.product(EDITS, map(int, options.words.split(","))):
        texts = [program(kind(size), options.lines) for kind in (flat, nested)]
        costs = [per_key(options.server, text, edit) for text in texts]
        ratio = costs[1] / costs[0]
        row = f"{edit}, {size} words"
        print(f"{row:36} {costs[0]:8.0f} {costs[1]:8.0f} {ratio:5.2f}", flush=True)


if __name__ == "__main__":
    main()
