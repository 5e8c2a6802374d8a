"""The stick on the screen by mouse and keys: what it tells, and everything that lets it go."""

from __future__ import annotations

import math
from collections.abc import Iterator

import pytest
from PySide6.QtCore import QEvent, QPoint, Qt
from PySide6.QtGui import QKeyEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QLineEdit, QVBoxLayout, QWidget

from app.theme import Choice, Theme
from device.jog import deflection
from widgets.parts.stick import Stick

LEFT, SHIFT = Qt.MouseButton.LeftButton, Qt.KeyboardModifier.ShiftModifier
Told = list[tuple[float, float]]


@pytest.fixture
def place(qapp: QApplication) -> Iterator[tuple[QWidget, Stick, QLineEdit, Told]]:
    worn = Theme(qapp, Choice.LIGHT)
    window, stick, other, told = QWidget(), Stick(dead=0.2), QLineEdit(), Told()
    column = QVBoxLayout(window)
    column.addWidget(stick)
    column.addWidget(other)
    stick.setFixedSize(200, 200)
    stick.moved.connect(lambda x, y: told.append((x, y)))
    window.show()
    window.activateWindow()
    stick.setFocus()
    QApplication.processEvents()
    yield window, stick, other, told
    window.close()
    worn.release()


def test_it_tells_where_the_mouse_drags_it_and_springs_back(
    place: tuple[QWidget, Stick, QLineEdit, Told],
) -> None:
    _, stick, _, told = place
    QTest.mousePress(stick, LEFT, pos=QPoint(100, 100))
    assert told == []  # in the dead zone
    QTest.mouseMove(stick, QPoint(199, 100))
    assert told[-1] == (1.0, 0.0)
    QTest.mouseMove(stick, QPoint(190, 10))  # beyond the ring: its edge, to the upper right
    assert told[-1] == pytest.approx((math.sqrt(0.5), math.sqrt(0.5)))
    QTest.mouseRelease(stick, LEFT, pos=QPoint(190, 10))
    assert told[-1] == (0.0, 0.0) and stick.value == (0.0, 0.0) and not stick.held
    count = len(told)
    QTest.mouseMove(stick, QPoint(30, 100))
    assert len(told) == count


def test_arrows_lean_it_with_shift_a_little(place: tuple[QWidget, Stick, QLineEdit, Told]) -> None:
    _, stick, _, told = place
    QTest.keyPress(stick, Qt.Key.Key_Right)
    assert told == [(1.0, 0.0)]
    again = QKeyEvent(QEvent.Type.KeyPress, Qt.Key.Key_Up, Qt.KeyboardModifier.NoModifier, "", True)
    QApplication.sendEvent(stick, again)
    assert told == [(1.0, 0.0)]  # the repetition of the keyboard is no press
    QTest.keyPress(stick, Qt.Key.Key_Up)
    assert told[-1] == pytest.approx((math.sqrt(0.5), math.sqrt(0.5)))
    QTest.keyRelease(stick, Qt.Key.Key_Right)
    assert told[-1] == pytest.approx((0.0, 1.0))
    QTest.keyRelease(stick, Qt.Key.Key_Up)
    assert told[-1] == (0.0, 0.0)
    QTest.keyPress(stick, Qt.Key.Key_Left, SHIFT)
    assert told[-1] == pytest.approx((-0.3, 0.0))


@pytest.mark.parametrize("how", ["focus", "hidden", "disabled", "Shift released", "Shift pressed", "other button"])
def test_whatever_ends_the_hold_lets_it_go_until_it_is_pressed_again(
    place: tuple[QWidget, Stick, QLineEdit, Told], how: str
) -> None:
    window, stick, other, told = place
    QTest.keyPress(stick, Qt.Key.Key_Left, SHIFT if how == "Shift released" else Qt.KeyboardModifier.NoModifier)
    assert told[-1][0] < 0
    if how == "focus":
        other.setFocus()
    elif how == "hidden":
        window.hide()
    elif how == "disabled":
        stick.setEnabled(False)
    elif how == "Shift released":
        QTest.keyRelease(stick, Qt.Key.Key_Shift)
    elif how == "Shift pressed":
        QTest.keyPress(stick, Qt.Key.Key_Shift)
    else:
        QTest.mouseClick(stick, Qt.MouseButton.RightButton)
    assert told[-1] == (0.0, 0.0) and not stick.held
    QTest.keyRelease(stick, Qt.Key.Key_Left)
    assert told[-1] == (0.0, 0.0)


def test_a_way_without_an_axis_is_useless(place: tuple[QWidget, Stick, QLineEdit, Told]) -> None:
    _, stick, _, told = place
    stick.show_axes("X", "")
    QTest.keyPress(stick, Qt.Key.Key_Up)
    assert told == []
    QTest.keyPress(stick, Qt.Key.Key_Right)
    assert told and told[-1][1] == 0.0 and told[-1][0] > 0


def test_the_dead_zone_is_round_and_beyond_it_nothing_jumps() -> None:
    assert deflection(0.1, 0.1, 0.2) == (0.0, 0.0)
    assert deflection(0.2000001, 0.0, 0.2)[0] == pytest.approx(0.0, abs=1e-6)
    assert deflection(-0.6, 0.0, 0.2) == pytest.approx((-0.5, 0.0))  # half of what is left beyond 0.2
    x, y = deflection(1.0, 1.0, 0.2)  # some pads reach the corner of the square
    assert math.hypot(x, y) == pytest.approx(1.0)
    assert deflection(math.nan, 1.0) == (0.0, 0.0)
