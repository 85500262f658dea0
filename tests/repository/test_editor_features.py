"""The page of editor features is generated from the source files of the features: `UPDATE_EXPECT=1` writes it."""

import os
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FEATURES = ROOT / "crates" / "ide" / "src"
PAGE = ROOT / "docs" / "editor-features.md"

# Modules that are not features.
PARTS = {"cursor", "fixture", "keyword_pages", "statements", "unsettled", "users"}

# The file of each feature, and its messages.
GROUPS: dict[str, dict[str, list[str]]] = {
    "While typing": {
        "completion": ["textDocument/completion"],
        "signature": ["textDocument/signatureHelp"],
        "on_type": ["textDocument/onTypeFormatting"],
        "linked_editing": ["textDocument/linkedEditingRange"],
        "quick_fixes": ["textDocument/codeAction"],
        "fix_all": ["textDocument/codeAction"],
        "refactorings": ["textDocument/codeAction"],
        "toml": [
            "textDocument/publishDiagnostics",
            "textDocument/completion",
            "textDocument/hover",
            "textDocument/codeAction",
            "textDocument/documentSymbol",
            "textDocument/definition",
            "textDocument/references",
            "textDocument/documentHighlight",
            "textDocument/rename",
        ],
    },
    "Reading": {
        "hover": ["textDocument/hover"],
        "inlay_hints": ["textDocument/inlayHint"],
        "code_lenses": ["textDocument/codeLens", "codeLens/resolve"],
        "semantic_tokens": [
            "textDocument/semanticTokens/full",
            "textDocument/semanticTokens/full/delta",
            "textDocument/semanticTokens/range",
        ],
        "symbols": ["textDocument/documentSymbol"],
        "folding": ["textDocument/foldingRange"],
        "selection": ["textDocument/selectionRange"],
        "planned_path": ["pydslrep/plannedPath", "pydslrep/plannedPathChanged"],
        "planned_action": ["pydslrep/plannedAt", "pydslrep/actionLocation"],
    },
    "Navigation": {
        "definition": ["textDocument/definition", "textDocument/declaration"],
        "type_definition": ["textDocument/typeDefinition"],
        "references": ["textDocument/references"],
        "highlights": ["textDocument/documentHighlight"],
        "workspace_symbols": ["workspace/symbol"],
        "call_hierarchy": [
            "textDocument/prepareCallHierarchy",
            "callHierarchy/incomingCalls",
            "callHierarchy/outgoingCalls",
        ],
        "document_links": ["textDocument/documentLink"],
    },
    "Editing": {
        "rename": ["textDocument/prepareRename", "textDocument/rename"],
        "file_rename": ["workspace/willRenameFiles"],
        "formatting": ["textDocument/formatting", "textDocument/rangeFormatting"],
    },
}

TOP = """\
# Editor features

The features of the language server, with the messages of the Language Server Protocol that they use. In addition, errors
appear as you type, each with a page in [diagnostics](diagnostics/README.md), and *Generate script* is a code action in
every program. Commands run and preview programs, and build and check their scenes in CoppeliaSim;
[protocol.md](protocol.md) lists them and the extensions of the protocol.
"""


def first_paragraph(feature: str) -> tuple[str, str]:
    """The name and description of a feature."""
    file = FEATURES / f"{feature}.rs"
    if not file.exists():
        file = FEATURES / feature / "mod.rs"
    lines = []
    for line in file.read_text(encoding="utf-8").splitlines():
        text = line.removeprefix("//!").strip()
        if not line.startswith("//!") or not text:
            break
        lines.append(text)
    name, colon, meaning = " ".join(lines).partition(": ")
    assert colon, f"{file.name} begins with the feature's name and a colon"
    assert "](" not in meaning, f"{file.name}: a link does not lead anywhere there"
    return name, meaning[0].upper() + meaning[1:]


def page() -> str:
    parts = [TOP]
    for group, features in GROUPS.items():
        parts.append(
            f"\n## {group}\n\n| feature | description | messages |\n|---|---|---|\n"
        )
        for feature, methods in features.items():
            name, meaning = first_paragraph(feature)
            messages = ", ".join(f"`{method}`" for method in methods)
            cell = meaning.replace("|", "\\|")
            parts.append(f"| {name} | {cell} | {messages} |\n")
    return "".join(parts)


def test_the_page_is_up_to_date() -> None:
    if os.environ.get("UPDATE_EXPECT"):
        PAGE.write_text(page(), encoding="utf-8")
    assert PAGE.read_text(encoding="utf-8") == page(), "run it with UPDATE_EXPECT=1"


def test_every_feature_is_on_the_page() -> None:
    listed = [feature for features in GROUPS.values() for feature in features]
    modules = re.findall(
        r"^mod (\w+);", (FEATURES / "lib.rs").read_text(encoding="utf-8"), re.MULTILINE
    )
    assert sorted(listed) == sorted(set(modules) - PARTS)
