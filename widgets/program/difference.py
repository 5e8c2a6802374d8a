"""The edits between two programs; everyday ones (values, steps put in or taken out) without a full comparison."""

from __future__ import annotations

from collections.abc import Sequence

from codegen.changes import Change, Changed, Inserted, Moved, Removed, changes
from codegen.program import Place, Program, Section, Step


def edits(old: Program, new: Program) -> Sequence[Change]:
    """As `codegen.changes`, in time proportional to the edit where nothing moved."""
    found = _Everyday()
    for section in Section:
        found.compare(section.value, old.section(section), new.section(section))
    if found.inserted and found.removed:  # perhaps moved elsewhere: that needs the full comparison
        return changes(old, new)
    return [*found.removed, *found.inserted, *found.moved, *found.changed]


class _Everyday:
    def __init__(self) -> None:
        self.changed: list[Change] = []
        self.inserted: list[Change] = []
        self.removed: list[Change] = []
        self.moved: list[Change] = []

    def compare(self, parent: str, old: tuple[Step, ...], new: tuple[Step, ...]) -> None:
        """Equal ids from both ends; what is left in the middle was put in or taken out."""
        if old is new:
            return
        first = self._same(old, new)
        shorter = min(len(old), len(new)) - first
        last = self._same(old[::-1][:shorter], new[::-1][:shorter])
        if len(old) == len(new) and self._turned(parent, first, old[first : len(old) - last], new[first:]):
            return
        for index in range(len(old) - last - 1, first - 1, -1):
            self.removed.append(Removed(old[index].id, Place(parent, index)))
        for index in range(first, len(new) - last):
            self.inserted.append(Inserted(new[index], Place(parent, index)))

    def _turned(self, parent: str, first: int, old: Sequence[Step], new: Sequence[Step]) -> bool:
        """Some neighbouring steps went up or down past others: so few that moving them says it."""
        count = len(old)
        if count < 2:
            return False
        ids, now = [step.id for step in old], [step.id for step in new[:count]]
        shift = ids.index(now[0]) if now[0] in ids else 0
        if ids[shift:] + ids[:shift] != now:
            return False
        if shift <= count // 2:  # the first ones went down: each time the one that is first now
            self.moved += [Moved(name, Place(parent, first), Place(parent, first + count - 1)) for name in ids[:shift]]
        else:
            self.moved += [
                Moved(name, Place(parent, first + shift + number), Place(parent, first + number))
                for number, name in enumerate(ids[shift:])
            ]
        for before, after in zip((*old[shift:], *old[:shift]), new, strict=False):
            if before is not after:
                self._look_into(before, after)
        return True

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
