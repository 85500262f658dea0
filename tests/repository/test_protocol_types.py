"""docs/protocol.md repeats the types that editors read: `UPDATE_EXPECT=1` copies them anew.

Samples that the server's own tests write hold these types against what is really sent (editors/preview/tests, editors/vscode/tests).
"""

import os
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
EDITORS = ROOT / "editors"
PAGE = ROOT / "docs" / "protocol.md"

# A type with the comment above it, to the blank line that follows.
TYPE = re.compile(
    r"^(?P<comment>/\*\*.*\*/\n)?(?P<export>export )?(?P<text>(?:interface|type) (?P<name>\w+)(?:.+\n)+)",
    re.MULTILINE,
)


def declared(text: str) -> dict[str, str]:
    """Types by their names, as they are written."""
    return {
        found["name"]: (found["comment"] or "") + found["text"]
        for found in TYPE.finditer(text)
    }


def types() -> dict[str, str]:
    files = [EDITORS / "preview/host/protocol.ts", EDITORS / "vscode/src/figures.ts"]
    text = "\n".join(file.read_text(encoding="utf-8") for file in files)
    # The Language Server Protocol has the others.
    return {
        name: text.replace("uri: string;", "uri: DocumentUri;")
        for name, text in declared(text).items()
        if name not in {"Position", "Location"}
    }


def page() -> str:
    known = types()

    def renewed(found: re.Match[str]) -> str:
        return known.get(found["name"], found[0])

    def block(found: re.Match[str]) -> str:
        return found[1] + TYPE.sub(renewed, found[2]) + found[3]

    text = PAGE.read_text(encoding="utf-8")
    return re.sub(r"(```typescript\n)(.*?)(```\n)", block, text, flags=re.DOTALL)


def test_the_page_has_the_types_of_the_editors() -> None:
    renewed = page()
    if os.environ.get("UPDATE_EXPECT"):
        PAGE.write_text(renewed, encoding="utf-8")
    assert PAGE.read_text(encoding="utf-8") == renewed, "run it with UPDATE_EXPECT=1"


@pytest.mark.parametrize("name", types())
def test_every_type_is_on_the_page(name: str) -> None:
    assert name in declared(PAGE.read_text(encoding="utf-8"))
