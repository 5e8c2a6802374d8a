"""Studios that are killed while they edit and save: `python -m tests.app.killing FOLDER COUNT AUTOSAVE_MS SEED`.

Each life is a fork of this process, so that it begins within milliseconds; it runs the session of the studio with its
timers. What was done and saved is told through a pipe, which outlives it.
"""

from __future__ import annotations

import dataclasses as dc
import os
import random
import select
import signal
import sys
import time
from pathlib import Path

from PySide6.QtCore import QCoreApplication, QTimer

from app.in_use import user_of
from app.recovery import Recovery
from app.session import Session
from codegen import files
from codegen.document import Document
from codegen.instructions import Wait
from codegen.program import Program, Step

STEPS = 60
ALLOWED_S = 2.0
PAUSES_MS = (0, 1, 5, 20)  # from one edit to the next
EDIT_S = sum(PAUSES_MS) / len(PAUSES_MS) / 1000  # on average
PATIENCE_S = 20.0


def program(number: int) -> Document:
    """A document whose description and steps all hold the same number."""
    steps = tuple(Step(f"s{place}", Wait(time=str(number + 1))) for place in range(STEPS))
    return Document(Program("LIFE", description=str(number), main=steps))


def number_of(document: Document) -> int:
    """The number, after making sure that the document is one whole state."""
    number = int(document.program.description)
    assert document == program(number), f"a document of several states: {number}"
    return number


def live(path: Path, recovery: Path, pipe: int, autosave_ms: int, seed: int) -> None:
    """Edits and saves until it is killed."""
    chance = random.Random(seed)
    saves = chance.choice((0, 0.02, 0.1))  # how often; who saves seldom needs the copy
    application = QCoreApplication([])
    session = Session(recovery_folder=recovery, autosave_ms=autosave_ms)
    session.open(path)

    def work() -> None:
        number = int(session.document.program.description) + 1
        session.set_document(program(number), "Edit")
        tell(f"e {number} {time.monotonic()}")
        if chance.random() < saves:
            tell(f"b {number} 0")
            session.save()
            tell(f"s {number} 0")
        timer.start(chance.choice(PAUSES_MS))

    def tell(words: str) -> None:
        os.write(pipe, f"{words}\n".encode())

    timer = QTimer(singleShot=True)
    timer.timeout.connect(work)
    timer.start(0)
    application.exec()


@dc.dataclass(frozen=True)
class Told:
    """What a life told: edits with their time, saves begun and saves done."""

    edits: dict[int, float]
    begun: list[int]
    saved: list[int]


def told(data: bytes) -> Told:
    lines = [line.split() for line in data.decode().split("\n")[:-1]]  # the last may be half
    edits = {int(number): float(when) for kind, number, when in lines if kind == "e"}
    return Told(edits, *([int(number) for kind, number, _ in lines if kind == each] for each in "bs"))


def one(folder: Path, autosave_ms: int, chance: random.Random) -> tuple[float, bool]:
    """One life and what is left of it: how many seconds of editing are lost, and whether the copy was needed."""
    path, recovery = folder / "life.tlp", folder / "recovery"
    start = number_of(files.load(path))
    reading, writing = os.pipe()
    child = os.fork()
    if not child:
        os.close(reading)
        try:
            live(path, recovery, writing, autosave_ms, chance.randrange(10**9))
        finally:
            os._exit(1)
    os.close(writing)
    began = lived(reading, chance.uniform(0, 0.05 + 2.5 * autosave_ms / 1000) / EDIT_S)
    time.sleep(chance.uniform(0, 2 * EDIT_S))  # anywhere between two edits, or in one
    os.kill(child, signal.SIGKILL)
    killed = time.monotonic()
    _, status = os.waitpid(child, 0)
    assert os.WIFSIGNALED(status), "it ended by itself"
    found = told(began + _all(reading))
    return judge(path, recovery, found, start, killed)


def lived(pipe: int, edits: float) -> bytes:
    """What a life tells until it has made so many edits, however long a busy computer lets it wait for each."""
    data = b""
    while data.count(b"e ") <= edits:
        assert select.select([pipe], [], [], PATIENCE_S)[0], "it does not live"
        data += os.read(pipe, 65536)
    return data


def judge(path: Path, recovery: Path, found: Told, start: int, killed: float) -> tuple[float, bool]:
    """The file is the last saved or the one being saved; with the copy kept aside at most the last moments are lost."""
    there = number_of(files.load(path))
    last = max([start, *found.saved])
    assert last <= there <= max([last, *found.begun]), f"the file is neither the old nor the new one: {there}"
    keeper = Recovery(recovery)
    left = keeper.found()
    kept = max([there, *(number_of(each.document) for each in left)])
    for each in left:
        assert each.belongs_to(path)
        keeper.forget(each)
    keeper.close()
    assert user_of(path) == "", "the dead still have the file"
    lost = [when for number, when in found.edits.items() if number > kept]
    return killed - min(lost) if lost else 0.0, kept > there


def _all(pipe: int) -> bytes:
    data = b""
    while part := os.read(pipe, 65536):
        data += part
    os.close(pipe)
    return data


def main(folder: Path, count: int, autosave_ms: int, seed: int) -> float:
    """The longest stretch of editing that was lost, in seconds."""
    files.save(folder / "life.tlp", program(0))
    chance = random.Random(seed)
    worst, helped = 0.0, 0
    for _ in range(count):
        lost, by_copy = one(folder, autosave_ms, chance)
        worst, helped = max(worst, lost), helped + by_copy
        assert worst <= ALLOWED_S, f"{worst:.2f} s of editing lost"
    assert number_of(files.load(folder / "life.tlp")) > count // 2  # they did live and save
    assert helped > count // 10  # and the copy did bring work back that the file did not have
    return worst


if __name__ == "__main__":
    print(main(Path(sys.argv[1]), *map(int, sys.argv[2:5])))
