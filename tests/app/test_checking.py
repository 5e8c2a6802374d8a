"""Code is checked one text at a time, and of those that came meanwhile only the newest."""

from __future__ import annotations

import sys
import threading
import time

import pytest

from app import checking
from app.checking import Checked, Checking
from codegen.models import MODELS, Model

SSC = MODELS["ssc1"]


def test_of_texts_that_came_meanwhile_only_the_newest_is_checked(monkeypatch: pytest.MonkeyPatch) -> None:
    may_end, begun, told = threading.Event(), list[str](), list[str]()

    def slowly(text: str, model: Model) -> Checked:
        begun.append(text)
        may_end.wait(10)
        return Checked(text, model, names=whole("", model).names, problems=())

    whole, turns = checking.checked, sys.getswitchinterval()
    monkeypatch.setattr(checking, "checked", slowly)
    check = Checking(lambda found: told.append(found.text))
    for text in ("ONE", "TWO", "THREE"):
        check.ask(text, SSC)
    assert told == [] and check.knows("THREE", SSC) is None
    may_end.set()
    end = time.monotonic() + 10
    while check.knows("THREE", SSC) is None and time.monotonic() < end:
        check.look()
        time.sleep(0.001)
    assert (begun, told) == (["ONE", "THREE"], ["THREE"])  # what was overtaken is not shown either
    assert check.knows("THREE", MODELS["ssc4"]) is None  # for another controller it is not known
    assert sys.getswitchinterval() == pytest.approx(turns)
