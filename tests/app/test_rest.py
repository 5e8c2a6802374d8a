"""While live values rest (a program asks a question) nothing old is shown as if it were so now."""

from __future__ import annotations

from tests.stage import Stage


def test_nothing_is_called_stopped_that_may_move_by_now(stage: Stage) -> None:
    stage.question()
    stage.later(8.0)
    stage.go()
    studio = stage.studio
    shown = " ".join(label.text() for label in (studio.window.status.program, studio.window.status.position))
    assert "Thread 0: not known" in shown
    assert "s old" in shown
    words = studio.display.words()
    assert "? unknown" in words
    assert "■ stopped" not in words
    assert "not running" not in words
    assert studio.program.delegate.executing == {}
