"""The machine-readable formats of `check`, against their specifications."""

from __future__ import annotations

import json
import pathlib
import subprocess
from typing import Any

import jsonschema  # type: ignore[import-untyped]
import pytest

ROOT = pathlib.Path(__file__).parents[2]

PROGRAMS = {
    "lib/wheels.pyr": "wheel a with radius 4\nwheel a with radius 500\n",
    "a b#1.pyr": """import "lib/wheels.pyr"
/* 机器人 🤖 */ sensor s sensor s
robot type tw r with port 70000 has { a, aa } wheels with sensors { s, s }
movement m of r { move 0 meters turn left until { s } slam }
environment yard has { r } robots with { m m } moves ;
""",
    "clean.pyr": "",
    "yard.scene.toml": "[wrold]\nseed = 2\n",
}


def checked(command: str, folder: pathlib.Path, form: str) -> str:
    for name, text in PROGRAMS.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")
    done = subprocess.run(
        [command, "check", "--format", form],
        cwd=folder,
        capture_output=True,
        encoding="utf-8",
        check=False,
    )
    assert (done.returncode, done.stderr) == (1, "")
    return done.stdout


def test_sarif_is_what_the_standard_says(command: str, tmp_path: pathlib.Path) -> None:
    log = json.loads(checked(command, tmp_path, "sarif"))
    schema = pathlib.Path(__file__).with_name("sarif-2.1.0.schema.json")
    validator = jsonschema.Draft7Validator(
        json.loads(schema.read_text(encoding="utf-8"))
    )
    assert [error.message for error in validator.iter_errors(log)] == []
    [run] = log["runs"]
    assert run["columnKind"] == "unicodeCodePoints"
    rules = run["tool"]["driver"]["rules"]
    in_programs = [result for result in run["results"] if "ruleIndex" in result]
    assert len(in_programs) == len(run["results"]) - 1, "the scene has no rule"
    for result in in_programs:
        assert rules[result["ruleIndex"]]["id"] == result["ruleId"]
    assert all(rule["help"]["markdown"].startswith("# ") for rule in rules)

    # The schema must reject something, or the test above proves nothing.
    run["results"][0]["level"] = "hint"
    del run["tool"]["driver"]["name"]
    assert len(list(validator.iter_errors(log))) >= 2


def sliced(text: str, region: dict[str, int]) -> str:
    """The text of a region: from a character to before another one, both from 1, as the standard defines."""
    lines = text.split("\n")
    assert region["startLine"] == region["endLine"]
    line = lines[region["startLine"] - 1]
    return line[region["startColumn"] - 1 : region["endColumn"] - 1]


def test_sarif_places_and_fixes_lead_into_the_files(
    command: str, tmp_path: pathlib.Path
) -> None:
    results = json.loads(checked(command, tmp_path, "sarif"))["runs"][0]["results"]
    by_rule = {result["ruleId"]: result for result in results}
    main = PROGRAMS["a b#1.pyr"]

    duplicate = by_rule["repeated-sensor"]
    place = duplicate["locations"][0]["physicalLocation"]
    assert place["artifactLocation"]["uri"] == "a%20b%231.pyr"
    assert sliced(main, place["region"]) == "s"

    type_place = by_rule["misplaced-type"]["locations"][0]["physicalLocation"]
    assert sliced(main, type_place["region"]) == "type tw"

    again = next(
        result
        for result in results
        if result["ruleId"] == "duplicate-name"
        and sliced(main, result["locations"][0]["physicalLocation"]["region"]) == "s"
    )
    [first] = again["relatedLocations"]
    assert sliced(main, first["physicalLocation"]["region"]) == "s"
    [change] = again["fixes"][0]["artifactChanges"]
    assert change["artifactLocation"]["uri"] == "a%20b%231.pyr"
    [replacement] = change["replacements"]
    assert sliced(main, replacement["deletedRegion"]) == "s"
    assert replacement["insertedContent"] == {"text": "s_2"}

    levels = {result["ruleId"]: result["level"] for result in results}
    assert levels["invalid-port"] == "error"
    assert levels["zero-distance"] == "warning"
    files = {
        result["locations"][0]["physicalLocation"]["artifactLocation"]["uri"]
        for result in results
    }
    assert files == {"a%20b%231.pyr", "lib/wheels.pyr", "yard.scene.toml"}


RANGE = {
    "type": "object",
    "additionalProperties": False,
    "required": ["start", "end"],
    "properties": {
        side: {
            "type": "object",
            "additionalProperties": False,
            "required": ["line", "column"],
            "properties": {
                "line": {"type": "integer", "minimum": 1},
                "column": {"type": "integer", "minimum": 1},
            },
        }
        for side in ("start", "end")
    },
}


def exactly(**properties: Any) -> dict[str, Any]:
    return {
        "type": "object",
        "additionalProperties": False,
        "required": list(properties),
        "properties": properties,
    }


TEXT = {"type": "string"}
EDIT = exactly(range=RANGE, text=TEXT)
PROBLEM = exactly(
    file=TEXT,
    code={"pattern": "^[a-z-]+$"},
    severity={"enum": ["error", "warning", "information", "hint"]},
    message=TEXT,
    range=RANGE,
    related={
        "type": "array",
        "items": exactly(message=TEXT, file=TEXT, range=RANGE),
    },
    fix={
        "oneOf": [
            {"type": "null"},
            exactly(title=TEXT, edits={"type": "array", "items": EDIT}),
        ]
    },
)


def test_json_has_its_shape(command: str, tmp_path: pathlib.Path) -> None:
    problems = json.loads(checked(command, tmp_path, "json"))
    jsonschema.Draft7Validator({"type": "array", "items": PROBLEM}).validate(problems)
    files = {problem["file"] for problem in problems}
    assert files == {"a b#1.pyr", "lib/wheels.pyr", "yard.scene.toml"}
    assert any(problem["related"] for problem in problems)
    assert any(problem["fix"] for problem in problems)


def test_all_formats_tell_the_same(command: str, tmp_path: pathlib.Path) -> None:
    problems = json.loads(checked(command, tmp_path, "json"))
    results = json.loads(checked(command, tmp_path, "sarif"))["runs"][0]["results"]
    lines = checked(command, tmp_path, "github").splitlines()
    assert [problem["code"] for problem in problems] == [
        result["ruleId"] for result in results
    ]
    assert len(lines) == len(problems)
    for problem, line in zip(problems, lines, strict=True):
        start = problem["range"]["start"]
        assert f",line={start['line']},col={start['column']}," in line
        assert f",title={problem['code']}::" in line


@pytest.mark.parametrize(
    ("settings", "problem"),
    [
        ({"target": "coppeliasim", "severity": {"wheel-count": "off"}}, None),
        ({"inlay-hints": {"pose": False}, "default-speed": 3}, None),
        ({"sevrity": {}}, "sevrity"),
        ({"severity": {"wheel-count": "warn"}}, "warn"),
        ({"default-speed": 0}, "0"),
    ],
)
def test_the_published_schema_of_settings_knows_good_from_bad(
    settings: dict[str, Any], problem: str | None
) -> None:
    path = ROOT / "editors" / "pydslrep.schema.json"
    schema = json.loads(path.read_text(encoding="utf-8"))
    jsonschema.Draft7Validator.check_schema(schema)
    messages = [
        error.message
        for error in jsonschema.Draft7Validator(schema).iter_errors(settings)
    ]
    assert len(messages) == (0 if problem is None else 1)
    assert problem is None or problem in messages[0]
