"""That every test begins with the same handlers of signals: processes inherit which of them are ignored."""

from __future__ import annotations

import signal
from collections.abc import Iterator

import pytest

NAMES = ("SIGINT", "SIGTERM", "SIGHUP", "SIGQUIT")
SIGNALS = [getattr(signal, name) for name in NAMES if hasattr(signal, name)]

# In the background of a shell SIGINT and SIGQUIT are ignored, with nohup SIGHUP.
signal.signal(signal.SIGINT, signal.default_int_handler)
for name in ("SIGHUP", "SIGQUIT"):
    if hasattr(signal, name):
        signal.signal(getattr(signal, name), signal.SIG_DFL)


@pytest.fixture(autouse=True)
def signals_kept() -> Iterator[None]:
    """Fails a test that leaves them otherwise: what later tests in its process start could not be ended."""
    before = {number: signal.getsignal(number) for number in SIGNALS}
    yield
    changed = [n for n, handler in before.items() if signal.getsignal(n) != handler]
    for number in changed:
        signal.signal(number, before[number])
    assert not changed, "the test must put back how these are handled"
