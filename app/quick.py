"""Loading sooner: PySide reads the source of every module that is imported, only to look whether it names PySide."""

from __future__ import annotations


def spare_reading() -> None:
    """Answers that question beforehand, a tenth of the time that loading takes; where PySide does not ask so, nothing.

    What is asked decides whether snake_case names may be switched on for a module, which nothing here does.
    """
    import PySide6.QtCore  # noqa: F401 - it brings the support modules
    from shibokensupport import feature

    if hasattr(feature, "_mod_uses_pyside"):
        feature._mod_uses_pyside = lambda module: True
