"""A click on an axis of a path's picture turns it: a setting of the machine, kept, undone, and obeyed by the code."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot

from codegen.instructions import CircularPath
from codegen.instructions.path_parts import Piece, Shape
from tests.stage import make_studio
from widgets.form.path_picture import PathPicture

ARC = Piece(shape=Shape.ARC, radius="100", start="30", sweep="90")


def test_an_axis_is_turned_by_its_letter(qtbot: QtBot, tmp_path: Path) -> None:
    """An arc from 30° by 90° with X turned: 180 - 30 = 150°, by -90° (the mirror of a circle)."""
    stage = make_studio(tmp_path, example="")
    session, view = stage.studio.session, stage.studio.program
    stage.studio.window.show()
    (step_id,) = session.insert([CircularPath(speed="100", segments=(ARC,))])
    dialog = view.dialogs.modify(step_id)
    picture = dialog.form.picture
    assert isinstance(picture, PathPicture)
    picture.grab()
    assert "CR 100,30,90" in session.listing.text
    QTest.mouseClick(picture, Qt.MouseButton.LeftButton, pos=picture.letters["X"].center().toPoint())
    assert session.document.setup.axis("X").mirrored and not session.document.setup.axis("Y").mirrored
    assert "CR 100,150,-90" in session.listing.text
    assert dialog.isVisible()
    session.undo()
    assert not session.document.setup.axis("X").mirrored and "CR 100,30,90" in session.listing.text
    dialog.reject()
    stage.clear_away()
