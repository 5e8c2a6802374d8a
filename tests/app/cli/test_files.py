"""compile, check, import and demo: calls that work on files."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from app.__main__ import main
from codegen import files
from codegen.document import Document
from codegen.files import load
from codegen.generate import generate
from codegen.instructions import AutoExecution, Jump, Label, Output, SingleAxisMove, Subroutine, TwoLetterCode
from codegen.program import Program, Step
from codegen.setup import Axis, Setup, Unit
from codegen.twoletter.format import format_statement
from codegen.twoletter.parse import parse
from resources import path as resource

CUTTER = str(resource("examples/wire-cutter.tlp"))
# spec/instructions, "An example, whole"; dmc-1412-1414.txt l.4025-4035
CUTTER_CODE = [
    "#CUTTER",
    "AC 254976",
    "DC 254976",
    "#A",
    "AI 1",
    "PR 6370",
    "SP 3184",
    "BG X",
    "AM X",
    "SB 1",
    "WT 20",
    "CB 1",
    "WT 80",
    "JP #A",
    "EN",
]
Said = pytest.CaptureFixture[str]
Write = Callable[[str, str], str]


@pytest.fixture
def write(tmp_path: Path) -> Write:
    """Writes a file and returns its path."""

    def make(name: str, text: str) -> str:
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        return str(path)

    return make


def one_line_error(said: Said) -> str:
    """The error text, which must be one line of ours."""
    text = said.readouterr().err
    assert text.startswith("twoletter: ") and text.count("\n") == 1, text
    return text


def test_compile_writes_the_code_of_the_wire_cutter(capsys: Said) -> None:
    assert main(["compile", CUTTER]) == 0
    assert capsys.readouterr().out.splitlines() == CUTTER_CODE


def test_compile_into_a_file_with_a_map(tmp_path: Path, capsys: Said) -> None:
    out, where = tmp_path / "cutter.dmc", tmp_path / "map.json"
    assert main(["compile", CUTTER, "-o", str(out), "--map", str(where)]) == 0
    assert out.read_text().splitlines() == CUTTER_CODE
    lines = json.loads(where.read_text())["lines"]
    assert [each["text"] for each in lines] == CUTTER_CODE
    assert lines[5]["step"] == lines[8]["step"] != lines[9]["step"]
    assert lines[0]["step"] == ""
    assert capsys.readouterr().out == ""


@pytest.mark.parametrize("option", ["-o", "--map"])
def test_compile_never_writes_onto_a_program(option: str, tmp_path: Path, capsys: Said) -> None:
    own, other = tmp_path / "own.tlp", tmp_path / "other.tlp"
    own.write_text(Path(CUTTER).read_text())
    linked = tmp_path / "linked.dmc"
    linked.symlink_to(own)
    for place in (own, other, linked):
        assert main(["compile", str(own), option, str(place)]) == 2
        assert "choose another name" in one_line_error(capsys)
    assert own.read_text() == Path(CUTTER).read_text() and not other.exists()


def test_compile_writes_nothing_while_a_step_is_wrong(write: Write, tmp_path: Path, capsys: Said) -> None:
    out = tmp_path / "o.dmc"
    path = write("w.tlp", Path(CUTTER).read_text().replace('"time": "20"', '"time": ""'))
    assert main(["compile", path, "-o", str(out)]) == 1
    assert "missing" in one_line_error(capsys) and not out.exists()


def test_compile_compact_joins_lines(capsys: Said) -> None:
    assert main(["compile", CUTTER, "--compact"]) == 0
    text = capsys.readouterr().out
    statements = [format_statement(each) for _, each in parse(text).statements()]
    assert statements == [format_statement(each) for _, each in parse("\n".join(CUTTER_CODE)).statements()]
    assert len(text.splitlines()) < len(CUTTER_CODE)


def test_compile_for_another_controller(capsys: Said) -> None:
    assert main(["compile", CUTTER, "--controller", "dmc1412"]) == 0
    assert capsys.readouterr().out.splitlines()[0] == "#CUTTER"


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("missing.tlp", None, "no such file"),
        ("broken.tlp", "{ not json", "broken.tlp"),
        ("other.tlp", '{"format": "something else"}', "other.tlp"),
        ("source.dmc", "EN\n", "not a program"),
    ],
)
def test_files_that_can_not_be_compiled(name: str, text: str | None, words: str, write: Write, capsys: Said) -> None:
    path = write(name, text) if text is not None else name
    assert main(["compile", path]) == 2
    assert words in one_line_error(capsys).lower()


def test_check_counts_from_one_as_editors_do(write: Write, capsys: Said) -> None:
    path = write("bad.dmc", "#A\nSP 99999999\nJP #NONE\nEN\n")
    assert main(["check", path]) == 1
    rows = capsys.readouterr().out.splitlines()
    assert any(row.startswith(f"{path}:2:4: error out-of-range ") for row in rows), rows
    assert any(row.startswith(f"{path}:3:4: error ") and "NONE" in row for row in rows), rows


def test_check_as_json(write: Write, capsys: Said) -> None:
    path = write("bad.dmc", "#A\nSP 99999999\nEN\n")
    assert main(["check", path, "--json"]) == 1
    rows = json.loads(capsys.readouterr().out)
    found = next(row for row in rows if row["severity"] == "error")
    assert (found["file"], found["line"], found["column"], found["end"]) == (path, 2, 4, 12)
    assert found["code"] and found["message"]


def test_advice_about_steps_has_codes_like_the_findings_of_the_source(write: Write, capsys: Said) -> None:
    setup = Setup(model="ssc4").with_axis("X", Axis(unit=Unit.MM, counts_per_unit="100"))
    loop = (Label(name="A"), SingleAxisMove(distance="1.003"), SingleAxisMove(distance="-LEN"), Jump(target="A"))
    main_ = tuple(Step(f"s{place}", each) for place, each in enumerate(loop))
    path = write("drifts.tlp", files.dumps(Document(Program("P", main=main_), setup)))
    assert main(["check", path, "--json"]) == 0
    found = {row["code"]: row["message"] for row in json.loads(capsys.readouterr().out)}
    assert found["drift"] == "This loop drifts: X by -3 mm in 1000 turns"
    assert "rounds it down" in found["rounded-down"]


def test_check_is_content_with_good_files(write: Write, capsys: Said) -> None:
    assert main(["check", CUTTER, write("good.dmc", "#A\nPR 1000\nBGX\nAMX\nEN\n")]) == 0
    assert ": error " not in capsys.readouterr().out


def test_check_knows_the_limits_of_the_controller(write: Write, capsys: Said) -> None:
    path = write("wide.dmc", "#A\nV1=1;V2=2;V3=3;V4=4;V5=5;V6=6;V7=7;V8=8;V9=9\nEN\n")
    assert main(["check", path]) == 0
    assert main(["check", path, "--controller", "dmc1412"]) == 1
    assert ":2:" in capsys.readouterr().out


def test_smartmotor_source_is_refused_with_a_sentence(write: Write, capsys: Said) -> None:
    assert main(["check", write("motor.sms", "P=100\nG\n")]) == 2
    assert "SmartMotor" in one_line_error(capsys)


SOURCE = """#AUTO
#CUT
AC 254976
REM the loop
#A
AI 1
PR 6370
SP 3184
BGX
AMX
SB1
WT 20;CB1
JS #COUNT
JP #A
EN
#COUNT
N=N+1
EN
#LIMSWI
MG "LIMIT"
RE
"""


def test_import_recognises_what_it_can(write: Write, tmp_path: Path, capsys: Said) -> None:
    out = tmp_path / "cut.tlp"
    assert main(["import", write("cut.dmc", SOURCE), "-o", str(out), "--controller", "ssc1"]) == 0
    document = load(out)
    kinds = [type(step.instruction) for step in document.program.steps()]
    assert document.program.name == "CUT" and kinds[0] is AutoExecution
    for kind in (Label, SingleAxisMove, Output, Jump, Subroutine):
        assert kind in kinds, kind
    assert TwoLetterCode not in kinds
    assert [step.instruction.label for step in document.program.routines] == ["COUNT", "LIMSWI"]  # type: ignore[attr-defined]
    assert "steps" in capsys.readouterr().out


def statements(text: str) -> list[str]:
    """What a source says, in one spelling: one-axis BG and AM name their axis, RE says 0, remarks are the host's."""
    spelled = {"BG": "BG X", "AM": "AM X", "RE": "RE 0", "RI": "RI 0"}
    lines = [format_statement(each) for _, each in parse(text).statements()]
    return [spelled.get(line, line) for line in lines if line and not line.startswith(("REM", "'"))]


@pytest.mark.parametrize(
    "text",
    [
        SOURCE,
        "#CUT\nPR 100\nBG\nAM\nEN\n",
        '#CUT\nN=0\n#B\nN=N+1\nJP #B,N<10\nPR 1,2\nMG "A;B",N{F4.0}\nEN\n',
        '#CUT\nIN "LENGTH",LEN\nPR LEN*4000\nSP 20000\nAC 1024\nBGX\nEN\n#CMDERR\nZS1\nJP #END\n#END\nEN\n',
    ],
)
def test_import_loses_nothing(text: str, write: Write, tmp_path: Path, capsys: Said) -> None:
    out = tmp_path / "cut.tlp"
    assert main(["import", write("cut.dmc", text), "-o", str(out), "--controller", "ssc1"]) == 0
    made = statements(generate(load(out)).text)
    wanted = statements(text)
    assert made in (wanted, [*wanted, "EN"]), "\n".join(made)
    assert "cut.tlp" in capsys.readouterr().out


def test_import_takes_en_1_for_the_end_of_the_communication_interrupt(
    write: Write, tmp_path: Path, capsys: Said
) -> None:
    """EN,1 and EN0,1 both re-enable it (dmc-1412-1414.txt l.3610, l.5371)."""
    out = tmp_path / "cut.tlp"
    text = "#CUT\nCI ,2\n#L\nJP #L\nEN\n#COMINT\nWT 5\nEN,1\n"
    assert main(["import", write("cut.dmc", text), "-o", str(out), "--controller", "dmc1412"]) == 0
    document = load(out)
    assert [step.instruction.label for step in document.program.routines] == ["COMINT"]  # type: ignore[attr-defined]
    assert statements(generate(document).text)[-3:] == ["#COMINT", "WT 5", "EN 0,1"]
    capsys.readouterr()


def test_a_lone_carriage_return_ends_a_line(write: Write, capsys: Said) -> None:
    path = write("cr.dmc", "#A\rPR 100\rPR 99999999999\rEN\r")
    assert main(["check", path]) == 1
    assert capsys.readouterr().out.startswith(f"{path}:3:4: error ")


def test_import_does_not_overwrite(write: Write, tmp_path: Path, capsys: Said) -> None:
    out = write("cut.tlp", "mine")
    assert main(["import", write("cut.dmc", SOURCE), "-o", out]) == 2
    assert "exists" in one_line_error(capsys)
    assert Path(out).read_text() == "mine"


def test_demo_shows_program_code_timeline_and_picture(tmp_path: Path, capsys: Said) -> None:
    picture = tmp_path / "demo.svg"
    assert main(["demo", "-o", str(picture)]) == 0
    text = capsys.readouterr().out
    assert "Move X by 10 in at 5 in/s, then wait until the profile has ended" in text
    assert "\n".join(CUTTER_CODE) in text
    for words in (
        "input 1 on",
        "X has come to 6370 counts",
        "output 1 on",
        "output 1 off",
        "X has come to 12740 counts",
    ):
        assert words in text, words
    assert "commanded 12740 (20 in)" in text
    assert picture.read_text().startswith("<svg ") and picture.read_text().count("<polyline") == 4
