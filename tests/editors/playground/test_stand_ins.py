"""The playground's stand-in for cbor2 against cbor2 itself, for what the remote API exchanges."""

import importlib.util
import math
from pathlib import Path
from types import ModuleType
from typing import Any

import cbor2
import coppeliasim_zmqremoteapi_client  # type: ignore[import-untyped]
import pytest

ROOT = Path(__file__).resolve().parents[3]

VALUES = [
    None,
    True,
    False,
    *(
        sign * 2**bits + step
        for bits in (0, 5, 8, 16, 32, 63)
        for sign in (-1, 1)
        for step in (-1, 0)
    ),
    0.1,
    -0.0,
    math.inf,
    1e300,
    "",
    "wheel ü",
    "x" * 300,
    b"\x00\xff",
    [],
    list(range(30)),
    {"func": "sim.step", "args": [1, 2.5, [True, None]], "argsL": 3},
]


@pytest.fixture(scope="module")
def stand_in() -> ModuleType:
    file = ROOT / "editors/playground/src/run/python/cbor2.py"
    spec = importlib.util.spec_from_file_location("stand_in_cbor2", file)
    assert spec
    assert spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("value", VALUES, ids=repr)
def test_values_are_written_and_read_as_by_cbor2(
    stand_in: ModuleType, value: Any
) -> None:
    assert cbor2.loads(stand_in.dumps(value)) == value
    assert stand_in.loads(cbor2.dumps(value)) == value


def test_short_floats_and_lists_without_a_length_are_read(stand_in: ModuleType) -> None:
    assert stand_in.loads(bytes.fromhex("f93e00")) == 1.5
    assert stand_in.loads(bytes.fromhex("fa3fc00000")) == 1.5
    assert stand_in.loads(bytes.fromhex("9f0102ff")) == [1, 2]


class Wire:
    """A socket that keeps what is sent."""

    def __init__(self) -> None:
        self.sent: list[Any] = []

    def send(self, message: bytes) -> None:
        """Keeps a message."""
        self.sent.append(cbor2.loads(message))


def test_the_client_sends_what_the_real_one_sends() -> None:
    # The runtime sends the requests of the client itself.
    def sent_by(client: type) -> list[Any]:
        wire, found = Wire(), object.__new__(client)
        vars(found).update(
            socket=wire, uuid="u", timeout=9.0, verbose=0, sendCnt=0, VERSION=2
        )
        vars(found).update(callbackFuncs={}, context=None, _is_known=False)
        for arguments in (["sim"], [1, 2.5]):
            found._send({"func": "sim.echo", "args": list(arguments)})
        vars(found)["socket"] = vars(found)["context"] = Ended()
        return wire.sent

    file = ROOT / "editors/playground/src/run/python/coppeliasim_zmqremoteapi_client.py"
    spec = importlib.util.spec_from_file_location("stand_in_client", file)
    assert spec
    assert spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    assert sent_by(module.RemoteAPIClient) == sent_by(
        coppeliasim_zmqremoteapi_client.RemoteAPIClient
    )


class Ended:
    """What the real client closes when it is deleted."""

    def close(self) -> None:
        """Closes nothing."""

    def term(self) -> None:
        """Ends nothing."""


@pytest.mark.parametrize("message", [b"", b"\x19\x01", b"\x63ab", b"\x9f\x01"])
def test_incomplete_messages_are_refused(stand_in: ModuleType, message: bytes) -> None:
    with pytest.raises(ValueError, match="incomplete"):
        stand_in.loads(message)
