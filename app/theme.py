"""Fusion with our own palettes; light or dark as the system says, or as the person chose."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from enum import StrEnum
from typing import Any

import shiboken6
from PySide6.QtCore import QCoreApplication, QEvent, QObject, Qt
from PySide6.QtGui import QPalette
from PySide6.QtWidgets import QApplication, QStyleFactory, QWidget

import resources
from widgets.parts.look import PROPERTY, Look
from widgets.parts.pieces import DRESSED, Pieces, in_breaths

BREATH_S = 0.012  # more than others take: nothing is painted meanwhile
OWN_STYLE = Qt.WidgetAttribute.WA_SetStyle


class Choice(StrEnum):
    """What the person asked for."""

    SYSTEM = "system"
    LIGHT = "light"
    DARK = "dark"


class Theme(QObject):
    """Keeps the application in the chosen colours and follows the system when told to.

    Where `ticking`, somebody calls `look` with each tick, and what there is changes piece by piece.
    """

    def __init__(self, application: QApplication, choice: Choice = Choice.SYSTEM, ticking: bool = False) -> None:
        super().__init__()
        self._application = application
        self._table = read_table()
        self.choice = choice
        self.making = Pieces(iter(()))
        self._ticking = False
        self._memory = QWidget()  # while one has a sheet of its own Qt remembers what widgets were like without
        self._memory.setStyleSheet("QWidget {}")
        if not isinstance(application.property(PROPERTY), Look):  # once: each further style would wrap the one before
            application.setStyle(QStyleFactory.create("Fusion"))
        application.styleHints().colorSchemeChanged.connect(self._follow)
        self.choose(choice)
        self._ticking = ticking

    def look(self) -> None:
        """With each tick: some more of what there is."""
        self.making.step()

    def choose(self, choice: Choice) -> None:
        """Light, dark, or whatever the system has."""
        self.choice = choice
        hints = self._application.styleHints()
        wanted = {Choice.LIGHT: Qt.ColorScheme.Light, Choice.DARK: Qt.ColorScheme.Dark}.get(
            choice, Qt.ColorScheme.Unknown
        )
        hints.setColorScheme(wanted)
        self._follow()

    def release(self) -> None:
        """Follows the system no longer."""
        self._application.styleHints().colorSchemeChanged.disconnect(self._follow)

    def _follow(self, _scheme: Qt.ColorScheme | None = None) -> None:
        if self.choice is Choice.SYSTEM:
            dark = self._application.styleHints().colorScheme() is Qt.ColorScheme.Dark
        else:
            dark = self.choice is Choice.DARK
        self._wear(make_look(self._table, dark))

    def _wear(self, wanted: Look) -> None:
        if self._application.property(PROPERTY) == wanted:
            return
        self._application.setProperty(PROPERTY, wanted)
        self.making = Pieces(self._pieces(wanted))
        if not self._ticking:
            self.making.finish()

    def _pieces(self, wanted: Look) -> Iterator[None]:
        """The sheet, then the widgets that there are, a few at a time: all at once takes Qt a third of a second.

        What is in sight stays as it was until all of it is ready: half of each theme could not be read.
        """
        there = [each for each in everything() if each.testAttribute(DRESSED) and not each.testAttribute(OWN_STYLE)]
        behind = {each for each in there if not each.isVisible() or each.visibleRegion().isEmpty()}
        in_sight = [each for each in there if each not in behind]
        yield
        with _still(each for each in QApplication.topLevelWidgets() if each.isVisible()):
            self._put_on(wanted, [each for each in there if shiboken6.isValid(each)])
            yield
            yield from in_breaths(_dressed_anew(in_sight), breath_s=BREATH_S)
            yield
        yield
        yield from in_breaths(_dressed_anew(behind), breath_s=BREATH_S)

    def _put_on(self, wanted: Look, there: list[QWidget]) -> None:
        """For what comes from now on; what is there is passed over by Qt, as if it were not dressed yet."""
        for widget in there:
            widget.setAttribute(DRESSED, False)
            widget.setAttribute(OWN_STYLE, True)
        application = self._application
        application.setFont(wanted.body_font())
        application.setPalette(make_palette(wanted))
        application.setStyleSheet("")  # over another sheet Qt dresses each widget once for everything around it
        application.setStyleSheet(style_sheet(self._table, wanted))
        for widget in there:
            widget.setAttribute(DRESSED, True)
            widget.setAttribute(OWN_STYLE, False)


@contextmanager
def _still(windows: Iterable[QWidget]) -> Iterator[None]:
    """Meanwhile nothing of these is painted."""
    held = [each for each in windows if each.updatesEnabled()]
    for window in held:
        window.setUpdatesEnabled(False)
    try:
        yield
    finally:
        for window in held:
            if shiboken6.isValid(window):
                window.setUpdatesEnabled(True)


def everything() -> list[QWidget]:
    """All widgets, window by window, what is inside after what is around it."""
    windows = [each for each in QApplication.topLevelWidgets() if each.parentWidget() is None]
    return [widget for window in windows for widget in (window, *window.findChildren(QWidget))]


def _dressed_anew(widgets: Iterable[QWidget]) -> Iterator[None]:
    """Each for the sheet of now, as Qt does it: polished, then told."""
    told = QEvent(QEvent.Type.StyleChange)
    for widget in widgets:
        if shiboken6.isValid(widget):
            widget.style().polish(widget)
            QCoreApplication.sendEvent(widget, told)
            widget.update()
        yield


def read_table() -> dict[str, Any]:
    """The rows of `theme.toml`."""
    return tomllib.loads(resources.path("theme.toml").read_text(encoding="utf-8"))


def make_look(table: dict[str, Any], dark: bool) -> Look:
    """The light or the dark theme of the table."""
    return Look(dark=dark, colours=table["dark" if dark else "light"], space=table["space"], fonts=table["fonts"])


def make_palette(wanted: Look) -> QPalette:
    """Qt's own roles from our tokens, disabled ones included."""
    role = QPalette.ColorRole
    tokens = {
        role.Window: "window", role.WindowText: "text", role.Base: "surface", role.AlternateBase: "raised",
        role.Text: "text", role.Button: "raised", role.ButtonText: "text", role.BrightText: "stop",
        role.ToolTipBase: "raised", role.ToolTipText: "text", role.PlaceholderText: "quiet",
        role.Highlight: "selection", role.HighlightedText: "selection_text", role.Link: "accent",
        role.LinkVisited: "group_flow", role.Accent: "accent", role.Mid: "line", role.Dark: "border",
        role.Light: "raised", role.Midlight: "window", role.Shadow: "border",
    }  # fmt: skip
    palette = QPalette()
    for each, token in tokens.items():
        palette.setColor(each, wanted.colour(token))
    for each in (role.WindowText, role.Text, role.ButtonText):
        palette.setColor(QPalette.ColorGroup.Disabled, each, wanted.colour("disabled"))
    return palette


def style_sheet(table: dict[str, Any], wanted: Look) -> str:
    """The one style sheet, its tokens filled in."""
    sheet: str = table["style"]["sheet"]
    words = {
        **wanted.colours,
        **{key: str(value) for key, value in wanted.space.items()},
        "title_points": str(wanted.fonts["title_points"]),
        "icons": resources.path("icons").as_posix(),
        "name": "dark" if wanted.dark else "light",
    }
    for key, value in words.items():
        sheet = sheet.replace("{" + key + "}", str(value))
    return sheet
