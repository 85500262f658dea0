"""What scripts wait for when the simulator does not answer."""

from typing import Any

import pytest
from pydslrep_runtime import wait_policy
from pydslrep_runtime.errors import SimulatorError
from pydslrep_runtime.settings import HOLD_LIMIT, SILENCE_LIMIT
from pydslrep_runtime.wait_policy import WaitPolicy

RUNNING = 17


def policy_for(monkeypatch: pytest.MonkeyPatch, state: Any) -> WaitPolicy:
    """The policy for a simulator that is in a state, silent or gone."""

    def ask(_address: str, function: str, _limit: float) -> Any:
        assert function == "sim.getSimulationState"
        if isinstance(state, Exception):
            raise state
        return state

    monkeypatch.setattr(wait_policy, "ask", ask)
    return WaitPolicy("127.0.0.1:23000")


@pytest.mark.parametrize(
    ("state", "waited", "words"),
    [
        (wait_policy.PAUSED, 1e6, "the simulation is paused"),
        (None, SILENCE_LIMIT - 1.0, "does not answer: the simulation may be paused"),
        (SimulatorError("gone"), 3.0, "does not answer"),
        (RUNNING, HOLD_LIMIT - 1.0, "another client holds the simulation's time"),
    ],
)
def test_says_once_what_it_waits_for(
    state: Any,
    waited: float,
    words: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    policy = policy_for(monkeypatch, state)
    policy.wait(waited)
    policy.wait(waited)
    err = capsys.readouterr().err
    assert err.startswith("note: ")
    assert err.count(words) == 1


@pytest.mark.parametrize(
    ("state", "waited", "words"),
    [
        (wait_policy.STOPPED, 1.0, "the simulation was stopped"),
        (None, SILENCE_LIMIT + 1.0, "no reply from 127.0.0.1:23000, for 600 s"),
        (RUNNING, HOLD_LIMIT + 1.0, "another client holds the simulation's time"),
    ],
)
def test_does_not_wait_for_ever(
    state: Any, waited: float, words: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    with pytest.raises(SimulatorError, match=words):
        policy_for(monkeypatch, state).wait(waited)


def test_who_goes_on_after_a_pause_holds_no_time(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    states = iter([None, wait_policy.PAUSED, RUNNING, RUNNING, RUNNING])
    monkeypatch.setattr(wait_policy, "ask", lambda *_: next(states))
    policy = WaitPolicy("127.0.0.1:23000")
    policy.wait(2.0)
    policy.wait(HOLD_LIMIT + 5.0)
    policy.wait(HOLD_LIMIT + 7.0)
    assert "another client" not in capsys.readouterr().err
    policy.wait(HOLD_LIMIT + 12.0)
    assert "another client" in capsys.readouterr().err
    with pytest.raises(SimulatorError) as error:
        policy.wait(2.0 * HOLD_LIMIT + 6.0)
    assert str(error.value) == (
        "another client holds the simulation's time: it is in stepping mode and takes no step, for 40 s. End that "
        "program, or stop the simulation and start this script again"
    )


def test_a_pause_excuses_its_own_call_only(monkeypatch: pytest.MonkeyPatch) -> None:
    states = iter([wait_policy.PAUSED, RUNNING, RUNNING])
    monkeypatch.setattr(wait_policy, "ask", lambda *_: next(states))
    policy = WaitPolicy("127.0.0.1:23000")
    policy.wait(100.0)
    policy.wait(2.0)
    with pytest.raises(SimulatorError, match="another client"):
        policy.wait(HOLD_LIMIT + 1.0)


def test_a_slow_step_is_no_news(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    policy_for(monkeypatch, RUNNING).wait(2.0)
    assert capsys.readouterr().err == ""
