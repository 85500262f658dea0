"""What contributors are promised: hooks, hosted checks, templates, and links that lead somewhere."""

import re
import subprocess
import sys
import tomllib
from pathlib import Path

import jobs
import pytest
from commit_subject import complaints

ROOT = Path(__file__).resolve().parents[2]
HOOKS = ROOT / ".pre-commit-config.yaml"
PRE_COMMIT = [sys.executable, "-m", "pre_commit"]
PAGES = [
    ROOT / "CONTRIBUTING.md",
    ROOT / "SECURITY.md",
    *sorted((ROOT / ".github").rglob("*.md")),
]


def toolchain() -> dict[str, object]:
    file = ROOT / "rust-toolchain.toml"
    found: dict[str, object] = tomllib.loads(file.read_text(encoding="utf-8"))[
        "toolchain"
    ]
    return found


def test_the_toolchain_has_what_the_checks_need() -> None:
    assert toolchain()["components"] == ["rustfmt", "clippy"]
    assert toolchain()["targets"] == ["wasm32-unknown-unknown"]
    manifest = tomllib.loads((ROOT / "Cargo.toml").read_text(encoding="utf-8"))
    oldest = manifest["workspace"]["package"]["rust-version"].split(".")
    assert [*map(int, oldest)] <= [*map(int, str(toolchain()["channel"]).split("."))]


def workflow(name: str) -> str:
    return (ROOT / ".github" / "workflows" / f"{name}.yml").read_text(encoding="utf-8")


def test_hosted_checks_run_every_part_of_the_test_command() -> None:
    text = workflow("ci")
    parts = [
        name
        for line in re.findall(r"^          - ([a-z ]+)$", text, re.MULTILINE)
        for name in line.split()
    ]
    every = {job.name for job in [*jobs.checks(), *jobs.in_editors()]}
    # It has a job of its own, because only there can the tool look up vulnerabilities.
    assert sorted(parts) == sorted(every - {"deny"})
    images = re.findall(r"container: (rust:.*)", text)
    assert set(images) == {f"rust:{toolchain()['channel']}-trixie"}


def test_a_release_is_what_its_script_builds() -> None:
    text = workflow("release")
    build, publish = re.findall(r"\brun: *(.*)", text)
    assert build == ".ci/dist.sh"
    assert publish.startswith("gh release create ")
    assert 'tags: ["v*"]' in text


def test_hosted_actions_are_pinned_and_may_do_little() -> None:
    for path in (ROOT / ".github" / "workflows").iterdir():
        text = path.read_text(encoding="utf-8")
        for action in re.findall(r"\buses: *(.*)", text):
            assert re.fullmatch(r"actions/[\w-]+@[0-9a-f]{40} # v[\d.]+", action), (
                action
            )
        assert "\npermissions:\n  contents: read\n" in text


def test_workflows_are_in_the_form_of_github() -> None:
    form = ["--builtin-schema", "vendor.github-workflows"]
    files = sorted((ROOT / ".github" / "workflows").iterdir())
    subprocess.run(
        [sys.executable, "-m", "check_jsonschema", *form, *files], check=True
    )


def test_hooks_are_local_and_complete() -> None:
    subprocess.run([*PRE_COMMIT, "validate-config", HOOKS], check=True)
    text = HOOKS.read_text(encoding="utf-8")
    assert set(re.findall(r"\brepo: *(.*)", text)) == {"local"}
    assert set(re.findall(r"\blanguage: *(.*)", text)) == {"system"}
    assert re.findall(r"\bid: *(.*)", text) == [
        "rustfmt",
        "clippy",
        "ruff",
        "ruff-format",
        "mypy",
        "eslint",
        "commit-subject",
    ]


@pytest.mark.parametrize(
    ("message", "is_right"),
    [
        ("server: answer in order\n\nA client waits for the first.\n", True),
        ("syntax, analysis: call types what they are\n# a comment of git\n", True),
        (f"server: {'x' * 64}", True),
        ('Revert "server: answer in order"', True),
        (f"server: {'x' * 65}", False),
        ("Answer in order", False),
        ("server: answer in order.", False),
        ("server: answer in order\nA client waits for the first.", False),
        ("", False),
    ],
)
def test_a_subject_names_its_area_and_fits_a_line(message: str, is_right: bool) -> None:
    assert (complaints(message) == []) is is_right


@pytest.mark.parametrize(
    ("subject", "code"), [("server: answer in order", 0), ("Answer in order", 1)]
)
def test_the_hook_reads_the_message(tmp_path: Path, subject: str, code: int) -> None:
    """The entry of the hook, run as pre-commit runs it."""
    [entry] = re.findall(r"entry: (.*commit_subject.*)", HOOKS.read_text("utf-8"))
    message = tmp_path / "COMMIT_EDITMSG"
    message.write_text(f"{subject}\n", encoding="utf-8")
    _, script = entry.split()
    done = subprocess.run([sys.executable, script, message], cwd=ROOT, check=False)
    assert done.returncode == code


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_and_paths_lead_somewhere(page: Path) -> None:
    text = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.DOTALL)
    for link in re.findall(r"\]\(([^)#]+)", text):
        assert (page.parent / link).exists(), link
    for path in re.findall(r"`((?:\.?[\w-]+/)+[\w.*-]*)`", text):
        # What builds and tests write exists only after them.
        is_made = path.startswith("target/")
        assert is_made or [*ROOT.glob(path.removesuffix("/"))], path


def test_no_page_invents_an_address() -> None:
    for page in PAGES:
        assert not re.search(
            r"https?://|\b\S+@\S+\.\w", page.read_text(encoding="utf-8")
        )
