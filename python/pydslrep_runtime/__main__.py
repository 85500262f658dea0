"""`python -m pydslrep_runtime --version`."""

import argparse

from .version import __version__


def main() -> None:
    """Prints the version; scripts import the rest."""
    parser = argparse.ArgumentParser(
        prog="python -m pydslrep_runtime",
        description="The runtime of scripts that PyDSLRep generates: run the scripts, not this.",
    )
    parser.add_argument(
        "--version", action="version", version=f"pydslrep_runtime {__version__}"
    )
    parser.parse_args()
    parser.print_help()


if __name__ == "__main__":
    main()
