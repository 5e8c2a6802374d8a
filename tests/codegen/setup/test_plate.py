"""The type plates of an SSC, as the manual's table has them."""

from __future__ import annotations

import pytest

from codegen.setup import Axis, MotorType, Setup
from codegen.setup_plate import plate_problem, read_plate, with_plate

# ssc-tol-o-motion.txt l.733-762; the part number of SSC46 with a servo on X is misprinted there (3600-0147)
TABLE = """
SSC10 ST - - - 3600-0110
SSC10 SV - - - 3600-0210
SSC21 ST ST - - 3600-0121
SSC21 SV ST - - 3600-0221
SSC22 ST SV - - 3600-0122
SSC22 SV SV - - 3600-0222
SSC31 ST ST ST - 3600-0131
SSC31 SV ST ST - 3600-0231
SSC32 ST ST SV - 3600-0132
SSC32 SV ST SV - 3600-0232
SSC33 ST SV ST - 3600-0133
SSC33 SV SV ST - 3600-0233
SSC34 ST SV SV - 3600-0134
SSC34 SV SV SV - 3600-0234
SSC41 ST ST ST ST 3600-0141
SSC41 SV ST ST ST 3600-0241
SSC42 ST ST ST SV 3600-0142
SSC42 SV ST ST SV 3600-0242
SSC43 ST ST SV ST 3600-0143
SSC43 SV ST SV ST 3600-0243
SSC44 ST ST SV SV 3600-0144
SSC44 SV ST SV SV 3600-0244
SSC45 ST SV ST ST 3600-0145
SSC45 SV SV ST ST 3600-0245
SSC46 ST SV ST SV 3600-0146
SSC47 ST SV SV ST 3600-0147
SSC47 SV SV SV ST 3600-0247
SSC48 ST SV SV SV 3600-0148
SSC48 SV SV SV SV 3600-0248
"""
ROWS = [line.split() for line in TABLE.strip().splitlines()]
SERVO = {"ST": False, "SV": True}


@pytest.mark.parametrize("row", ROWS, ids=[row[-1] for row in ROWS])
def test_code_and_part_number_tell_what_the_table_says(row: list[str]) -> None:
    code, *kinds, part = row
    servos = tuple(SERVO[kind] for kind in kinds if kind != "-")
    plate, by_part = read_plate(code), read_plate(part)
    assert plate is not None and by_part is not None
    assert (plate.code, plate.model, plate.servos) == (code, f"ssc{len(servos)}", (None, *servos[1:]))
    assert (by_part.code, by_part.model, by_part.servos) == (code, f"ssc{len(servos)}", servos)


@pytest.mark.parametrize("text", ["SSC11", "SSC20", "SSC23", "SSC30", "SSC35", "SSC40", "SSC49", "SSC50", "SSC1",
                                  "SSC474", "3600-0347", "3600-0235", "٤٧", "SSC4٧"])  # fmt: skip
def test_what_is_in_no_row_of_the_table_is_refused_with_a_sentence(text: str) -> None:
    assert read_plate(text) is None
    assert text in plate_problem(text) and "SSC10 to SSC48" in plate_problem(text)


def test_an_empty_plate_is_no_problem_and_writing_differs() -> None:
    assert plate_problem("") == plate_problem("  ") == ""
    codes = [read_plate(text) for text in ("ssc47", "SSC-47", " SSC 47 ")]
    assert [each.code for each in codes if each is not None] == ["SSC47"] * 3


def test_a_plate_sets_model_and_motors_and_keeps_a_polarity_that_fits() -> None:
    setup = Setup(model="ssc1").with_axis("Y", Axis(motor=MotorType.SERVO_REVERSED, smoothing="12"))
    plate = read_plate("3600-0147")  # ST SV SV ST
    assert plate is not None
    new = with_plate(setup, plate)
    assert new.model == "ssc4"
    assert [new.axis(letter).is_stepper for letter in "XYZW"] == [True, False, False, True]
    assert new.axis("Y") == setup.axis("Y")


def test_the_misprint_of_the_manual_is_told() -> None:
    plate = read_plate("3600-0147")
    assert plate is not None and "SSC46" in plate.words and "The manual prints" in plate.words


def test_the_words_say_what_the_plate_does_not() -> None:
    plate = read_plate("SSC10")
    assert plate is not None and "X a servo or a stepper" in plate.words and "part number tells X" in plate.words
