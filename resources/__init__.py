"""Files the program ships: theme, icons, plants, examples, help pages."""

from pathlib import Path


def path(name: str) -> Path:
    """Where the shipped file or folder `name` lies (forward slashes, relative to this package)."""
    return Path(__file__).parent / name
