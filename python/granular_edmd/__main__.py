"""The program `granular-edmd`, also as `python -m granular_edmd`."""

import signal
import sys

from ._granular_edmd import run_program


def main() -> int:
    """Runs the program with the arguments of the process, and returns its exit code."""
    # The program handles Ctrl-C itself where it has work to save, and ends elsewhere.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return run_program(["granular-edmd", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
