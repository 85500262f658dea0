"""The statements of a movement in its script: their numbers there, and their lines in the program."""

import ast
import functools
import linecache
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from types import CodeType

# A comment of a generated script: `# line 7: move 4.0 meters`, `# shared.pyr, line 7: move 4.0 meters`.
PLACE = re.compile(r"#\s+(?:\S.*, )?line (\d+): ")

Function = ast.FunctionDef | ast.AsyncFunctionDef


@dataclass(frozen=True)
class Statement:
    """A statement of a movement."""

    number: int  # in text order, from 1
    line: int | None  # in the program, if a comment says so


Table = Mapping[int, Statement]
"""The statements of a function by the lines of the script that they begin on."""


def statements_of(code: CodeType) -> Table | None:
    """The statements of a function; None if there is no source."""
    return _tables(code.co_filename).get(code.co_firstlineno)


@functools.cache
def _tables(file: str) -> Mapping[int, Table]:
    """The tables of the functions in a file, by the lines that they begin on."""
    lines = linecache.getlines(file)
    try:
        tree = ast.parse("".join(lines))
    except (SyntaxError, ValueError, RecursionError):
        return {}
    found = {}
    for node in ast.walk(tree):
        if isinstance(node, Function):
            first = min([node, *node.decorator_list], key=lambda part: part.lineno)
            found[first.lineno] = _table(node, lines)
    return found


def _table(function: Function, lines: Sequence[str]) -> Table:
    found: dict[int, Statement] = {}
    for number, node in enumerate(_statements(function), start=1):
        first, last = node.lineno, _end_of_head(node)
        statement = Statement(number, _program_line(lines, first, last))
        for line in range(first, last + 1):
            found.setdefault(line, statement)
    return found


def _statements(function: Function) -> Iterator[ast.stmt]:
    """The statements that count, in text order: loops, `if`, `elif`, and whatever awaits something."""
    waiting: list[ast.AST] = [function]
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.stmt) and node is not function and _counts(node):
            yield node
        # Reversed, as the last one is taken first. What is deeply nested must not need a deep stack.
        blocks = [
            child
            for child in ast.iter_child_nodes(node)
            if isinstance(child, ast.stmt | ast.excepthandler | ast.match_case)
            and not isinstance(child, Function | ast.ClassDef)
        ]
        waiting.extend(reversed(blocks))


def _counts(node: ast.stmt) -> bool:
    if isinstance(node, ast.If | ast.For | ast.AsyncFor | ast.While):
        return True
    has_block = hasattr(node, "body") or hasattr(node, "cases")
    return not has_block and any(isinstance(part, ast.Await) for part in ast.walk(node))


def _end_of_head(node: ast.stmt) -> int:
    """The last line of a statement without its blocks."""
    match node:
        case ast.If() | ast.While():
            end = node.test.end_lineno
        case ast.For() | ast.AsyncFor():
            end = node.iter.end_lineno
        case _:
            end = node.end_lineno
    return end or node.lineno


def _program_line(lines: Sequence[str], first: int, last: int) -> int | None:
    """The line that a comment names: one on the lines of a statement, or one above it."""
    for number in range(first, last + 1):
        if found := PLACE.search(lines[number - 1]):
            return int(found[1])
    above = lines[first - 2].strip() if first > 1 else ""
    found = PLACE.match(above)
    return int(found[1]) if found else None
