"""The blocks of code in the pages of the documentation, and how they are run."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import textwrap
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "examples"

PAGES = sorted(
    [
        ROOT / "README.md",
        ROOT / "CONTRIBUTING.md",
        ROOT / "SECURITY.md",
        *(ROOT / "docs").rglob("*.md"),
        *(ROOT / "editors").glob("*.md"),
        *(ROOT / "editors").glob("*/README.md"),
    ]
)

FENCE = re.compile(
    r"^(?P<indent> *)```(?P<info>[^\n`]*)\n(?P<code>.*?)^(?P=indent)```$", re.M | re.S
)

# What differs from run to run.
VARIABLE = [
    (
        re.compile(r"simulated in [\d.]+ s, [\d.]+ times real time"),
        "simulated in … s, … times real time",
    ),
]

# From a clone, the command is run by cargo.
BY_CARGO = re.compile(r"^cargo run .*--bin pydslrep -- ")


@dataclass
class Block:
    """A block of code in a page."""

    page: Path
    span: tuple[int, int]
    """Where its code is in the page."""
    indent: str
    info: list[str]
    """The language, then what a test needs to know."""
    code: str
    lead: str
    """The paragraph in front of it."""
    heading: str
    """The heading that it is under."""

    @property
    def language(self) -> str:
        """The language; empty if it has none."""
        return self.info[0] if self.info else ""

    @property
    def file(self) -> str | None:
        """The file that it is, where the paragraph in front of it ends in one: `NAME`, and a colon."""
        found = re.search(r"`([\w./-]+\.\w+)`[^`]*:$", self.lead)
        return found[1] if found else None

    @property
    def is_appended(self) -> bool:
        """Whether it follows what the file already has."""
        return "Append" in self.lead

    def __str__(self) -> str:
        text = self.page.read_text(encoding="utf-8")
        line = text.count("\n", 0, self.span[0])
        return f"{self.page.relative_to(ROOT)}:{line}"


def blocks(page: Path) -> list[Block]:
    """The blocks of a page, in order."""
    text = page.read_text(encoding="utf-8")
    found = []
    for fence in FENCE.finditer(text):
        before = text[: fence.start()]
        headings = re.findall(r"^#+ (.*)", FENCE.sub("", before), re.M)
        indent, code = fence["indent"], fence["code"]
        found.append(
            Block(
                page,
                fence.span("code"),
                indent,
                fence["info"].split(),
                re.sub(rf"^{indent}", "", code, flags=re.M),
                before.rstrip().rpartition("\n\n")[2],
                headings[-1] if headings else "",
            )
        )
    return found


def pictures(page: Path) -> list[Path]:
    """The pictures in a page."""
    text = page.read_text(encoding="utf-8")
    links = re.findall(r"!\[[^\]]*\]\(([^):]+)\)", text)
    return [(page.parent / link).resolve() for link in links]


def comparable(output: str) -> str:
    """An output without what differs from run to run."""
    for pattern, stable in VARIABLE:
        output = pattern.sub(stable, output)
    return output


@dataclass
class Session:
    """The files and commands of one page, in a folder of their own that also has the examples."""

    command: str
    folder: Path
    has_examples: bool = True
    cwd: Path = field(init=False)
    path: str = field(init=False)

    def __post_init__(self) -> None:
        """Prepares the folder."""
        self.cwd = self.folder
        tools = self.folder.with_name(f"{self.folder.name}-bin")
        for folder in (tools, self.folder):
            folder.mkdir(parents=True)
        (tools / "pydslrep").symlink_to(Path(self.command).resolve())
        self.path = f"{tools}{os.pathsep}{os.environ['PATH']}"
        if self.has_examples:
            shutil.copytree(
                EXAMPLES,
                self.folder / "examples",
                ignore=shutil.ignore_patterns("*.py", "*.svg", "*.json*", "pydslrep_*"),
            )

    def write(self, block: Block) -> Path:
        """Writes the file that a block is; one without a name is `program.pyr`."""
        path = self.cwd / (block.file or "program.pyr")
        path.parent.mkdir(parents=True, exist_ok=True)
        before = path.read_text(encoding="utf-8") if block.is_appended else ""
        path.write_text(before + block.code, encoding="utf-8")
        return path

    def run(self, command: str) -> tuple[int, str]:
        """The exit code and the output of a line of a shell."""
        if command.startswith("cd "):
            self.cwd = (self.cwd / command.removeprefix("cd ")).resolve()
            return 0, ""
        done = subprocess.run(
            ["bash", "-c", BY_CARGO.sub("pydslrep ", command)],
            cwd=self.cwd,
            env={**os.environ, "PATH": self.path, "NO_COLOR": "1"},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            encoding="utf-8",
            check=False,
        )
        return done.returncode, done.stdout

    def transcript(self, block: Block) -> str:
        """A block of commands, each after `$`, with the output that they have now."""
        out = ""
        for command in commands(block):
            _, output = self.run(command)
            out += f"$ {command}\n"
            if output.strip():
                out += output.strip("\n") + "\n"
        return out


def commands(block: Block) -> list[str]:
    """The commands of a block."""
    code = re.sub(r"\\\n\s*", "", block.code)
    if block.language == "console":
        return re.findall(r"^\$ (.*)", code, re.M)
    return [line for line in textwrap.dedent(code).splitlines() if line]
