"""What was folded in a program, remembered with its file."""

from __future__ import annotations

from PySide6.QtCore import QObject, QTimer

from app.session import Session
from app.settings import Settings
from widgets.program.view import ProgramView

MOST = 40  # files; those folded last stay
SETTLE_MS = 500  # folding all is one change of the settings


class Folding(QObject):
    """Made after the program window: what it shows is there when this folds it."""

    def __init__(self, session: Session, view: ProgramView, settings: Settings, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._session, self._tree, self._settings = session, view.tree, settings
        self._fresh = False  # another document was begun and is about to be shown
        self._wait = QTimer(self, singleShot=True, interval=SETTLE_MS)
        self._wait.timeout.connect(self.remember)
        session.replaced.connect(self._begun)
        session.document_changed.connect(self._shown)
        view.model.folded.connect(self._folded)

    def remember(self) -> None:
        """Writes down what is folded now; a program without a file has nothing to be remembered by."""
        self._wait.stop()
        path = self._session.path
        if path is None:
            return
        name, known = str(path), dict(self._settings.get("folded"))
        known.pop(name, None)
        if folded := self._tree.folded_names():
            known[name] = folded
        self._settings.set("folded", dict(list(known.items())[-MOST:]))

    def _begun(self) -> None:
        self._fresh = True
        self._wait.stop()

    def _folded(self) -> None:
        if not self._fresh:
            self._wait.start()

    def _shown(self) -> None:
        """As it was left; names that are no more are no harm."""
        if not self._fresh:
            return
        names = self._settings.get("folded").get(str(self._session.path), [])
        self._tree.fold_only([name for name in names if isinstance(name, str)] if isinstance(names, list) else [])
        self._fresh = False
