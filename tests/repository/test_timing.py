"""No test depends on how fast the machine is.

A test waits for an event or a state (`tests/support/until.py`), and where time is its subject it counts what takes the
time. Pauses and clocks are refused but for those of `ALLOWED`.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]

# What pauses a test, or reads a clock, by the language of a file.
PYTHON = r"(?<!\")\b(time\.(sleep|monotonic|perf_counter|time|process_time)(_ns)?|asyncio\.sleep|from time import)\b"
SCRIPT = r"\b(setTimeout|setInterval|waitForTimeout|performance\.(now|timeOrigin)|Date\.now|hrtime)\b"
LUA = r"\bvim\.(wait|defer_fn|uv\.(hrtime|now|sleep|new_timer)|loop\.\w+)\b|\bos\.(clock|time)\b"
RUST = (
    r"\bthread::sleep|\btime::sleep|\bsleep\(|\bInstant\b|\bSystemTime\b|\belapsed\(\)"
)
SHELL = r"(^|[;&|]\s*|\bdo )sleep [\d.]+"
SUSPECT = {
    ".py": PYTHON,
    ".mjs": SCRIPT,
    ".ts": SCRIPT,
    ".lua": LUA,
    ".rs": RUST,
    ".sh": SHELL,
}

# By file or folder: a part of the line, and why no result depends on it.
ALLOWED: dict[str, dict[str, str]] = {
    "tests/support/until.py": {
        "time.": "waits for a state, up to a limit",
    },
    "tests/editors/terminal.py": {
        "time.sleep(0.02)": "types as a person does: editors take a burst for a paste",
        "time.monotonic()": "waits for a state of the screen, up to a limit",
        "time.sleep(0.05)": "waits for a state of the screen, up to a limit",
    },
    "tests/editors/neovim/harness.lua": {
        "vim.defer_fn": "waits for a state of the editor, up to a limit",
        "vim.uv.hrtime()": "waits for a state of the editor, up to a limit",
    },
    "tests/editors/vscode/stage.mjs": {
        "Date.now()": "waits for a state of the page, up to a limit; and names pictures",
        "setTimeout(resolve, 50)": "waits for a state of the page, up to a limit",
        "setTimeout(resolve, 5000)": "after all tests: does not wait for a browser that hangs",
    },
    "tests/editors/vscode/preview.test.mjs": {
        "performance.": "prints a figure; nothing is compared with it",
    },
    "tests/editors/preview/preview.test.mjs": {
        "performance.now()": "prints a figure; nothing is compared with it",
    },
    "tests/editors/preview/panel.mjs": {
        "performance.now()": "prints a figure; nothing is compared with it",
    },
    "tests/editors/web/web.test.mjs": {
        "performance.now()": "prints a figure; nothing is compared with it",
    },
    "tests/editors/web/browser.mjs": {
        "performance.now()": "prints a figure; nothing is compared with it",
    },
    "tests/editors/playground/runs.test.mjs": {
        "Date.now()": "waits for a state, up to a limit",
    },
    "tests/editors/playground/figures.mjs": {
        "performance.now()": "measures the playground; it is no test",
        "waitForTimeout": "measures the playground; it is no test",
        "setTimeout": "measures the playground; it is no test",
    },
    "tests/editors/typing/": {
        "time.": "types at a pace, and waits for a state: what an editor does then is the subject",
        "performance.now()": "types at a pace",
        "setTimeout(": "types at a pace",
    },
    "tests/dist/test_windows.py": {
        "time.sleep(0.05)": "waits for a file, in a program that Wine runs",
    },
    "tests/hostile/test_lying_engine.py": {
        "time.monotonic()": "that a command ends at all is the subject; its limit is generous",
    },
    "tests/runner/": {
        "time.monotonic()": "the test command itself: prints how long its parts took",
    },
    "tests/hostile/test_kills.py": {
        "time.monotonic()": "a command is killed at a part of the time that it takes",
    },
    "tests/scripts/motor_driver.py": {
        "time.": "replaces the clock by a simulated one",
    },
    "tests/vrep/sim.py": {
        "time.monotonic()": "stands in for the vendor's client, whose messages have times",
    },
    "python/tests/test_event_loop.py": {
        "asyncio.sleep(": "simulated time, or a turn of the event loop",
    },
    "python/tests/test_failures.py": {
        "time.monotonic": "moves the clock on by as much as a test wants",
    },
    "python/tests/test_runner.py": {
        "asyncio.sleep(": "simulated time",
    },
    "python/tests/test_parallel.py": {
        "asyncio.sleep(": "simulated time",
    },
}

# Benchmarks, what is compared with fuzzing's clocks, and packages of others.
NO_TESTS = ("tests/bench/", "tests/article/by_hand/")


def files() -> Iterator[Path]:
    """The files of tests."""
    places = ("tests/**", "python/tests/**", "editors/*/tests/**", "crates/*/tests/**")
    for place in places:
        for path in ROOT.glob(f"{place}/*"):
            name = path.relative_to(ROOT).as_posix()
            skipped = "node_modules/" in name or "/target/" in name
            if path.suffix in SUSPECT and not skipped and not name.startswith(NO_TESTS):
                yield path
    for path in ROOT.glob("crates/*/src/**/*.rs"):
        yield path


def of_tests(path: Path) -> list[str]:
    """The lines of a file that belong to tests."""
    lines = path.read_text(encoding="utf-8").splitlines()
    if "src" not in path.relative_to(ROOT).parts[:3] or "crates" not in path.parts:
        return lines
    if path.stem == "tests" or "tests" in path.relative_to(ROOT).parts:
        return lines
    begin = next((n for n, line in enumerate(lines) if line == "mod tests {"), None)
    return [] if begin is None else lines[begin:]


@cache
def found() -> dict[str, list[str]]:
    """By file, the lines of tests that pause or read a clock."""
    suspects: dict[str, list[str]] = {}
    for path in files():
        name = path.relative_to(ROOT).as_posix()
        if name == "tests/repository/test_timing.py":
            continue
        for line in of_tests(path):
            if re.search(SUSPECT[path.suffix], line):
                suspects.setdefault(name, []).append(line.strip())
    return suspects


def uses(name: str, line: str) -> list[tuple[str, str]]:
    """What allows a line."""
    return [
        (place, part)
        for place, parts in ALLOWED.items()
        if name == place or (place.endswith("/") and name.startswith(place))
        for part in parts
        if part in line
    ]


def test_no_test_pauses_or_reads_a_clock() -> None:
    refused = [
        f"{name}: {line}"
        for name, lines in found().items()
        for line in lines
        if not uses(name, line)
    ]
    print(*refused, sep="\n")
    assert refused == [], "wait for a state with `until`, or say in ALLOWED why not"


def test_what_is_allowed_is_used() -> None:
    used = {
        use
        for name, lines in found().items()
        for line in lines
        for use in uses(name, line)
    }
    allowed = {(place, part) for place, parts in ALLOWED.items() for part in parts}
    assert allowed - used == set(), "delete these from ALLOWED"


@pytest.mark.parametrize(
    ("suffix", "line"),
    [
        (".py", "    time.sleep(0.1)"),
        (".py", "assert time.perf_counter() - begin < 1.0"),
        (".py", "from time import monotonic"),
        (".mjs", "await page.waitForTimeout(100);"),
        (".mjs", "await new Promise((resolve) => setTimeout(resolve, 100));"),
        (".ts", "const begin = performance.now();"),
        (".lua", "vim.wait(100)"),
        (".rs", "    thread::sleep(Duration::from_millis(10));"),
        (".rs", "assert!(begin.elapsed() < LIMIT);"),
        (".sh", "sleep 1"),
    ],
)
def test_pauses_and_clocks_are_recognised(suffix: str, line: str) -> None:
    assert re.search(SUSPECT[suffix], line)


def test_tests_are_found() -> None:
    names = {path.relative_to(ROOT).as_posix() for path in files()}
    assert len(names) > 500
    assert {"tests/conftest.py", "tests/lsp/raw.py", "tests/site/site.test.mjs"} < names
