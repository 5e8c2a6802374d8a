"""Judges what came of sine commutation: the answer to BS, the zero by BZ, the phase by the halls."""

from __future__ import annotations

import re

from codegen.numbers import parse_number
from codegen.twoletter.problems import ERROR_TEXTS
from device.commissioning.judge import FAILED, PASSED, TURN_THE_PHASES, Moved, move_facts
from device.commissioning.record import Finding

FIELD_ADVICE = {
    110: ("The hall inputs show 0 or 7, which no sensors give: check their supply and the first input (BI).",),
    111: ("The axis is not set up as a brushless one (BA).",),
    112: ("It did not come to rest in time: a little less voltage, or more friction on the axis.",),
    113: ("It did not move: enable, power and both phase wires (ACMD, ACMD2)? Then more voltage.",),
    114: ("It ran away: the phases are exchanged, or BM is wrong. Test the phases again.",),
}


def judge_phases(answer: str, cycle: str) -> Finding:
    """What BS answered. No manual prints its words: what is not recognised is left to the person."""
    lines = tuple(line.strip(" :\r") for line in answer.splitlines() if line.strip(" :\r"))
    facts = tuple((f"Answer {number}", line) for number, line in enumerate(lines, 1))
    said = " ".join(lines).lower()
    if not lines or "no movement" in said:
        return Finding(FAILED, "The motor did not move when its phases were driven.", FIELD_ADVICE[113], facts)
    if wrong := [line for line in lines if "wrong" in line.lower()]:
        return Finding(
            FAILED, f"The controller says: {'; '.join(wrong)}.", ("Switch the power off, put it right.",), facts
        )
    wanted, found = parse_number(cycle), re.search(r"\bBM\b\D*([0-9.]+)", " ".join(lines))
    if wanted and found is not None and abs(float(found[1]) / float(wanted) - 1) > 0.1:
        words = (
            f"The magnetic cycle is about {found[1]} counts, not {cycle}: the counts of a turn or the poles are wrong."
        )
        return Finding(FAILED, words, ("Type the right counts of one magnetic cycle (BM).",), facts)
    return Finding(PASSED, f"The controller says: {'; '.join(lines)}.")


def judge_halls(moved: Moved, before: int, after: int) -> Finding:
    """Whether the phase was set at a hall transition during the move."""
    facts = (*move_facts(moved), ("Hall inputs", f"{before} before, {after} after"))
    if before in (0, 7) or after in (0, 7):
        return Finding(FAILED, "The hall inputs show a state that no sensors give.", FIELD_ADVICE[110], facts)
    if moved.tripped or moved.bounded:
        return Finding(FAILED, "The axis did not follow while its phase was set.", TURN_THE_PHASES, facts)
    if before == after:
        words = "The hall inputs did not change on the way, so the phase was not set."
        return Finding(FAILED, words, ("Is the magnetic cycle (BM) right? Are all three sensors wired?",), facts)
    return Finding(PASSED, "The phase was set where the hall sensors changed. The motor is off.", (), facts)


def judge_zero(accepted: bool, code: int, counts: int | None) -> Finding:
    """How BZ ended."""
    facts = (("Counts to phase zero", "?" if counts is None else str(counts)),)
    if accepted:
        return Finding(
            PASSED, "The motor stands at commutation zero, and its phase is set. The motor is off.", (), facts
        )
    words = f"Commutation zero was not found: error {code}, {ERROR_TEXTS.get(code, 'unknown error')}."
    return Finding(FAILED, words, FIELD_ADVICE.get(code, ()), facts)
