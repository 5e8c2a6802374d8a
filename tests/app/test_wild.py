"""Random work on the whole studio: nothing crashes, every window has its sentence, a document is what its file is."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.app.wild import Wild
from tests.long import count, record
from tests.stage import Stage

STEPS = count(120, 600)


@pytest.mark.parametrize("seed", range(count(3, 100)))
def test_whatever_is_done_the_studio_stays_up(stage: Stage, tmp_path: Path, seed: int) -> None:
    studio = stage.studio
    crashes: list[str] = []
    studio.crash.happened.connect(lambda text, path: crashes.append(text))
    studio.crash.install()
    wild = Wild(stage, seed, tmp_path)
    stage.connect("simulator", studio.model())
    try:
        for _ in range(STEPS):
            wild.step()
            told = "\n".join(wild.done[-25:])
            assert not crashes, f"seed {seed}, after\n{told}\n{crashes[0]}"
            assert not wild.faults(), f"seed {seed}, after\n{told}\n{wild.faults()}"
    finally:
        wild.end()
        studio.crash.uninstall()
    record("random work on the studio, no fault", "pytest tests/app/test_wild.py", None, STEPS, "steps", add=True)
    kinds = {line.split()[0] for line in wild.done if line.split()}
    assert {"click", "act", "add", "write", "press_key", "command", "happen"} <= kinds
