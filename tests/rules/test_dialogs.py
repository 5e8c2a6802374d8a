"""The buttons at the foot of every dialog stand in the order of the platform (widgets/parts/foot.py)."""

from __future__ import annotations

import ast

from tests.rules.sources import PACKAGES, imported, package_of, python_files, relative, syntax

OWN = {"widgets/editor/window.py"}  # only its own cross closes it


def is_dialog(node: ast.AST) -> bool:
    return isinstance(node, ast.ClassDef) and any(
        isinstance(base, ast.Name) and base.id == "QDialog" for base in node.bases
    )


def test_every_dialog_has_the_foot_of_all_dialogs() -> None:
    dialogs = [path for path in python_files(*PACKAGES) if any(map(is_dialog, ast.walk(syntax(path))))]
    assert len(dialogs) > 20
    without = [
        relative(path)
        for path in dialogs
        if "widgets.parts.foot.foot" not in {name for _, name in imported(syntax(path), package_of(path))}
    ]
    assert set(without) <= OWN
