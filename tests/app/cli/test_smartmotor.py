"""`twoletter compile --controller smartmotor`: what is written, and what is refused with instruction and step."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.__main__ import main
from codegen import files
from codegen.document import Document
from codegen.instructions import Comment, Instruction, MotionParameters, Output, SingleAxisMove, StopMotion
from codegen.instructions.motion import WaitFor, Which
from codegen.program import Program, Step
from codegen.setup import Axis, Setup, Unit

SAMPLE_S = 245.76e-6  # smartmotor-4.76.txt, RSP: 24576 times 10 ns
TURNS = Setup().with_axis("X", Axis(unit=Unit.OWN, unit_name="turns", counts_per_unit="2000"))


def program(tmp_path: Path, *instructions: Instruction) -> str:
    steps = tuple(Step(f"s{number}", each) for number, each in enumerate(instructions))
    path = tmp_path / "p.tlp"
    path.write_text(files.dumps(Document(program=Program(name="P", main=steps), setup=TURNS)), encoding="utf-8")
    return str(path)


def test_a_program_of_what_it_knows(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = program(
        tmp_path,
        Comment(text="there", in_code=True),
        MotionParameters(speed=("2", "", "", ""), acceleration=("25", "", "", "")),
        SingleAxisMove(distance="10"),
        StopMotion(which=Which.EVERYTHING),
    )
    assert main(["compile", path, "--controller", "smartmotor"]) == 0
    # smartmotor-4.76.txt: counts/sample × 65536, counts/sample² × 65536
    speed, acceleration = round(2 * 2000 * SAMPLE_S * 65536), round(25 * 2000 * SAMPLE_S**2 * 65536)
    expected = ["'there", f"A={acceleration}", f"V={speed}", "MP", "D=20000", "G", "TWAIT", "X", "END"]
    assert capsys.readouterr().out.splitlines() == expected
    out = tmp_path / "p.sms"
    assert main(["compile", path, "--controller", "smartmotor", "-o", str(out)]) == 0
    assert out.read_text().splitlines() == expected


@pytest.mark.parametrize(
    ("instruction", "words"),
    [
        (Output(), "not written for a SmartMotor yet"),
        (SingleAxisMove(distance="10", deceleration="5"), "Deceleration is not written"),
        (SingleAxisMove(distance="10", wait=WaitFor.POSITION), "waiting for the position"),
        (SingleAxisMove(distance="LEN"), ""),
        (SingleAxisMove(axis="Y", distance="10"), ""),
        (SingleAxisMove(distance=""), ""),
        (StopMotion(which=Which.PATH), "has no path"),
    ],
)
def test_the_rest_is_refused_by_a_sentence(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], instruction: Instruction, words: str
) -> None:
    path = program(tmp_path, StopMotion(), instruction)
    assert main(["compile", path, "--controller", "smartmotor"]) == 2
    said = capsys.readouterr()
    assert said.out == "" and said.err.count("\n") == 1
    assert f"step 2 of the main section, {instruction.title}: " in said.err and words in said.err


def test_no_map(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = program(tmp_path, StopMotion())
    assert main(["compile", path, "--controller", "smartmotor", "--map", str(tmp_path / "m.json")]) == 2
    assert "--map" in capsys.readouterr().err
