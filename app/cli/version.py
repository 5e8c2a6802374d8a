"""The version of the program."""

from __future__ import annotations

from importlib.metadata import PackageNotFoundError
from importlib.metadata import version as installed_version


def version() -> str:
    """As installed; a bare source tree has none."""
    try:
        return installed_version("twoletter-studio")
    except PackageNotFoundError:
        return "unknown (not installed)"
