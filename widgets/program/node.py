"""One row of the program tree: a section or a step, with its rows below."""

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

    __slots__ = ("children", "kind", "parent", "row", "section", "step")

    def __init__(self, parent: Node | None, step: Step | None = None, section: str = "") -> None:
        self.parent = parent
        self.step = step
        self.section = section
        self.children: list[Node] = []
        self.row = 0
        self.kind = 0 if step is None else 1 if step.instruction.container else 2  # section, holder of steps, step

    def adopt(self, step: Step) -> None:
        """The same step, changed."""
        self.step = step
        self.kind = 1 if step.instruction.container else 2

    @property
    def id(self) -> str:
        """The step's id, or the section's name."""
        return self.section if self.step is None else self.step.id

    def number(self, start: int = 0) -> None:
        """Writes the row numbers of the children from `start` on."""
        children = self.children
        for row in range(start, len(children)):
            children[row].row = row

    def section_name(self) -> str:
        """The section this row stands in."""
        node: Node | None = self
        while node is not None and not node.section:
            node = node.parent
        return "" if node is None else node.section

    def walk(self) -> Iterator[Node]:
        """This row and everything below it, in order."""
        yield self
        for child in self.children:
            yield from child.walk()


def empty_tree() -> tuple[Node, dict[str, Node]]:
    """The root with the three section rows, and the rows by id."""
    root = Node(None)
    root.children = [Node(root, section=name.value) for name in Section]
    root.number()
    return root, {child.section: child for child in root.children}
