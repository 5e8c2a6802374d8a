"""Version and licence, and the one sentence that everybody should have read."""

from __future__ import annotations

from widgets.connect.welcome import DANGER


def version() -> str:
    """Of this studio, as it is installed."""
    from importlib import metadata  # takes a while to load

    try:
        return metadata.version("twoletter-studio")
    except metadata.PackageNotFoundError:
        return "not installed"


def about_words() -> str:
    """The text of Help > About."""
    return (
        f"Version {version()}. MIT licence.\n\n"
        f"Programs, jogs and tunes one to four axes with controllers that speak two-letter code.\n\n{DANGER}"
    )
