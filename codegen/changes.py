"""What is different between two programs, by step id, as edits in the order in which they can be done."""

from __future__ import annotations

import dataclasses as dc
from bisect import bisect_left
from typing import TypeAlias

from codegen.program import Place, Program, Section, Step, Steps


@dc.dataclass(frozen=True, slots=True)
class Inserted:
    """A new step with all it holds."""

    step: Step
    place: Place


@dc.dataclass(frozen=True, slots=True)
class Moved:
    """A step that stands elsewhere; `place` counts after it was taken out at `source`."""

    id: str
    source: Place
    place: Place


@dc.dataclass(frozen=True, slots=True)
class Changed:
    """A step whose instruction, note or state is new (what it holds is told by the other changes)."""

    step: Step


@dc.dataclass(frozen=True, slots=True)
class Removed:
    """A step that is gone, with all it still held."""

    id: str
    place: Place


Change: TypeAlias = Inserted | Moved | Changed | Removed


class _Tree:
    """A program as lists that can be edited."""

    def __init__(self, program: Program) -> None:
        self.steps: dict[str, Step] = {}
        self.parent: dict[str, str] = {}
        self.children: dict[str, list[str]] = {}
        for section in Section:
            self._add(section.value, program.section(section))

    def _add(self, parent: str, steps: Steps) -> None:
        self.children[parent] = [step.id for step in steps]
        for step in steps:
            self.steps[step.id] = step
            self.parent[step.id] = parent
            self._add(step.id, step.body)

    def insert(self, step: Step, place: Place) -> None:
        self.children[place.parent].insert(place.index, step.id)
        self.steps[step.id] = step
        self.parent[step.id] = place.parent
        self._add(step.id, step.body)

    def take(self, id: str) -> Place:
        parent = self.parent[id]
        index = self.children[parent].index(id)
        del self.children[parent][index]
        return Place(parent, index)

    def put(self, id: str, place: Place) -> None:
        self.children[place.parent].insert(place.index, id)
        self.parent[id] = place.parent

    def frozen(self, parent: str) -> Steps:
        return tuple(dc.replace(self.steps[id], body=self.frozen(id)) for id in self.children[parent])


def changes(old: Program, new: Program) -> tuple[Change, ...]:
    """The edits that turn the tree of `old` into that of `new`; each index is right at its moment."""
    if all(old.section(section) is new.section(section) for section in Section):
        return ()
    return tuple(_Difference(old, new).work())


class _Difference:
    def __init__(self, old: Program, new: Program) -> None:
        self.new = new
        self.working = _Tree(old)
        self.old_ids = frozenset(self.working.steps)
        self.new_ids = {step.id for step in new.steps()}
        self.found: list[Change] = []

    def work(self) -> list[Change]:
        for section in Section:
            self.level(section.value, self.new.section(section))
        self.remove_rest()
        return self.found

    def level(self, parent: str, wanted: Steps) -> None:
        """Puts the steps of one parent right, then what they hold."""
        staying = self.staying(parent, wanted)
        index = 0
        for step in wanted:
            if step.id in staying:
                index = self.working.children[parent].index(step.id, index)
            elif step.id in self.old_ids:
                self.move(step.id, parent, index)
                index = self.working.children[parent].index(step.id)
            else:
                self.insert(step, Place(parent, index))
            index += 1
        for step in wanted:
            if step.id in self.old_ids:
                self.compare(step)
            elif self.has_old(step):
                self.level(step.id, step.body)

    def staying(self, parent: str, wanted: Steps) -> frozenset[str]:
        """The steps that need not move: the longest run that keeps its order."""
        places = {id: place for place, id in enumerate(self.working.children[parent])}
        here = [step.id for step in wanted if step.id in places]
        return frozenset(here[place] for place in longest_rising([places[id] for id in here]))

    def compare(self, step: Step) -> None:
        before = self.working.steps[step.id]
        if before is step:
            unchanged = self.working.children[step.id] == [inner.id for inner in step.body]
            if unchanged and not self.moved_inside(step):
                return
        if (before.instruction, before.note, before.enabled) != (step.instruction, step.note, step.enabled):
            self.found.append(Changed(step))
            self.working.steps[step.id] = step
        self.level(step.id, step.body)

    def moved_inside(self, step: Step) -> bool:
        """Whether something further down has already been taken out."""
        return any(
            self.working.children[inner.id] != [each.id for each in inner.body] or self.moved_inside(inner)
            for inner in step.body
            if inner.body
        )

    def insert(self, step: Step, place: Place) -> None:
        """A new step; old steps that moved into it come later, one by one."""
        shell = dc.replace(step, body=()) if self.has_old(step) else step
        self.working.insert(shell, place)
        self.found.append(Inserted(shell, place))

    def has_old(self, step: Step) -> bool:
        return any(inner.id in self.old_ids or self.has_old(inner) for inner in step.body)

    def move(self, id: str, parent: str, index: int) -> None:
        source = self.working.take(id)
        if source.parent == parent and source.index < index:
            index -= 1
        place = Place(parent, index)
        self.working.put(id, place)
        self.found.append(Moved(id, source, place))

    def remove_rest(self) -> None:
        """Takes out what the new program has no more, whole branches at once, the last ones first."""

        def among(parent: str) -> None:
            for id in reversed(tuple(self.working.children[parent])):
                if id in self.new_ids:
                    among(id)
                else:
                    self.found.append(Removed(id, self.working.take(id)))

        for section in Section:
            among(section.value)


def longest_rising(numbers: list[int]) -> list[int]:
    """Places of a longest strictly rising run among `numbers` (patience sorting)."""
    tops: list[int] = []
    at: list[int] = []
    before: list[int] = []
    for place, number in enumerate(numbers):
        pile = bisect_left(tops, number)
        before.append(at[pile - 1] if pile else -1)
        if pile == len(tops):
            tops.append(number)
            at.append(place)
        else:
            tops[pile] = number
            at[pile] = place
    run: list[int] = []
    place = at[-1] if at else -1
    while place >= 0:
        run.append(place)
        place = before[place]
    return run[::-1]


def apply(program: Program, edits: tuple[Change, ...]) -> Program:
    """The program after the edits (name and description stay)."""
    tree = _Tree(program)
    for edit in edits:
        match edit:
            case Inserted(step=step, place=place):
                tree.insert(step, place)
            case Moved(id=id, place=place):
                tree.take(id)
                tree.put(id, place)
            case Changed(step=step):
                tree.steps[step.id] = step
            case Removed(id=id):
                tree.take(id)
    configuration, main, routines = (tree.frozen(section.value) for section in Section)
    return dc.replace(program, configuration=configuration, main=main, routines=routines)
