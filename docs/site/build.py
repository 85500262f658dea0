"""Builds the documentation site from `docs` with mdBook, into `target/site/html`; with `--check`, checks its links, too.

The pages stay what a repository's host shows: links lead to files of the repository, formulas are LaTeX, and code has no
colours. The site gets a copy in which links lead to pages of the site, formulas are MathML, and code is highlighted, so that
it needs neither the network nor scripts. A linked file that is not a page is part of the site, too.
"""

from __future__ import annotations

import argparse
import base64
import json
import os
import re
import shutil
import subprocess
import sys
import zlib
from pathlib import Path, PurePosixPath

from latex2mathml.converter import convert
from pydslrep_lexer import PydslrepLexer
from pygments import highlight  # type: ignore[import-untyped]
from pygments.formatters import HtmlFormatter  # type: ignore[import-untyped]
from pygments.lexers import get_lexer_by_name  # type: ignore[import-untyped]

ROOT = Path(__file__).resolve().parents[2]
DOCS = PurePosixPath("docs")
SITE = ROOT / "target" / "site"
SOURCE = SITE / "src"
HTML = SITE / "html"

PLAYGROUND = ROOT / "editors" / "playground" / "dist"
OPEN_IN_PLAYGROUND = "Open in the playground"

# The entry of the summary whose pages are listed below it, in the order of its table.
CATALOGUE = DOCS / "diagnostics" / "README.md"

LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s]+)\)")
FENCE = re.compile(
    r"^(?P<indent> *)```(?P<info>[^\n`]*)\n(?P<code>.*?)^(?P=indent)```$", re.M | re.S
)
INLINE_CODE = re.compile(r"(`+)(?!`).*?(?<!`)\1(?!`)", re.S)
INLINE_MATH = re.compile(r"\$`([^`]+)`\$")
IMPORT = re.compile(r"^\s*import\b", re.M)
FUNCTION = re.compile(r"(?<!<msup>)<mi>(?:sin|cos)</mi>")

# What browsers show by itself; the names of others get `.txt`.
SHOWN = {".json", ".txt", ".png", ".svg"}

# The names of languages in the pages that Pygments calls otherwise.
LEXERS = {"sh": "bash"}


class PageError(Exception):
    """A page has something that the site cannot show."""


def main() -> int:
    """Builds the site; returns the exit code."""
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--check", action="store_true", help="check all links")
    check = arguments.parse_args().check
    try:
        prepare()
    except PageError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    return build() or (check_links() if check else 0)


def prepare() -> None:
    """Writes the source of mdBook."""
    shutil.rmtree(SITE, ignore_errors=True)
    summary = complete_summary()
    pages = {link(page) for page in re.findall(r"\]\((.+?)\)", summary)}
    forgotten = {
        path.relative_to(ROOT).as_posix() for path in (ROOT / DOCS).rglob("*.md")
    }
    forgotten -= {str(page) for page in pages} | {str(DOCS / "SUMMARY.md")}
    if forgotten:
        raise PageError(f"docs/SUMMARY.md does not list {', '.join(sorted(forgotten))}")
    write(
        PurePosixPath("SUMMARY.md"),
        LINK.sub(lambda match: f"[{match[2]}]({place(link(match[3]))})", summary),
    )
    for page in pages:
        write(place(page), Page(page, pages).text())
    shutil.copytree(ROOT / DOCS / "images", SOURCE / "images")


def complete_summary() -> str:
    """The summary with the pages of diagnostics."""
    summary = (ROOT / DOCS / "SUMMARY.md").read_text(encoding="utf-8")
    catalogue = (ROOT / CATALOGUE).read_text(encoding="utf-8")
    pages = re.findall(r"^\| \[([\w-]+)\]\(", catalogue, re.M)
    entry = re.compile(r"^.*\(diagnostics/README\.md\)$", re.M)
    children = "".join(f"\n  - [{page}](diagnostics/{page}.md)" for page in pages)
    return entry.sub(lambda match: match[0] + children, summary)


def link(written: str) -> PurePosixPath:
    """The path in the repository of a link in the summary."""
    return PurePosixPath(os.path.normpath(DOCS / written))


def place(path: PurePosixPath) -> PurePosixPath:
    """The place of a page in the book."""
    path = path.relative_to(DOCS) if path.is_relative_to(DOCS) else path
    if path.name == "README.md":
        return path.with_name("index.md")
    return path.with_stem(path.stem.lower()) if path.stem.isupper() else path


def write(path: PurePosixPath, text: str) -> None:
    """Writes a file of mdBook's source."""
    file = SOURCE / path
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text, encoding="utf-8")


class Page:
    """A page of the repository that becomes one of the site."""

    def __init__(self, path: PurePosixPath, pages: set[PurePosixPath]) -> None:
        """`pages` are all pages of the site, by their paths in the repository."""
        self.path, self.pages = path, pages

    def text(self) -> str:
        """The page as it is in the site."""
        try:
            text = (ROOT / self.path).read_text(encoding="utf-8")
        except FileNotFoundError:
            raise PageError(
                f"docs/SUMMARY.md lists {self.path}, which does not exist"
            ) from None
        out, end = [], 0
        for fence in FENCE.finditer(text):
            out += [self._prose(text[end : fence.start()]), self._code(fence)]
            end = fence.end()
        return "".join([*out, self._prose(text[end:])])

    def _prose(self, text: str) -> str:
        text = INLINE_MATH.sub(lambda match: mathml(match[1], "inline"), text)
        # Links in code are none.
        codes: list[str] = []

        def hide(match: re.Match[str]) -> str:
            codes.append(match[0])
            return f"\0{len(codes) - 1}\0"

        text = LINK.sub(self._link, INLINE_CODE.sub(hide, text))
        return re.sub(r"\0(\d+)\0", lambda match: codes[int(match[1])], text)

    def _link(self, match: re.Match[str]) -> str:
        mark, text, target = match.groups()
        path, _, fragment = target.partition("#")
        if ":" in path or not path:
            return match[0]
        there = self._target(PurePosixPath(os.path.normpath(self.path.parent / path)))
        if there is None:
            return text
        relative = os.path.relpath(there, place(self.path).parent)
        return f"{mark}[{text}]({relative}{'#' * bool(fragment)}{fragment})"

    def _target(self, path: PurePosixPath) -> PurePosixPath | None:
        """Where a file of the repository is in the site; None for a folder without a page."""
        file = ROOT / path
        if not file.exists():
            raise PageError(f"{self.path} links to {path}, which does not exist")
        if file.is_dir():
            path /= "README.md"
            return place(path) if path in self.pages else None
        if path in self.pages:
            return place(path)
        if path.is_relative_to(DOCS):
            return path.relative_to(DOCS)
        there = "source" / path
        if path.suffix == ".md":
            there = there.with_suffix(".txt")
        elif path.suffix not in SHOWN:
            there = there.with_name(f"{path.name}.txt")
        write(there, file.read_text(encoding="utf-8"))
        return there

    def _code(self, fence: re.Match[str]) -> str:
        indent, info, code = fence["indent"], fence["info"].split(), fence["code"]
        language = info[0] if info else "text"
        code = re.sub(rf"^{indent}", "", code, flags=re.M)
        shown = (
            mathml(code, "block") if language == "math" else coloured(language, code)
        )
        if language == "pydslrep" and is_whole(info, code) and PLAYGROUND.exists():
            page = os.path.relpath("playground/index.html", place(self.path).parent)
            shown += playground_link(page, code)
        return re.sub(r"^(?=.)", indent, shown, flags=re.M)


def is_whole(info: list[str], code: str) -> bool:
    """Whether a block is a whole program: neither a part of one, nor with parts in other files."""
    return "fragment" not in info and not IMPORT.search(code)


def playground_link(page: str, program: str) -> str:
    """A paragraph with a link that opens a program in the playground."""
    target = f"{page}{fragment_of(program)}"
    return f'\n<p class="in-playground"><a href="{target}">{OPEN_IN_PLAYGROUND}</a></p>'


def fragment_of(program: str) -> str:
    """The fragment of a link to a program, as `editors/playground/src/permalink.ts` reads it."""
    project = {"name": "program", "program": program, "settings": "", "scenes": {}}
    packer = zlib.compressobj(9, wbits=-zlib.MAX_WBITS)
    packed = packer.compress(json.dumps(project).encode()) + packer.flush()
    return f"#project={base64.urlsafe_b64encode(packed).decode().rstrip('=')}"


def mathml(latex: str, display: str) -> str:
    """A formula in MathML, on one line."""
    shown = " ".join(convert(latex, display=display).split("\n"))
    # The converter puts names of functions against what is beside them.
    space = '<mspace width="0.17em"/>'
    return FUNCTION.sub(lambda match: f"{space}{match[0]}{space}", shown)


def coloured(language: str, code: str) -> str:
    """A block of code in HTML."""
    if language == "pydslrep":
        lexer = PydslrepLexer()
    else:
        lexer = get_lexer_by_name(LEXERS.get(language, language), stripnl=False)
    shown = highlight(code, lexer, HtmlFormatter(nowrap=True))
    # `nohighlight`: mdBook's highlighter leaves it alone, which `language-…` would not let it.
    return f'<pre><code class="code nohighlight">{shown}</code></pre>'


def tool(name: str) -> str:
    """A tool of the environment that this runs in, else of the PATH."""
    beside = Path(sys.executable).with_name(name)
    return str(beside) if beside.exists() else name


def build() -> int:
    """Runs mdBook, for which a warning is an error."""
    done = subprocess.run(  # noqa: S603
        [tool("mdbook"), "build", ROOT / "docs" / "site"],
        capture_output=True,
        encoding="utf-8",
        check=False,
    )
    if done.returncode or re.search(r"\b(WARN|ERROR)\b", done.stderr):
        print(done.stderr, end="", file=sys.stderr)
        return 1
    if PLAYGROUND.exists():
        shutil.copytree(PLAYGROUND, HTML / "playground", dirs_exist_ok=True)
    print(f"{HTML.relative_to(ROOT)}/index.html")
    return 0


def check_links() -> int:
    """Checks that every link within the site leads to a page, and to a heading of it."""
    options = ["--offline", "--include-fragments", "--no-progress"]
    # What follows `#` is a program, not a heading.
    options += ["--exclude", r"/playground/index\.html#project="]
    command = [tool("lychee"), *options, str(HTML)]
    return subprocess.run(command, check=False).returncode  # noqa: S603


if __name__ == "__main__":
    sys.exit(main())
