"""The command line."""

from beltdyn.cli.app import main

__all__ = ["main"]
