"""What scripts wait for when the simulator does not answer."""

from typing import Any

import pytest
from pydslrep_runtime import patience
from pydslrep_runtime.errors import SimulatorError
from pydslrep_runtime.patience import Patience
from pydslrep_runtime.settings import HOLD_LIMIT, SILENCE_LIMIT

RUNNING = 17


def patient(monkeypatch: pytest.MonkeyPatch, state: Any) -> Patience:
    """Patience with a simulator that is in a state, or silent, or gone."""

    def ask(_address: str, function: str, _limit: float) -> Any:
        assert function == "sim.getSimulationState"
        if isinstance(state, Exception):
            raise state
        return state

    monkeypatch.setattr(patience, "ask", ask)
    return Patience("127.0.0.1:23000")


@pytest.mark.parametrize(
    ("state", "waited", "words"),
    [
        (patience.PAUSED, 1e6, "the simulation is paused"),
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
    waits = patient(monkeypatch, state)
    waits.wait(waited)
    waits.wait(waited)
    err = capsys.readouterr().err
    assert err.startswith("note: ")
    assert err.count(words) == 1


@pytest.mark.parametrize(
    ("state", "waited", "words"),
    [
        (patience.STOPPED, 1.0, "the simulation was stopped"),
        (None, SILENCE_LIMIT + 1.0, "no reply from 127.0.0.1:23000, for 600 s"),
        (RUNNING, HOLD_LIMIT + 1.0, "another client holds the simulation's time"),
    ],
)
def test_does_not_wait_for_ever(
    state: Any, waited: float, words: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    with pytest.raises(SimulatorError, match=words):
        patient(monkeypatch, state).wait(waited)


def test_who_goes_on_after_a_pause_holds_no_time(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    states = iter([None, patience.PAUSED, RUNNING, RUNNING, RUNNING])
    monkeypatch.setattr(patience, "ask", lambda *_: next(states))
    waits = Patience("127.0.0.1:23000")
    waits.wait(2.0)
    waits.wait(HOLD_LIMIT + 5.0)
    waits.wait(HOLD_LIMIT + 7.0)
    assert "another client" not in capsys.readouterr().err
    waits.wait(HOLD_LIMIT + 12.0)
    assert "another client" in capsys.readouterr().err
    with pytest.raises(SimulatorError) as error:
        waits.wait(2.0 * HOLD_LIMIT + 6.0)
    assert str(error.value) == (
        "another client holds the simulation's time: it is in stepping mode and takes no step, for 40 s. End that "
        "program, or stop the simulation and start this script again"
    )


def test_a_pause_excuses_its_own_call_only(monkeypatch: pytest.MonkeyPatch) -> None:
    states = iter([patience.PAUSED, RUNNING, RUNNING])
    monkeypatch.setattr(patience, "ask", lambda *_: next(states))
    waits = Patience("127.0.0.1:23000")
    waits.wait(100.0)
    waits.wait(2.0)
    with pytest.raises(SimulatorError, match="another client"):
        waits.wait(HOLD_LIMIT + 1.0)


def test_a_slow_step_is_no_news(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    patient(monkeypatch, RUNNING).wait(2.0)
    assert capsys.readouterr().err == ""
