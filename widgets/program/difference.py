"""The edits between two programs; everyday ones (values, steps put in or taken out) without a full comparison."""

from __future__ import annotations

from collections.abc import Sequence

from codegen.changes import Change, Changed, Inserted, Removed, changes
from codegen.program import Place, Program, Section, Step


def edits(old: Program, new: Program) -> Sequence[Change]:
    """As `codegen.changes`, in time proportional to the edit where nothing moved."""
    found = _Everyday()
    for section in Section:
        found.compare(section.value, old.section(section), new.section(section))
    if found.inserted and found.removed:  # perhaps moved: that needs the full comparison
        return changes(old, new)
    return [*found.removed, *found.inserted, *found.changed]


class _Everyday:
    def __init__(self) -> None:
        self.changed: list[Change] = []
        self.inserted: list[Change] = []
        self.removed: list[Change] = []

    def compare(self, parent: str, old: tuple[Step, ...], new: tuple[Step, ...]) -> None:
        """Equal ids from both ends; what is left in the middle was put in or taken out."""
        if old is new:
            return
        first = self._same(old, new)
        shorter = min(len(old), len(new)) - first
        last = self._same(old[::-1][:shorter], new[::-1][:shorter])
        for index in range(len(old) - last - 1, first - 1, -1):
            self.removed.append(Removed(old[index].id, Place(parent, index)))
        for index in range(first, len(new) - last):
            self.inserted.append(Inserted(new[index], Place(parent, index)))

    def _same(self, old: Sequence[Step], new: Sequence[Step]) -> int:
        """How many steps have the same ids; those that are not the same object are looked into."""
        count = 0
        for before, after in zip(old, new, strict=False):
            if before is not after:
                if before.id != after.id:
                    break
                self._look_into(before, after)
            count += 1
        return count

    def _look_into(self, before: Step, after: Step) -> None:
        if (before.instruction, before.note, before.enabled) != (after.instruction, after.note, after.enabled):
            self.changed.append(Changed(after))
        self.compare(after.id, before.body, after.body)
