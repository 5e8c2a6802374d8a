"""F12 stops, whatever has the focus: dialogs, popups, drags and open editors included."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from PySide6 import QtCore, QtGui, QtWidgets
from PySide6.QtCore import QCoreApplication, QEvent, QObject, Qt
from PySide6.QtGui import QKeyEvent

KEY = Qt.Key.Key_F12
SEEN = frozenset({QEvent.Type.KeyPress, QEvent.Type.KeyRelease, QEvent.Type.ShortcutOverride})


# values, not objects: a filter never meets them (a test looks whether that is so)
VALUES = (
    "QAccessible", "QBrush", "QByteArray", "QCbor", "QColor", "QConical", "QDataStream", "QDate", "QDir", "QEasing",
    "QFont", "QGlyph", "QIcon", "QImage", "QJson", "QLocale", "QMatrix", "QMeta", "QOpenGLExtra", "QOpenGLFunctions",
    "QPageLayout", "QPageR", "QPageSize", "QPainter", "QPaintEngine", "QPalette", "QPixel", "QPixmap", "QRandom",
    "QRegular", "QRhi", "QShader", "QStandardPaths", "QString", "QStyleOption", "QSurfaceFormat", "QTextBlock",
    "QTextChar", "QTextCursor", "QTextFormat", "QTextLength", "QTextOption", "QTextStream", "QUrl", "QUuid", "QVector",
    "QXml", "QGradient", "QCryptographic", "QFutureInterface", "QTextBoundary", "QTextLayout", "QTextLine", "QLibraryI",
    "QCommandLineP", "QCommandLineO", "QRawFont", "QStyleHintReturn", "QSysInfo", "QTransform", "QBluetooth",
)  # fmt: skip
OBJECTS = (
    "QTextBlockGroup", "QFontComboBox", "QFontDialog", "QColorDialog", "QDateEdit", "QDateTimeEdit", "QStringListModel",
    "QIconDragEvent",
    "QRegularExpressionValidator", "QRhiWidget",
)  # fmt: skip


def make_types() -> None:
    """Makes the types of Qt's objects and events known to Python before a filter sees any of them.

    PySide makes its types when they are first met. Met inside an event filter, making one type can begin to make
    another, which ends the whole process (PySide 6.8 to 6.11); most of them are met soon anyway.
    """
    for module in (QtCore, QtGui, QtWidgets):
        for name in dir(module):
            if name.startswith("Q") and (name in OBJECTS or not name.startswith(VALUES)):
                getattr(module, name)


class StopKey(QObject):
    """An event filter of the whole application, always the first one."""

    def __init__(self, application: QCoreApplication, stop: Callable[[], None]) -> None:
        super().__init__(application)
        make_types()
        self._application = application
        self._stop = stop
        self._wanted = True
        application.installEventFilter(self)

    @contextmanager
    def aside(self) -> Iterator[None]:
        """While something is done in which no key can come: what widgets tell each other meanwhile is not looked at.

        That takes a quarter of the time of making widgets. Afterwards it is the first filter again: a drag, for
        example, installs one that swallows every key.
        """
        self._application.removeEventFilter(self)
        try:
            yield
        finally:
            if self._wanted:
                self._application.installEventFilter(self)

    def remove(self) -> None:
        """F12 does nothing any more."""
        self._wanted = False
        self._application.removeEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        # every event of the program comes through here: its type is asked last, because that is what takes time
        if not isinstance(event, QKeyEvent) or event.key() != KEY or event.type() not in SEEN:
            return False
        event.accept()
        if event.type() is QEvent.Type.KeyPress and not event.isAutoRepeat():
            self._stop()
        return True
