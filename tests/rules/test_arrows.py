"""Imports point one way: resources and codegen, then device, widgets, app."""

from __future__ import annotations

import ast
import sys

import pytest

from tests.conftest import WINDOWS
from tests.rules.sources import PACKAGES, ROOT, imported, package_of, python_files, relative, syntax

STANDARD = frozenset(sys.stdlib_module_names)
THREADS = frozenset({"threading", "_thread", "multiprocessing", "concurrent", "asyncio", "queue"})
OUTSIDE = frozenset({"socket", "socketserver", "ssl", "select", "selectors", "subprocess", "http", "urllib", "time"})
MAY = {
    "resources": (STANDARD, THREADS | OUTSIDE, ("resources",)),
    "codegen": (STANDARD, THREADS | OUTSIDE, ("codegen", "resources")),
    "device": (
        STANDARD | {"numpy", "serial", "numba", "pygame", "platformdirs"},
        frozenset(),
        ("device", "codegen", "resources"),
    ),
    "widgets": (
        STANDARD | {"PySide6", "pyqtgraph", "numpy", "shiboken6"},
        THREADS,
        (
            *("widgets", "codegen", "resources", "device.api", "device.capture", "device.curves", "device.jog"),
            *("device.bits", "device.live", "device.roll", "device.waves", "device.terminal1500"),
            *("device.tuning.entry", "device.tuning.loop", "device.tuning.metrics"),
        ),
    ),
}
ONLY_IN = {
    "serial": ("device/transport/", "device/find.py"),
    "numba": ("device/simulator/kernel/",),
    "pygame": ("device/gamepad",),
}


def allowed(package: str, name: str, place: str) -> bool:
    """Whether a module of this package, lying at this place, may import this name."""
    if package == "app":
        return True
    modules, never, own = MAY[package]
    top = name.split(".")[0]
    if top in ONLY_IN and not place.startswith(ONLY_IN[top]):
        return False
    if top in PACKAGES:
        return any(name == prefix or name.startswith(prefix + ".") for prefix in own)
    return top in modules and top not in never


def wrong_imports(tree: ast.Module, package: str, place: str, inside: str) -> list[str]:
    """One sentence for every import that points the wrong way."""
    found = []
    for line, name in imported(tree, inside):
        if name.startswith("__future__"):
            continue
        if not allowed(package, name, place):
            found.append(f"{place}:{line}: {package} may not import {name}")
    return found


@pytest.mark.parametrize("package", PACKAGES)
def test_imports_point_one_way(package: str) -> None:
    wrong = [
        sentence
        for path in python_files(package)
        for sentence in wrong_imports(syntax(path), package, relative(path), package_of(path))
    ]
    assert not wrong, "\n".join(wrong)


@pytest.mark.parametrize(
    ("package", "place", "text"),
    [
        ("codegen", "codegen/fields.py", "from PySide6 import QtCore"),
        ("codegen", "codegen/fields.py", "def f():\n    import numpy"),
        ("codegen", "codegen/files.py", "import time"),
        ("codegen", "codegen/read.py", "import device.api"),
        ("device", "device/link.py", "import PySide6.QtWidgets"),
        ("device", "device/link.py", "from widgets.panel import Panel"),
        ("device", "device/link.py", "import serial"),
        ("device", "device/wire.py", "import numba"),
        ("widgets", "widgets/panel.py", "from device import link"),
        ("widgets", "widgets/panel.py", "import threading"),
        ("widgets", "widgets/panel.py", "from app.session import Session"),
    ],
)
def test_a_planted_wrong_import_is_caught(package: str, place: str, text: str) -> None:
    assert len(wrong_imports(ast.parse(text), package, place, package)) == 1


def test_relative_imports_are_followed() -> None:
    tree = ast.parse("from ..widgets import panel")
    assert wrong_imports(tree, "device", "device/transport/tcp.py", "device.transport") == []
    assert wrong_imports(ast.parse("from ...app import tick"), "widgets", "widgets/form/form.py", "widgets.form")


@pytest.mark.parametrize("package", ["codegen", "device"])
def test_no_qt_below_the_widgets(package: str) -> None:
    wrong = [
        f"{relative(path)}:{line}: {name}"
        for path in python_files(package)
        for line, name in imported(syntax(path), package_of(path))
        if name.split(".")[0] in ("PySide6", "PyQt6", "pyqtgraph", "shiboken6")
    ]
    assert not wrong, "\n".join(wrong)


def test_only_the_tests_of_windows_make_windows() -> None:
    """What they leave behind is freed in the window's thread (tests/conftest.py); others free it in any thread."""
    folders = [path for path in (ROOT / "tests").iterdir() if path.is_dir() and path.name not in WINDOWS]
    wrong = [
        f"{relative(path)}:{line}: {name}"
        for folder in folders
        for path in folder.rglob("test_*.py")
        for line, name in imported(syntax(path), package_of(path))
        if name.split(".")[0] in ("PySide6", "pyqtgraph", "widgets")
    ]
    assert not wrong, "\n".join(wrong)
