"""The test command as a program."""

import signal
import subprocess
import sys
from pathlib import Path

import main
from until import until

# The test command with one job, which waits for ever.
SLOW = """
import sys
from pathlib import Path
import jobs, main

jobs.LOGS = Path(sys.argv.pop())
jobs.chosen = lambda *_: [jobs.Job("slow", (f"touch {jobs.LOGS}/begun; sleep 1000",))]
main.main()
"""


def test_an_interrupted_run_says_so(tmp_path: Path) -> None:
    process = subprocess.Popen(
        [sys.executable, "-c", SLOW, str(tmp_path)],
        cwd=Path(main.__file__).parent,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    until("it has begun", (tmp_path / "begun").exists)
    process.send_signal(signal.SIGINT)
    printed, told = process.communicate(timeout=60)
    assert (process.returncode, printed) == (1, "")
    assert told == f"interrupted; the output so far is in {tmp_path}\n"
