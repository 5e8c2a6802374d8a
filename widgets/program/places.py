"""Where steps may go: what a point of the screen means when steps are dropped there, and one place up or down."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass

from codegen.instructions import End
from codegen.program import Place
from widgets.program.node import Node

EDGE = 0.25  # of a row that holds steps: above it goes before the step, below it behind; the rest goes inside
Refusal = Callable[[Place], str]  # why the dragged steps cannot stand there; empty when they can


@dataclass(frozen=True, slots=True)
class Target:
    """A place of the program, and how it is shown: a line under (or above) a row, or a frame around one."""

    place: Place
    line: int
    shown: str  # "above" | "below" | "on"
    depth: int  # how far in the mark begins


def target_at(rows: Sequence[Node], line: int, height: float, depth: int, refused: Refusal) -> Target:
    """What a point means: `height` is 0 at the top of the row and 1 at its bottom, `depth` counts steps inwards."""
    node = rows[line]
    if node.step is None or node.parent is None:
        if height > 1 - EDGE and node.children and not node.folded:
            return Target(Place(node.id, 0), line, "below", 1)
        return Target(Place(node.id, len(node.children)), line, "on", 0)
    before = Target(Place(node.parent.id, node.row), line, "above", node.depth)
    if node.kind == 1:
        inside = Target(Place(node.id, len(node.children)), line, "on", node.depth)
        if EDGE <= height <= 1 - EDGE:
            return inside
        if height > 1 - EDGE and not node.folded:
            return Target(Place(node.id, 0), line, "below", node.depth + 1)
    if height < 0.5:
        return before
    return _below(node, line, depth, refused)


def _below(node: Node, line: int, depth: int, refused: Refusal) -> Target:
    """Under the last step of blocks several places meet: how far in the point is decides, among those that fit."""
    found = [Target(Place(_parent(node).id, node.row + 1), line, "below", node.depth)]
    while node.row == len(_parent(node).children) - 1 and _parent(node).step is not None:
        node = _parent(node)
        found.append(Target(Place(_parent(node).id, node.row + 1), line, "below", node.depth))
    found.sort(key=lambda target: abs(target.depth - max(depth, 1)))
    return next((target for target in found if not refused(target.place)), found[0])


def within(nodes: dict[str, Node], place: Place, moving: Collection[str] = ()) -> Place:
    """The same place, but in front of the End that closes a subroutine: behind it nothing would run."""
    children = nodes[place.parent].children
    parent = nodes[place.parent].step
    if parent is None or parent.instruction.section != "S":
        return place
    staying = [node for node in children if node.id not in moving]
    last = next((node for node in reversed(staying) if node.step is not None and node.step.enabled), None)
    if last is None or last.step is None or not isinstance(last.step.instruction, End):
        return place
    return Place(place.parent, min(place.index, last.row))


def neighbour(nodes: dict[str, Node], moving: Sequence[str], by: int, refused: Refusal) -> Place | None:
    """The next place up (`by` -1) or down (1), into and out of open blocks; None at the end of the section."""
    first = nodes[moving[0]]
    section = nodes[first.section_name()]
    gone = set(moving)
    all_of_them = list(_places(section, gone))
    here = (_parent(first).id, sum(1 for each in _parent(first).children[: first.row] if each.id not in gone))
    number = next(at for at, (_, kept) in enumerate(all_of_them) if kept == here) + by
    while 0 <= number < len(all_of_them):
        place = within(nodes, all_of_them[number][0], gone)
        if not refused(place) and place == all_of_them[number][0]:
            return place
        number += by
    return None


def _places(parent: Node, gone: set[str]) -> Iterator[tuple[Place, tuple[str, int]]]:
    """Every place in what is unfolded: as it counts now, and as it counts without the steps that go."""
    yield Place(parent.id, 0), (parent.id, 0)
    kept = 0
    for child in parent.children:
        if child.id in gone:
            continue
        if child.kind == 1 and not child.folded:
            yield from _places(child, gone)
        kept += 1
        yield Place(parent.id, child.row + 1), (parent.id, kept)


def _parent(node: Node) -> Node:
    if node.parent is None:
        raise LookupError("a section stands in nothing")
    return node.parent
