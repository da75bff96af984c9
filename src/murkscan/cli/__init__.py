"""The command line: one file a command, each of which parses, then imports, then calls."""

from .main import main as main
