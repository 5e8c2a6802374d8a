"""Undo and redo: a list of documents and what was done to each. Frozen: every step gives a new History."""

from __future__ import annotations

import dataclasses as dc

from codegen.document import Document

JOIN_SECONDS = 1.0  # typing in one field within this time is one step
MOST = 2000  # steps kept


@dc.dataclass(frozen=True, slots=True)
class Entry:
    """A document before an edit (or after it, in the redo list), and what the edit was."""

    document: Document
    label: str
    key: str | None = None
    time: float = 0.0


@dc.dataclass(frozen=True, slots=True)
class History:
    """The present document with the ways back and forth."""

    present: Document
    past: tuple[Entry, ...] = ()
    future: tuple[Entry, ...] = ()
    most: int = MOST

    def push(self, document: Document, label: str, *, key: str | None = None, now: float) -> History:
        """Adds an edit; one with the key of the edit before it, within a second, joins it."""
        if document == self.present:
            return self
        last = self.past[-1] if self.past else None
        joins = last is not None and key is not None and last.key == key and not self.future
        if last is not None and joins and now - last.time <= JOIN_SECONDS:
            past = (*self.past[:-1], dc.replace(last, label=label, time=now))
        else:
            past = (*self.past, Entry(self.present, label, key, now))[-self.most :]
        return dc.replace(self, present=document, past=past, future=())

    def undo(self) -> History:
        """One edit back; the same history when there is none."""
        if not self.past:
            return self
        entry = self.past[-1]
        future = (*self.future, Entry(self.present, entry.label))
        return dc.replace(self, present=entry.document, past=self.past[:-1], future=future)

    def redo(self) -> History:
        """One undone edit again; the same history when there is none."""
        if not self.future:
            return self
        entry = self.future[-1]
        past = (*self.past, Entry(self.present, entry.label))
        return dc.replace(self, present=entry.document, past=past, future=self.future[:-1])

    @property
    def can_undo(self) -> bool:
        return bool(self.past)

    @property
    def can_redo(self) -> bool:
        return bool(self.future)

    @property
    def undo_label(self) -> str:
        """What Undo takes back ("" = nothing)."""
        return self.past[-1].label if self.past else ""

    @property
    def redo_label(self) -> str:
        """What Redo does again ("" = nothing)."""
        return self.future[-1].label if self.future else ""

    @property
    def labels(self) -> tuple[str, ...]:
        """What was done, oldest first."""
        return tuple(entry.label for entry in self.past)
