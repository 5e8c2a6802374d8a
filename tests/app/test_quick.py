"""Loading without reading every source."""

from __future__ import annotations

import inspect
from pathlib import Path

import pytest
from PySide6.QtWidgets import QApplication

from app.quick import spare_reading


def test_no_source_is_read_for_nothing(qapp: QApplication, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from shibokensupport import feature

    read: list[str] = []
    monkeypatch.setattr(feature, "_mod_uses_pyside", feature._mod_uses_pyside)  # put back at the end
    monkeypatch.setattr(inspect, "getsource", lambda module: read.append(module.__name__) or "")
    monkeypatch.syspath_prepend(tmp_path)
    for name in ("unheard_first", "unheard_second"):
        (tmp_path / f"{name}.py").write_text("from PySide6.QtCore import QObject\n", encoding="utf-8")
    __import__("unheard_first")
    assert read == ["unheard_first"]  # as PySide does by itself; once it does not, app/quick.py can go
    spare_reading()
    assert __import__("unheard_second").QObject().objectName() == ""
    assert read == ["unheard_first"]
