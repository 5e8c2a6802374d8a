"""How many lines a command's answer has is known only where the controller really answers with as many."""

from __future__ import annotations

import pytest

from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.parse import parse_line
from device.proof import TELLING, lines_told
from tests.device.simulator.bench import Bench

PROGRAM = "#A\nN=1\nM=2\nMG N\nWT 100\nJP #A\nEN"  # several lines and names to list
SETUP = "DM A[3];N=5;K=6;BA X;BM 2000\r"
FORMS = ("{}", "{} X", "{} ?", "{} A[0],3", "{} 1", "{}X=2,100")


@pytest.mark.parametrize("model", ["ssc4", "dmc1412"])
def test_every_answer_has_as_many_lines_as_are_counted(model: str) -> None:
    compared = set()
    for name in sorted(TELLING | set(COMMANDS)):
        for line in (form.format(name) for form in FORMS):
            count = lines_told(parse_line(line).statements)
            if count is None:
                continue
            bench = Bench(model)
            bench.load(PROGRAM)
            bench.type(SETUP)
            answer = bench.type(line + "\r", 1000 if name == "BS" else 20)  # which turns the field
            if answer.endswith("\r\n:"):  # neither refused nor silent, nor the beginning of a dialogue
                compared.add(name)
                assert answer.count("\r\n") == count, (line, answer)
    assert {"MG", "TP", "TE", "TB", "TC"} <= compared


def test_what_tells_as_much_as_there_is_is_not_counted() -> None:
    for line in ("LS", "LA", "LV", "UL", "QU A[0],3", "BSX=2,700", "MG N;LS", 'MG "A",{^13},"B"'):
        assert lines_told(parse_line(line).statements) is None, line
