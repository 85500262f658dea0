"""What a job's output says: how many tests ran, and which failed, each with the command that runs it alone."""

from __future__ import annotations

import re
import shlex
import xml.etree.ElementTree as ElementTree
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ("editors/preview", "editors/vscode")
"""Folders with unit tests in TypeScript."""
COLOURS = re.compile(r"\x1b\[[0-9;]*m")


@dataclass(frozen=True)
class Failure:
    """A test that failed."""

    name: str
    again: str
    """The command that runs only this test."""


@dataclass(frozen=True)
class Results:
    """What a job says about its tests."""

    passed: int = 0
    skipped: int = 0
    failures: tuple[Failure, ...] = ()


def of_nothing(output: str) -> Results:
    """For jobs that have no tests."""
    return Results()


def of_pytest(output: str, command: str = ".venv/bin/pytest") -> Results:
    """Reads the summary of pytest; `command` runs a test again."""
    counted = {
        word.removesuffix("s"): int(number)
        for line in output.splitlines()
        if re.search(r" in [\d.]+s\b", line)
        for number, word in re.findall(r"(\d+) (passed|failed|errors?|skipped)", line)
    }
    names = re.findall(
        r"^(?:FAILED|ERROR) (\S+?\.py(?:::.*?)?)(?: - .*)?$", output, re.MULTILINE
    )
    failures = tuple(
        Failure(name, f"{command} {shlex.quote(name)}") for name in dict.fromkeys(names)
    )
    return Results(counted.get("passed", 0), counted.get("skipped", 0), failures)


def of_rust(report: Path) -> Callable[[str], Results]:
    """Reads nextest's report, or what `cargo test` prints where nextest is missing."""

    def read(output: str) -> Results:
        if "Nextest run ID" in output and report.exists():
            return of_nextest(report.read_text(encoding="utf-8"))
        return of_cargo_test(output)

    return read


def of_nextest(report: str) -> Results:
    """Reads a report of nextest in JUnit's format."""
    passed, skipped, failures = 0, 0, []
    # Nextest itself wrote it.
    for suite in ElementTree.fromstring(report).iter("testsuite"):
        for case in suite.iter("testcase"):
            if case.find("failure") is not None or case.find("error") is not None:
                binary, name = suite.get("name", ""), case.get("name", "")
                failures.append(
                    Failure(
                        f"{binary} {name}",
                        f"cargo test {target(binary)} -- --exact {shlex.quote(name)}",
                    )
                )
            elif case.find("skipped") is not None:
                skipped += 1
            else:
                passed += 1
    return Results(passed, skipped, tuple(failures))


def target(binary: str) -> str:
    """The options of cargo that select what nextest calls `package::tests`, `package::bin/name` or `package`."""
    package, _, name = binary.partition("::")
    if not name:
        return f"--package {package} --lib"
    kind, _, stem = name.rpartition("/")
    return f"--package {package} --{kind or 'test'} {stem}"


def of_cargo_test(output: str) -> Results:
    """Reads what `cargo test` prints."""
    passed = sum(
        map(int, re.findall(r"^test result: .*? (\d+) passed;", output, re.MULTILINE))
    )
    names = re.findall(r"^test (\S+) \.\.\. FAILED$", output, re.MULTILINE)
    return Results(
        passed,
        0,
        tuple(Failure(name, f"cargo test --workspace {name}") for name in names),
    )


def of_node(output: str, run: str = "") -> Results:
    """Reads the summaries of Node's test runner; `run` is the script that runs it with options and files."""
    plain = COLOURS.sub("", output)
    passed = sum(map(int, re.findall(r"^. pass (\d+)$", plain, re.MULTILINE)))
    skipped = sum(map(int, re.findall(r"^. skipped (\d+)$", plain, re.MULTILINE)))
    found = re.findall(
        r"^test at (\S+?):\d+:\d+\n✖ (.*?) \([\d.]+ms\)$", plain, re.MULTILINE
    )
    return Results(
        passed,
        skipped,
        tuple(
            Failure(f"{Path(file).name}: {name}", in_node(file, name, run))
            for file, name in found
        ),
    )


def of_node_in(run: str, *, in_sessions: bool = False) -> Callable[[str], Results]:
    """Reads the summary of Node's test runner, which this script runs with options and files.

    Tests in sessions begin where the one before has ended: those of a file run together.
    """

    def read(output: str) -> Results:
        found = of_node(output, run)
        if not in_sessions:
            return found
        files = [failure.name.partition(": ")[0] for failure in found.failures]
        failures = zip(found.failures, files, strict=True)
        again = tuple(replace(one, again=f"{run} {file}") for one, file in failures)
        return replace(found, failures=again)

    return read


def in_node(file: str, name: str, run: str) -> str:
    """The command that runs one test of a file with Node's test runner."""
    pattern = shlex.quote(f"--test-name-pattern=^{re.escape(name)}$")
    # Node names files as seen from the folder in which it runs.
    if run:
        return f"{run} {pattern} {Path(file).name}"
    package = next(one for one in PACKAGES if (ROOT / one / file).exists())
    return f"npm test --prefix {package} -- {pattern}"


def of_lines(again: Callable[[str, str], str]) -> Callable[[str], Results]:
    """Reads lines that begin with `ok` or `FAIL`, in sections that begin with `==`.

    `again` makes the command from the name of the section and the line.
    """

    def read(output: str) -> Results:
        section, passed, failures = "", 0, []
        for line in COLOURS.sub("", output).splitlines():
            if header := re.match(r"== (.*)", line):
                section = header[1]
            elif verdict := re.match(r"((?:[\w-]+: )?)(ok  |FAIL) (.*)", line):
                name = f"{verdict[1]}{verdict[3]}"
                if verdict[2] == "FAIL":
                    failures.append(
                        Failure(f"{section} {name}".strip(), again(section, name))
                    )
                else:
                    passed += 1
        return Results(passed, 0, tuple(failures))

    return read


def of_neovim(output: str) -> Results:
    """Reads what the sessions of Neovim print, and the linter of Lua before them."""
    read = of_lines(lambda session, line: f"tests/editors/run.sh neovim {session}")
    sessions = read(output)
    lints = re.findall(
        r"^ +\S*?(\w+\.lua:\d+):\d+: (.*)", COLOURS.sub("", output), re.M
    )
    again = "tests/editors/run.sh neovim lint"
    failures = tuple(Failure(f"lint {place}: {what}", again) for place, what in lints)
    return replace(sessions, failures=failures + sessions.failures)


def of_typing(output: str) -> Results:
    """Reads which programs arrived as they were typed."""

    def again(section: str, line: str) -> str:
        editor, _, program = line.partition(": ")
        name, _, pace = program.removesuffix(" ms").partition(" at ")
        return f"tests/editors/run.sh typing --patient --editor {editor} --programs {shlex.quote(name)} --pace {pace}"

    return of_lines(again)(output)
