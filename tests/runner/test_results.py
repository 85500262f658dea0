"""What the test command reads from the output of each kind of test."""

from __future__ import annotations

import results
from results import Failure, Results


def test_pytest() -> None:
    output = """....F..
=========== short test summary info ===========
FAILED tests/lsp/test_a.py::test_b[x y] - assert 1 == 2
ERROR python/tests/test_c.py::test_d
1 failed, 1740 passed, 2 skipped, 1 error in 95.12s (0:01:35)
"""
    assert results.of_pytest(output) == Results(
        1740,
        2,
        (
            Failure(
                "tests/lsp/test_a.py::test_b[x y]",
                ".venv/bin/pytest 'tests/lsp/test_a.py::test_b[x y]'",
            ),
            Failure(
                "python/tests/test_c.py::test_d",
                ".venv/bin/pytest python/tests/test_c.py::test_d",
            ),
        ),
    )


def test_pytest_in_a_python_of_its_own() -> None:
    output = "FAILED test_a.py::test_b[c] - assert 1 == 2\n1 failed in 0.12s\n"
    found = results.of_pytest(output, command="tests/ros/run.sh")
    assert [each.again for each in found.failures] == [
        "tests/ros/run.sh 'test_a.py::test_b[c]'"
    ]


def test_nextest() -> None:
    report = """<testsuites>
  <testsuite name="pydslrep-analysis"><testcase name="plan::tests::one"/></testsuite>
  <testsuite name="pydslrep-ide::incremental"><testcase name="edits"><failure type="x"/></testcase></testsuite>
  <testsuite name="pydslrep-cli::bin/pydslrep"><testcase name="run::two"><failure/></testcase></testsuite>
</testsuites>"""
    found = results.of_nextest(report)
    assert (found.passed, [one.again for one in found.failures]) == (
        1,
        [
            "cargo test --package pydslrep-ide --test incremental -- --exact edits",
            "cargo test --package pydslrep-cli --bin pydslrep -- --exact run::two",
        ],
    )


def test_cargo_test() -> None:
    output = """test a::b ... ok
test a::c ... FAILED
test result: FAILED. 1 passed; 1 failed; 0 ignored; 0 measured; 0 filtered out
test result: ok. 12 passed; 0 failed; 0 ignored; 0 measured; 0 filtered out
"""
    assert results.of_cargo_test(output) == Results(
        13, 0, (Failure("a::c", "cargo test --workspace a::c"),)
    )


def test_node() -> None:
    output = """\x1b[31m✖ hover shows a pose (12.1ms)\x1b[39m
\N{INFORMATION SOURCE} tests 3
\N{INFORMATION SOURCE} pass 2
\N{INFORMATION SOURCE} fail 1
\N{INFORMATION SOURCE} skipped 0

✖ failing tests:

test at writing.test.mjs:41:1
✖ hover shows a pose (12.1ms)
  AssertionError [ERR_ASSERTION]: no hover
"""
    assert results.of_node_in("tests/editors/run.sh vscode")(output) == Results(
        2,
        0,
        (
            Failure(
                "writing.test.mjs: hover shows a pose",
                "tests/editors/run.sh vscode '--test-name-pattern=^hover\\ shows\\ a\\ pose$' writing.test.mjs",
            ),
        ),
    )


def test_tests_that_build_on_others_run_with_them() -> None:
    output = "test at life.test.mjs:9:1\n✖ it lives (1ms)\n"
    run = "tests/editors/run.sh vscode"
    (failure,) = results.of_node_in(run, in_sessions=True)(output).failures
    assert failure == Failure("life.test.mjs: it lives", f"{run} life.test.mjs")


def test_unit_tests_of_the_extension() -> None:
    output = "test at tests/tasks.test.ts:53:1\n✖ it matches (1.2ms)\n"
    (failure,) = results.of_node(output).failures
    assert failure.again == (
        "npm test --prefix editors/vscode -- '--test-name-pattern=^it\\ matches$'"
    )


def test_neovim_and_typing() -> None:
    neovim = "== folder\nok   it starts\nFAIL the fold: 3\n"
    assert results.of_neovim(neovim) == Results(
        1, 0, (Failure("folder the fold: 3", "tests/editors/run.sh neovim folder"),)
    )
    lint = "    /x/lua/indent.lua:79:121: line is too long (122 > 120)\n"
    assert results.of_neovim(lint + neovim).failures[0] == Failure(
        "lint indent.lua:79: line is too long (122 > 120)",
        "tests/editors/run.sh neovim lint",
    )
    typing = "vscode: ok   table2 at 70 ms\nvscode: FAIL star at 30 ms\nvscode:      line 3\n"
    again = "tests/editors/run.sh typing --patient --editor vscode --programs star --pace 30"
    assert results.of_typing(typing) == Results(
        1, 0, (Failure("vscode: star at 30 ms", again),)
    )


def test_colours_and_other_lines_are_no_results() -> None:
    assert (
        results.of_pytest("collected 3 items\n")
        == results.of_neovim("hello\n")
        == Results()
    )
