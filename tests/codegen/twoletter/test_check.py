"""Checks: every rule by its own snippets, exact places, and programs of the manual without false alarms."""

from __future__ import annotations

import time

import pytest

from codegen.models import model
from codegen.twoletter.check import check
from codegen.twoletter.checks.rules import RULES, SYNTAX_RULES
from codegen.twoletter.problems import ERROR_TEXTS, NO_BITS, STOP_TEXTS, TB_BITS, TS_BITS, Problem, Rule

EVERY = [pytest.param(rule, id=rule.name) for rule in RULES.values()]


def rules_of(source: str, name: str) -> list[str]:
    """The names of the rules a source breaks."""
    return [problem.rule for problem in check(source, model(name))]


@pytest.mark.parametrize("rule", EVERY)
def test_the_bad_snippet_breaks_the_rule(rule: Rule) -> None:
    found = [problem for problem in check(rule.bad, model(rule.model)) if problem.rule == rule.name]
    assert found
    assert all(problem.severity == rule.severity for problem in found)
    assert all(
        "{"
        not in problem.message.replace("{F", "")
        .replace("{$", "")
        .replace("{S", "")
        .replace("{^", "")
        .replace("{P", "")
        .replace("{N", "")
        for problem in found
    )


@pytest.mark.parametrize("rule", EVERY)
def test_the_good_snippet_has_no_problem_at_all(rule: Rule) -> None:
    assert check(rule.good, model(rule.model)) == []


@pytest.mark.parametrize("rule", EVERY)
def test_a_rule_says_it_in_a_sentence(rule: Rule) -> None:
    assert rule.message.endswith(".") or rule.message.endswith("{instead}.") or rule.message.endswith("_{name}?")
    assert rule.code == 0 or rule.code in ERROR_TEXTS
    assert rule.severity == "error" or rule.name not in SYNTAX_RULES


def place(source: str, name: str = "ssc4") -> list[tuple[str, int, str]]:
    """Rule, line and the text marked."""
    lines = source.split("\n")
    return [(each.rule, each.line, lines[each.line][each.column : each.end]) for each in check(source, model(name))]


def test_places_mark_the_text_in_question() -> None:
    source = "#A\nPR 1;SP 9000000 ;JS #B\nV1=A+2*3\nEN"
    assert place(source) == [
        ("out-of-range", 1, "9000000"),
        ("missing-label", 1, "#B"),
        ("mixed-operators", 2, "A+2*3"),
        ("unassigned", 2, "A"),
    ]


def test_messages_name_value_limit_and_reading() -> None:
    found = check("#A\nA=1\nSP 9000000\nV1=A+2*3\nOP 300\nMT 3\nEN", model("ssc4"))
    assert [problem.message for problem in found] == [
        "9000000 is out of range for SP: 0 to 8000000 counts/s.",
        "The controller reads strictly from left to right: (A+2)*3. Brackets make it clear.",
        "300 is out of range for OP: 0 to 255 byte.",
        "3 is out of range for MT: one of 1, -1, 2, -2, 2.5, -2.5.",
    ]
    assert [problem.code for problem in found] == [6, 0, 6, 6]


@pytest.mark.parametrize(
    ("expression", "warned"),
    [
        ("A*B+C", False),
        ("A+B*C", True),
        ("A-B+C", False),
        ("A/B*C", False),
        ("-955*@SIN[A]+B", False),
        ("A+(B*C)", False),
        ("(A+B*C)", True),
        ("@ABS[A+B*C]", True),
        ("A|B&C", True),
        ("A&B|C", False),
        ("A&B+C", True),
    ],
)
def test_operator_order(expression: str, warned: bool) -> None:
    source = f"#X\nA=1;B=1;C=1\nR={expression}\nEN"
    assert ("mixed-operators" in rules_of(source, "ssc4")) == warned


@pytest.mark.parametrize(
    ("condition", "warned"),
    [
        ("A<B", False),
        ("A*B<=B*C", False),  # l.2928
        ("(A<B)&(B<C)", False),
        ("A<B&B<C", True),
        ("A=1&B", True),
        ("A<B<C", True),
    ],
)
def test_comparisons(condition: str, warned: bool) -> None:
    source = f"#X\nA=1;B=1;C=1\nJP #X,{condition}\nEN"
    assert ("comparisons" in rules_of(source, "ssc4")) == warned


@pytest.mark.parametrize(
    ("source", "name", "rules"),
    [
        ("#A\nST\nAM\nEN", "dmc1412", []),  # bare ST goes on in a DMC-141x program
        ("#A\nST\nEN", "ssc1", []),
        ("#A\nST;AM\nEN", "ssc1", ["bare-stop"]),
        ("#A\nPRX=5\nEN", "dmc1412", []),  # l.783
        ("#A\nEM 1500,6000;EP 2000,0;ET[0]=0\nEN", "dmc1412", []),  # l.1811: slave, master
        ("#A\nPR 1,2\nEN", "dmc1412", ["axis-not-on-model"]),
        ("#A\nV1=_TPY\nEN", "ssc1", ["axis-not-on-model"]),
        ("#A\nGA DY;GR 1\nEN", "ssc2", []),
        ("#A\nGA DZ;GR 1\nEN", "ssc2", ["axis-not-on-model"]),
        ("#A\nV1=@IN[9]\nEN", "ssc1", ["out-of-range"]),
        ("#A\nV1=@IN[8]\nEN", "dmc1412", ["out-of-range"]),
        ("#A\nAI 0\nEN", "ssc1", ["out-of-range"]),
        ("#A\nTM -1\nEN", "ssc1", []),
        ("#A\nTM 250\nEN", "ssc4", ["out-of-range"]),
        ("#A\nPF 10.4;PF-8.2;VF 2.2\nEN", "ssc1", []),
        ("#A\nPF 10.5\nEN", "ssc1", ["out-of-range"]),
        ("#A\nXQ #B,2\nEN\n#B\nEN", "dmc1412", ["out-of-range"]),
        ("#A\nLM XY\nLI 1,2<9000000\nLE\nEN", "ssc2", ["out-of-range"]),
        ("#A\nJP #A;EN", "ssc1", []),  # l.2985
        ("#A\nIF (1)\nPRA=5\nYA 5\nEN", "ssc1", ["later-command", "later-assignment", "later-command"]),
        ("#A\nACC=5;AC ACC\nEN", "ssc1", []),
        ("REM one\n'two\n#A\nEN", "ssc1", []),
        ("#A\nBA X;BM 1333.333;BI 5;BZ -2;BZX=-1\nEN", "dmc1412", []),
        ("#A\nBZ -2\nEN", "dmc1414", ["not-on-model"]),
        ("#A\nLM 1\nEN", "dmc1412", ["not-on-model"]),  # it has no LM, whatever follows
        ("#A\nLM 1\nEN", "ssc4", ["bad-argument"]),
        ("#A\nPR 1;BG X;PR ,5;BG Y\nEN", "ssc2", []),
        ("#A\nPR 1;BG;PR ,5\nEN", "ssc2", ["still-moving"]),
        ("#A\nPR 1;BG X;ST X;PR 2\nEN", "ssc2", ["still-moving"]),
        ("#A\nJG 4;BG;JG 6;DC 2048\nEN", "ssc1", []),
        ("#A\nPR 1;BG;BG\nEN", "ssc1", ["still-moving"]),
        ("#A\nPR 1;BG;PR ?;IP 5;SP 10\nEN", "ssc1", []),
        ("#A\nPR 1;BG;AD 1;PR 5\nEN", "ssc1", []),
        ("#A\nPR1000\nBGX\nPR5000\nEN", "dmc1412", ["still-moving"]),  # l.2711: error 7 on line 3
        ("#A\nCI ,2\nEN", "dmc1412", ["routine-missing"]),
        ("#A\nCI -1;CI 0,0,1;II 0\nEN", "dmc1412", []),
        ("#A\nLM XY\n#B\nLI 10,10\nJP #B,@IN[1]=0\nLE;BGS;AMS\nEN", "ssc2", []),  # filled in a loop
        ("#A\nVM XY\nJS #S\nBGS;AMS\nEN\n#S\nVP 1,1;VE\nEN", "ssc2", []),  # closed in a subroutine
        ("#A\nLM XY;LI 1,1;LE;BGS;AMS;LI 2,2;LE;BGS\nEN", "ssc2", []),  # LM need not be repeated
        ("#A\nLM ?\nEN", "ssc2", []),
        ("#A\nVM XY\nVP 1,1\nVM XY\nVP 1,1;VE;BGS\nEN", "ssc2", ["sequence-open"]),
        ("#A\nCR 100,0,90;CR 100,90,90\nEN", "ssc2", ["segment-alone"]),
        ("#A\nJS #B\n#B\nSB 1\nEN", "ssc1", ["runs-into"]),
        ("#A\nJP #A\n#B\nSB 1\n#LIMSWI\nRE", "ssc1", []),  # nothing comes to B
        ("#A\nSB 1\n#LIMSWI\nRE", "ssc1", ["runs-into"]),
        ("#A\nJS #B\nEN\n#B\nSB 1\n#C\nSB 2\nEN\n#D\nJS #C\nEN", "ssc1", []),  # two ways into one end
        ("#A\nXQ #B,1\nSB 2\n#B\nSB 1\nEN", "ssc1", []),  # a thread, not a subroutine
        ("#A\nII 1\n#L;JP #L\n#ININT\nZS\nJP #A", "ssc1", []),
        ("#A\nII 1\n#L;JP #L\n#ININT\nJP #A", "ssc1", ["stack-grows"]),
        ("#A\nJS #B\nEN\n#B\nJS #C\nEN\n#C\nJS #B,@IN[1]=0\nEN", "ssc1", ["calls-itself", "calls-itself"]),
        ("", "ssc4", []),
        ("#A\nEN", "smartmotor", []),
    ],
)
def test_models_decide(source: str, name: str, rules: list[str]) -> None:
    assert rules_of(source, name) == rules


# Programs of dmc-1412-1414.txt, corrected where the scan is damaged: no errors, and only the warnings given.
MANUAL = {
    "multitasking l.2644": (
        "#TASK1\nAT0\nCB1\n#LOOP1\nAT 10\nSB1\nAT -40\nCB1\nJP #LOOP1\n"
        "#TASK2\nXQ #TASK1,1\n#LOOP2\nPR 1000\nBGX\nAMX\nWT 10\nJP #LOOP2,@IN[2]=1\nHX",
        [],
    ),
    "trip l.2803": (
        "#TRIP\nJG 50000\nBG;n=0\n#REPEAT\nAR 10000\nTP\nSB1\nWT50\nCB1\nn=n+1\nJP #REPEAT,n<5\nST\nEN",
        [],
    ),
    "terminal l.3586": (
        "#AUTO\nSPEEDX=10000\nCI ,2\nJG SPEEDX\nBGX\n#PRINT\n"
        'MG{P2}"TO CHANGE SPEEDS"\nMG{P2}"TYPE X"\nMG{P2}"TYPE S TO STOP"\n#JOGLOOP\nJG SPEEDX\nJP #JOGLOOP\nEN\n'
        '#COMINT\nCI,0\nJP #A,P2CH="X"\nJP #B,P2CH="S"\nZS1;CI,2;JP#JOGLOOP\n#A;JS#NUM\nSPEEDX=VAL\n'
        'ZS1;CI,2;JP#PRINT\n#B;ST;AMX;CI,-1\nMG{P2}"THE END"\nZS;EN,1\n'
        '#NUM\nMG "ENTER",P2CH{S},"AXIS SPEED"{N}\n#NUMLOOP;CI,-1\n#NMLP\nJP #NMLP,P2CD<2\nJP #ERROR,P2CD=2\n'
        'VAL=P2NM\nEN\n#ERROR;CI,-1\nMG "INVALID-TRY AGAIN"\nJP #NMLP\nEN',
        [],
    ),
    "cam l.1898": (
        "#SETUP\nEM 1000,2000\nEP 20,0\nN = 0\n#LOOP\nP = N*3.6\nS = @SIN[P]*100\nX = N * 10 + S\nET[N] = X\n"
        "N = N+1\nJP #LOOP, N<=100\nEN\n#RUN\nEB1\nPA500\nSP5000\nBGX\nAMX\nAI1\nEG 1000\nAI -1\nEQ 1000\nEN",
        [],
    ),
    "dual loop l.2266": (
        "#DUALOOP\nCE 0\nDE0\nPR 40000\nBG\n#Correct\nAM\nV1=10000-_DE\nV2=-_TE/4+V1\nJP#END,@ABS[V2]<2\n"
        "PR V2*4\nBG\nJP#Correct\n#END\nEN",
        [],
    ),
    "brushless l.781": ("#A\nSH\nPRX=-1*(_BZX)\nBG\nAM\nBZX=-1\nEN", []),
    "command error l.3069": (
        '#BEGIN\nIN "ENTER SPEED", SPEED\nJG SPEED;BG;\nJP #BEGIN\nEN\n#CMDERR\nJP#DONE,_ED<>2\nJP#DONE,_TC<>6\n'
        'MG "SPEED TOO HIGH"\nMG "TRY AGAIN"\nZS1\nJP #BEGIN\n#DONE\nZS0\nEN',
        ["still-moving"],  # fault of the manual: a second valid speed is answered by error 21
    ),
    "string apart l.3128": (
        '#TEST\nIN "ENTER",LEN{S6}\nFLEN=@FRAC[LEN]\nFLEN=$10000*FLEN\nLEN1=(FLEN&$00FF)\nLEN2=(FLEN&$FF00)/$100\n'
        "LEN3=LEN&$000000FF\nLEN4=(LEN&$0000FF00)/$100\nLEN5=(LEN&$00FF0000)/$10000\nLEN6=(LEN&$FF000000)/$1000000\n"
        "MG LEN6 {S4}\nMG LEN5 {S4}\nMG LEN4 {S4}\nMG LEN3 {S4}\nMG LEN2 {S4}\nMG LEN1 {S4}\nEN",
        [],
    ),
    "record l.3451": (
        "#RECORD\nDM XPOS[300]\nDM XERR[300]\nRA XPOS[],XERR[]\nRD _TP, _TE\nPR 10000\nRC1\nBG\n"
        '#A;JP #A,_RC=1\nMG "DONE"\nEN\n'
        "#PLAY\nN=0\n#NEXT\nJP# DONE,N>299\nN=\nXPOS[N]=\nXERR[N] =\nN=N+1\nJP #NEXT\n#DONE\nEN",
        [],
    ),
    "cut to length l.3503": (
        '#BEGIN\nAC 800000\nDC 800000\nSP 5000\nLEN=3.4\n#CUT\nAI1\nIN "enter Length(IN)", LEN\nPR LEN *4000\nBG\nAM\n'
        "SB1\nWT100;CB1\nJP #CUT\nEN",
        [],
    ),
    "limit switches l.4193": (
        "#A;JP #A;EN\n#LIMSWI\nV1=_LF\nV2=_LR\nJP#LF,V1=0\nJP#LR,V2=0\nJP#END\n#LF\n"
        'MG "FORWARD LIMIT"\nST;AM\nPR-1000;BG;AM\nJP#END\n#LR\nMG "REVERSE LIMIT"\nST;AM\nPR1000;BG;AM\n#END\nRE',
        [],
    ),
    "input interrupt l.3030": (
        "#A\nII1\nJG 30000\nBG\n#LOOP;JP#LOOP;EN\n#ININT\nST;AM\n#TEST;JP #TEST, @IN[1]=0\nJG 30000\nBG;RI",
        [],
    ),
    "teach l.2074": (
        "#RECORD\nDM POS[501]\nRA POS[]\nRD_TP\nMO\nRC2\n#A;JP#A,_RC=1\n#COMPUTE\nDM DX[500]\nC=0\n#L\nD=C+1\n"
        "DELTA=POS[D]-POS[C]\nDX[C]=DELTA\nC=C+1\nJP #L,C<500\n#PLAYBCK\nSHA\nCM\nDT2\nI=0\n#B\nCD DX[I];WC\nI=I+1\n"
        "JP #B,I<500\nDT 0;CD0\nEN",
        ["too-many-elements"],  # 1001 of 1000 elements
    ),
}


@pytest.mark.parametrize("name", MANUAL)
def test_programs_of_the_manual(name: str) -> None:
    source, rules = MANUAL[name]
    assert rules_of(source, "dmc1412") == rules


def test_problems_come_in_the_order_of_the_text_and_once() -> None:
    found = check("#A\nQQ;WW;JS #B;JS #B\nEN", model("ssc1"))
    assert found == sorted(found, key=lambda each: (each.line, each.column))
    assert len(set(found)) == len(found) == 4


def test_tables_of_codes_and_bits() -> None:
    assert ERROR_TEXTS[22] == "Begin not possible due to limit switch"
    assert ERROR_TEXTS[1] == "Unrecognized command" and ERROR_TEXTS[112] == "BZ command timeout"
    assert STOP_TEXTS[99] == "MC timeout"
    assert set(TS_BITS) == set(TB_BITS) == set(range(8)) and set(NO_BITS) == set(range(16))


def test_a_program_of_1000_lines_is_checked_while_typing() -> None:
    lines = ["#A", "N=0"] + [f"PR {number};SP {number * 2};BG X;AM X;N=N+{number}" for number in range(997)] + ["EN"]
    check("\n".join(lines), model("ssc4"))
    lines[500] = "PR N*2"
    before = time.thread_time()
    assert check("\n".join(lines), model("ssc4")) == []
    assert time.thread_time() - before < 1.0  # about 40 ms; the bound only catches the memo going missing


def test_problems_are_values() -> None:
    assert Problem("x", "error", 1, 2, 3, "m") == Problem("x", "error", 1, 2, 3, "m")
