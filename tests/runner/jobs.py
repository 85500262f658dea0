"""The table of everything that the test command runs."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import results

ROOT = Path(__file__).resolve().parents[2]
TARGET = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
LOGS = ROOT / "target" / "tests"
BUILT = TARGET / "debug"

NEXTEST_REPORT = ROOT / "target" / "nextest" / "default" / "junit.xml"


@dataclass(frozen=True)
class Job:
    """Commands that belong together: all of them run, whatever fails before."""

    name: str
    commands: tuple[str, ...]
    after: tuple[str, ...] = ()
    """The jobs that must have ended first; without those that prepare something, it cannot run."""
    read: Callable[[str], results.Results] = results.of_nothing
    processors: int = 1
    """How many it keeps busy."""
    cargo: bool = False
    """Whether it builds: two that do would wait for each other."""
    editor: bool = False
    """Whether it drives a real editor or browser: only `--editors` runs it, and what failed there is tried once more."""
    prepares: bool = False
    """Whether others need it; it says nothing about the project by itself."""


def rust_tests() -> str:
    """The command that runs the tests of all crates."""
    if shutil.which("cargo-nextest"):
        return "cargo nextest run --workspace --locked --no-fail-fast --status-level fail --final-status-level fail"
    return "cargo test --workspace --locked --no-fail-fast"


SITE = "tests/site/run.sh"
NODE = "tests/install/with-node.sh"
NATIVE, WEB = "target/tests/native-package", "target/tests/web-package"
"""Files that name the packages of the extension."""


def prepared(editors: bool) -> list[Job]:
    """What checks need."""
    jobs = [
        Job(
            "tools",
            (
                "tests/install/python.sh",
                "tests/install/npm.sh grammar/textmate editors/preview editors/vscode",
            ),
            prepares=True,
        ),
        Job(
            "build",
            # The features of tests are those of the commands, so nothing is compiled twice.
            (
                "tests/install/rust.sh && cargo build --workspace --lib --bins --examples --tests --locked",
            ),
            processors=2,
            cargo=True,
            prepares=True,
        ),
    ]
    if editors:
        jobs += [
            Job(
                "editors",
                ("tests/install/editors.sh",),
                after=("tools",),
                prepares=True,
            ),
            Job(
                "web-build",
                ("CARGO_PROFILE=dev editors/web/build.sh",),
                after=("tools", "build"),
                processors=2,
                cargo=True,
                prepares=True,
            ),
            # Once for all parts that open it.
            Job(
                "playground-build",
                (f"{NODE} npm run --silent --prefix editors/playground build",),
                after=("tools", "editors", "web-build"),
                prepares=True,
            ),
            Job(
                "packages",
                (
                    f'editors/vscode/package.sh --command "$PYDSLREP" >{NATIVE}',
                    f"editors/vscode/package.sh --target web >{WEB}",
                ),
                after=("tools", "build", "web-build", "extension"),
                prepares=True,
            ),
        ]
    return jobs


def checks() -> list[Job]:
    """What is checked without an editor."""
    return [
        Job("mypy", (".venv/bin/mypy",), after=("tools",)),
        Job(
            "extension",
            (
                f"{NODE} npm run --silent --prefix editors/preview check",
                f"{NODE} npm run --silent --prefix editors/vscode check",
            ),
            after=("tools", "build"),
            read=results.of_node,
        ),
        Job("site", (".venv/bin/python docs/site/build.py --check",), after=("tools",)),
        Job(
            "ruff",
            (".venv/bin/ruff check .", ".venv/bin/ruff format --check ."),
            after=("tools",),
        ),
        Job("rustfmt", ("cargo fmt --all --check",)),
        Job(
            "python",
            (
                # Otherwise one process ends long after the others: the slowest tests follow one another.
                f"{NODE} .venv/bin/pytest -n 4 --dist worksteal --durations=10 ${{LONG:+--long}}",
            ),
            after=("tools", "build"),
            # It counts as one processor: its four processes wait half of the time, for scripts, simulators and servers.
            read=results.of_pytest,
        ),
        Job(
            "rust",
            (rust_tests(),),
            after=("build",),
            read=results.of_rust(NEXTEST_REPORT),
            processors=2,
            cargo=True,
        ),
        Job(
            "scripts",
            (".venv/bin/python python/check_scripts.py",),
            after=("tools", "build"),
            cargo=True,
        ),
        Job(
            "clippy",
            ("tests/runner/clippy.sh",),
            after=("build",),
            processors=2,
            cargo=True,
        ),
        # All crates but the command build for a browser; the command alone uses the crate of the pictures.
        Job(
            "wasm",
            (
                "cargo clippy --locked --quiet --target wasm32-unknown-unknown --package pydslrep-browser --package pydslrep-picture -- --deny warnings",
            ),
            after=("build",),
            cargo=True,
        ),
        *(
            [Job("deny", ("cargo deny --offline check bans licenses sources",))]
            if shutil.which("cargo-deny")
            else []
        ),
    ]


def in_editors() -> list[Job]:
    """What is checked in real editors and browsers, and with ROS 2."""
    ready = ("tools", "build", "editors")
    editor = "tests/editors/run.sh"
    packages = f"VSIX=$(cat {NATIVE}) VSIX_WEB=$(cat {WEB})"

    def job(
        name: str,
        command: str,
        *after: str,
        read: Callable[[str], results.Results] | None = None,
    ) -> Job:
        read = read or results.of_node_in(f"{editor} {name}")
        needed = (*ready, *after)
        return Job(name, (command,), needed, read, editor=True)

    return [
        job(
            "vscode",
            f"{packages} {editor} vscode",
            "packages",
            read=results.of_node_in(f"{editor} vscode", in_sessions=True),
        ),
        job("playground", f"{editor} playground", "playground-build"),
        job(
            "typing",
            f"{packages} {editor} typing --patient ${{LONG:+--all}}",
            "packages",
            "playground-build",
            read=results.of_typing,
        ),
        job("preview", f"{editor} preview"),
        job("neovim", f"{editor} neovim", read=results.of_neovim),
        job(
            "documentation",
            SITE,
            "site",
            read=results.of_node_in(SITE),
        ),
        job("web", f"{editor} web", "web-build"),
        # No editor, but as large an installation, which most changes do not concern.
        Job(
            "ros",
            ("tests/ros/run.sh ${LONG:+--long}",),
            after=("tools", "build"),
            read=partial(results.of_pytest, command="tests/ros/run.sh"),
            editor=True,
        ),
    ]


# What begins last: parts that keep both processors of a small machine busy together, the long ones before those that are
# quick where everything is built.
LATE = (
    *("python", "vscode"),
    *("typing", "playground"),
    *("rust", "clippy"),
    *("preview", "neovim", "documentation", "web"),
)


def every() -> list[Job]:
    """All jobs, in the order in which they begin unless something keeps them from it."""
    jobs = [*prepared(True), *checks(), *in_editors()]
    return sorted(
        jobs, key=lambda job: LATE.index(job.name) if job.name in LATE else -1
    )


def chosen(names: list[str], editors: bool, long: bool) -> list[Job]:
    """The jobs of a run, with what they need."""
    table = {job.name: job for job in every()}
    wanted = set(names) or {job.name for job in checks()} | (
        {job.name for job in in_editors()} if editors else set()
    )
    # With editors, the build for a browser says more; without, it would be a sixth of the processor time.
    if not names and (editors or not long):
        wanted.discard("wasm")
    needed = list(wanted)
    while needed:
        for name in table[needed.pop()].after:
            if table[name].prepares and name not in wanted:
                wanted.add(name)
                needed.append(name)
    return [job for job in table.values() if job.name in wanted]
