"""docs/run-events.md has the events of editors/run-events.schema.json: `UPDATE_EXPECT=1` writes its table anew."""

import json
import os
import re
from pathlib import Path
from typing import Any

import jsonschema  # type: ignore[import-untyped]
import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "run-events.md"
SCHEMA = json.loads(
    (ROOT / "editors" / "run-events.schema.json").read_text(encoding="utf-8")
)
DEFINITIONS: dict[str, dict[str, Any]] = SCHEMA["$defs"]
EVENTS = [kind["$ref"].rpartition("/")[2] for kind in SCHEMA["oneOf"]]
TABLE = re.compile(
    r"(<!-- made from run-events\.schema\.json .*-->\n).*?(<!-- end -->)", re.DOTALL
)


def field(name: str, description: dict[str, Any], required: list[str]) -> str:
    kind = description.get("type")
    may_be_null = isinstance(kind, list) and "null" in kind
    return f"`{name}`{'?' if may_be_null else ''}{'' if name in required else '*'}"


def table() -> str:
    lines = ["| event | what happened | fields |", "|---|---|---|"]
    for event in EVENTS:
        definition = DEFINITIONS[event]
        fields = [
            field(name, description, definition["required"])
            for name, description in definition["properties"].items()
            if name != "event"
        ]
        lines.append(
            f"| `{event}` | {definition['description']} | {', '.join(fields)} |"
        )
    return "\n".join(lines)


def test_the_page_has_every_event() -> None:
    text = PAGE.read_text(encoding="utf-8")
    renewed = TABLE.sub(lambda found: f"{found[1]}\n{table()}\n\n{found[2]}", text)
    assert table() in renewed, "the page has no place for the table"
    if os.environ.get("UPDATE_EXPECT"):
        PAGE.write_text(renewed, encoding="utf-8")
    assert PAGE.read_text(encoding="utf-8") == renewed, "run it with UPDATE_EXPECT=1"


def test_the_page_explains_every_class_of_failures() -> None:
    _, _, failures = PAGE.read_text(encoding="utf-8").partition("## Failures\n")
    classes = DEFINITIONS["failed"]["properties"]["class"]["enum"]
    assert re.findall(r"^\| `([\w-]+)` \|", failures, re.MULTILINE) == classes


@pytest.mark.parametrize("event", EVENTS)
def test_examples_fit_the_schema(event: str) -> None:
    definition = DEFINITIONS[event]
    properties = [*definition["properties"]]
    assert definition["required"] == [
        name for name in properties if name in definition["required"]
    ]
    first, *_ = definition["examples"]
    assert [*first] == properties, "the first one has everything"
    for example in definition["examples"]:
        jsonschema.validate(example, SCHEMA)
        assert [*example] == [name for name in properties if name in example]


def test_the_lines_of_the_page_fit_the_schema() -> None:
    lines = re.findall(
        r"^\{.*\}$", PAGE.read_text(encoding="utf-8"), flags=re.MULTILINE
    )
    assert len(lines) > 3
    for line in lines:
        event = json.loads(line)
        jsonschema.validate(event, SCHEMA)
        properties = DEFINITIONS[event["event"]]["properties"]
        assert [*event] == [name for name in properties if name in event]
