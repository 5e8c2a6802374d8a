"""Every module can be imported where the terminal modules of Unix are missing."""

from __future__ import annotations

import subprocess
import sys

from tests.rules.sources import PACKAGES, ROOT, python_files

SCRIPT = """
import importlib, sys, os
os.environ["QT_QPA_PLATFORM"] = "offscreen"
# Packages that are not ours bring their own Windows version; they are loaded before the modules vanish.
for name in ("serial", "serial.tools.list_ports", "numba", "numpy", "pyqtgraph", "PySide6.QtWidgets", "platformdirs",
             "subprocess", "multiprocessing.connection", "asyncio", "socketserver"):
    try:
        importlib.import_module(name)
    except ImportError:
        pass
for name in ("pty", "termios", "fcntl", "tty", "resource", "pwd", "grp"):
    sys.modules[name] = None
failed = []
for name in sys.argv[1:]:
    try:
        importlib.import_module(name)
    except ImportError as problem:
        failed.append(f"{name}: {problem}")
print("\\n".join(failed))
sys.exit(bool(failed))
"""


def module_names() -> list[str]:
    """Every module of the program, except the ones that run when imported."""
    names = []
    for path in python_files(*PACKAGES):
        parts = list(path.relative_to(ROOT).with_suffix("").parts)
        if parts[-1] == "__init__":
            parts.pop()
        names.append(".".join(parts))
    return [name for name in names if name.split(".")[-1] != "__main__" or name == "app.__main__"]


def test_everything_imports_without_pty_termios_and_fcntl() -> None:
    done = subprocess.run([sys.executable, "-c", SCRIPT, *module_names()], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
