"""The command line: one file a command, each of which parses, then imports, then calls."""

import sys


def main() -> None:
    """Run the command line; Ctrl-C is quiet even while it is loading."""
    try:
        from .main import main as run

        run()
    except KeyboardInterrupt:
        sys.exit(130)
