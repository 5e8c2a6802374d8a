"""One row of the program: a section or a step, with the rows below it."""

from __future__ import annotations

from collections.abc import Iterator

from codegen.program import Section, Step

TITLES = {"configuration": "Configuration", "main": "Main", "routines": "Subroutines"}
HINTS = {
    "configuration": "Settings that are sent once, before anything moves",
    "main": "What the machine does: pick an instruction on the left and press Enter",
    "routines": "Parts used more than once, and answers to limits, errors and inputs",
}


class Node:
    """A row; `step` is None for a section (then `section` names it) and for the root."""

    __slots__ = ("children", "folded", "kind", "line", "parent", "row", "section", "step")

    def __init__(self, parent: Node | None, step: Step | None = None, section: str = "") -> None:
        self.parent = parent
        self.step = step
        self.section = section
        self.children: list[Node] = []
        self.folded = False
        self.row = 0  # among the children of its parent
        self.line = -1  # on the screen, counted from the top; -1 while something above is folded
        self.kind = 0 if step is None else 1 if step.instruction.container else 2  # section, holder of steps, step

    def adopt(self, step: Step) -> None:
        """The same step, changed."""
        self.step = step
        self.kind = 1 if step.instruction.container else 2

    @property
    def id(self) -> str:
        """The step's id, or the section's name."""
        return self.section if self.step is None else self.step.id

    @property
    def depth(self) -> int:
        """How far in it stands: 0 for a section."""
        return sum(1 for _ in self.above()) - 1

    def above(self) -> Iterator[Node]:
        """What it stands in, from inside out, the root last."""
        node = self.parent
        while node is not None:
            yield node
            node = node.parent

    def number(self, start: int = 0) -> None:
        """Writes the row numbers of the children from `start` on."""
        children = self.children
        for row in range(start, len(children)):
            children[row].row = row

    def section_name(self) -> str:
        """The section this row stands in."""
        return self.section or next((node.section for node in self.above() if node.section), "")

    def walk(self) -> Iterator[Node]:
        """This row and everything below it, in order."""
        yield self
        for child in self.children:
            yield from child.walk()

    def unfolded(self) -> Iterator[Node]:
        """This row and what is to be seen below it, in order."""
        yield self
        if not self.folded:
            for child in self.children:
                yield from child.unfolded()

    def is_open_to_view(self) -> bool:
        """Whether rows below it are on the screen."""
        return not self.folded and (self.line >= 0 or self.parent is None)


def empty_tree() -> tuple[Node, dict[str, Node]]:
    """The root with the three section rows, and the rows by id."""
    root = Node(None)
    root.children = [Node(root, section=name.value) for name in Section]
    root.number()
    return root, {child.section: child for child in root.children}
