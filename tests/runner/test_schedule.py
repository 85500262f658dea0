"""In which order jobs run, and what a failure stops."""

from __future__ import annotations

import shlex
import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import jobs
import pytest
import report
import results
from jobs import Job
from schedule import Commands, Outcome, Schedule, runner
from until import until


def run(root: Path, *chosen: Job) -> list[Outcome]:
    told: list[str] = []
    outcomes = Schedule(
        list(chosen),
        runner(root, root, {"PATH": "/usr/bin:/bin"}),
        lambda outcome: told.append(outcome.job.name),
    ).finish()
    assert told == [outcome.job.name for outcome in outcomes]
    return outcomes


def test_every_command_runs_and_a_failed_check_stops_nothing(tmp_path: Path) -> None:
    outcomes = run(
        tmp_path,
        Job("late", ("touch late",), after=("check",)),
        Job("check", ("false", "touch second")),
    )
    assert [(one.job.name, one.succeeded) for one in outcomes] == [
        ("check", False),
        ("late", True),
    ]
    assert {path.name for path in tmp_path.iterdir()} >= {"second", "late"}


def test_who_needs_several_processors_is_not_overtaken(tmp_path: Path) -> None:
    light = [Job(f"light{n}", (f"echo {n} >>order",)) for n in range(9)]
    heavy = Job("heavy", ("echo heavy >>order",), processors=99)
    run(tmp_path, light[0], heavy, *light[1:])
    assert (tmp_path / "order").read_text().split()[:2] == ["0", "heavy"]


def test_what_cannot_be_prepared_is_named(tmp_path: Path) -> None:
    outcomes = run(
        tmp_path,
        Job("build", ("exit 3",), prepares=True),
        Job("test", ("touch ran",), after=("build",)),
    )
    assert outcomes[1].missing == "build"
    assert not (tmp_path / "ran").exists()
    assert "not run: test, because build failed" in report.end(outcomes, 1.0, tmp_path)


def test_an_editor_tries_once_more_and_says_so(tmp_path: Path) -> None:
    def read(output: str) -> results.Results:
        failure = results.Failure("folds", "test -e once || ! touch once")
        return results.Results(4, 0, (failure,) if "FAIL" in output else ())

    job = Job("neovim", ("echo FAIL folds; touch once; false",), read=read, editor=True)
    (outcome,) = run(tmp_path, job)
    assert (outcome.succeeded, outcome.results.passed) == (True, 5)
    assert "retried: neovim: folds" in report.end([outcome], 1.0, tmp_path)
    # Without an editor there is no second chance.
    (outcome,) = run(tmp_path, Job("rust", job.commands, read=read))
    assert not outcome.succeeded
    assert "FAILED: rust: folds\n    test -e once" in report.end(
        [outcome], 1.0, tmp_path
    )


@pytest.mark.parametrize(
    ("output", "why"),
    [
        (
            "✖ folds (9 ms)\nscreenshot: folds.png\n✖ folds (9 ms)\n  Error: late\n",
            "Error: late",
        ),
        ("FAIL folds: { 1 }\nok   opens\n", "FAIL folds: { 1 }"),
        ("vscode: FAIL folds at 30 ms\nvscode:      line 3\n", "vscode:      line 3"),
        ("✔ folds\n", "see the output"),
    ],
)
def test_the_reason_is_not_a_line_about_another_test(
    tmp_path: Path, output: str, why: str
) -> None:
    job = Job("editor", (f"printf %s {shlex.quote(output)}",))
    (outcome,) = run(tmp_path, job)
    assert report.reason(outcome, "a.test.mjs: folds") == why


def test_everything_that_a_job_needs_exists() -> None:
    names = [job.name for job in jobs.every()]
    assert len(set(names)) == len(names)
    assert all(set(job.after) <= set(names) for job in jobs.every())
    # `run.sh documentation` prepares the editors, and does not check everything that comes before in a full run.
    alone = jobs.chosen(["documentation"], editors=False, long=False)
    assert [job.name for job in alone] == ["tools", "build", "editors", "documentation"]


def test_the_check_for_a_browser_runs_where_no_build_for_one_does() -> None:
    def names(*named: str, editors: bool = False, long: bool = False) -> set[str]:
        return {job.name for job in jobs.chosen([*named], editors, long)}

    assert "wasm" in names("wasm") & names(long=True)
    assert "web-build" in names(editors=True)
    assert "wasm" not in names() | names(editors=True, long=True)


def test_parts_that_run_together_share_one_build_of_the_playground() -> None:
    for name in ("playground", "typing"):
        alone = {job.name for job in jobs.chosen([name], editors=False, long=False)}
        assert "playground-build" in alone
    builds = [
        job.name for job in jobs.every() if "playground build" in " ".join(job.commands)
    ]
    assert builds == ["playground-build"]


def test_what_hangs_is_ended_with_its_processes_and_named(tmp_path: Path) -> None:
    hang = Job("hang", ("sleep 1000 & echo $! >pid; wait",))
    outcome = runner(tmp_path, tmp_path, {"PATH": "/usr/bin:/bin"}, limit=0.3)(hang)
    assert not outcome.succeeded
    assert "it hangs" in report.end([outcome], 1.0, tmp_path)
    child = Path("/proc", (tmp_path / "pid").read_text().strip(), "stat")
    until(
        "its processes are gone",
        lambda: not child.exists() or " Z " in child.read_text(),
    )


def test_an_interrupt_ends_what_runs_and_what_follows(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Commands, "interrupted", False)
    job = Job("slow", ("touch begun; sleep 1000", "touch next"))
    with ThreadPoolExecutor() as pool:
        outcome = pool.submit(
            runner(tmp_path, tmp_path, {"PATH": "/usr/bin:/bin"}), job
        )
        until("it has begun", (tmp_path / "begun").exists)
        Commands.interrupt()
        assert not outcome.result().succeeded
    assert not (tmp_path / "next").exists()


def test_what_begins_during_an_interrupt_is_ended(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Commands, "interrupted", False)
    start = subprocess.Popen

    def interrupted(*arguments: Any, **options: Any) -> subprocess.Popen[bytes]:
        process = start(*arguments, **options)
        Commands.interrupt()
        return process

    monkeypatch.setattr(subprocess, "Popen", interrupted)
    job = Job("slow", ("sleep 1000",))
    assert not runner(tmp_path, tmp_path, {"PATH": "/usr/bin:/bin"})(job).succeeded


def test_an_interrupt_at_any_point_ends_what_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Commands, "interrupted", False)

    def interrupt(_: Outcome) -> None:
        Commands.interrupt()

    quick, slow = Job("quick", ("true",)), Job("slow", ("sleep 1000",))
    after = Job("after", ("touch after",), after=("quick",))
    schedule = Schedule(
        [slow, quick, after],
        runner(tmp_path, tmp_path, {"PATH": "/usr/bin:/bin"}),
        interrupt,
    )
    with pytest.raises(KeyboardInterrupt):
        schedule.finish()
    assert not (tmp_path / "after").exists()


def test_an_error_ends_what_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Commands, "interrupted", False)

    def fail(_: Outcome) -> None:
        raise BrokenPipeError

    quick, slow = Job("quick", ("true",)), Job("slow", ("sleep 1000",))
    schedule = Schedule(
        [slow, quick], runner(tmp_path, tmp_path, {"PATH": "/usr/bin:/bin"}), fail
    )
    with pytest.raises(BrokenPipeError):
        schedule.finish()


def test_processor_time_is_told(tmp_path: Path) -> None:
    spin = Job("spin", ("for ((n = 0; n < 200000; n++)); do :; done",))
    (outcome,) = run(tmp_path, spin)
    assert outcome.processor_seconds > 0
    assert report.line(outcome).endswith("s busy")
