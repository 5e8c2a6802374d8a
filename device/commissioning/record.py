"""What was found of one axis: kept beside the other data, and taken up again where it was left."""

from __future__ import annotations

import dataclasses as dc
import json
import re
from collections.abc import Mapping
from enum import StrEnum
from pathlib import Path

from codegen.disk import save_text
from device.commissioning.steps import BY_KEY, Step

SUFFIX = ".commissioning"


class Verdict(StrEnum):
    """How a step stands."""

    OPEN = "open"
    PASSED = "passed"
    FAILED = "failed"
    SKIPPED = "skipped"


@dc.dataclass(frozen=True, slots=True)
class Finding:
    """What came of one step: a sentence, what to do, and the figures behind it."""

    verdict: Verdict = Verdict.OPEN
    sentence: str = ""
    advice: tuple[str, ...] = ()
    facts: tuple[tuple[str, str], ...] = ()
    when: str = ""

    @property
    def done(self) -> bool:
        return self.verdict in (Verdict.PASSED, Verdict.SKIPPED)


@dc.dataclass(frozen=True, slots=True)
class Record:
    """One axis of one controller; a change makes a new one."""

    axis: str
    model: str
    serial: int = 0
    sine: bool = False
    error: int = 0  # counts: the error limit with which it came to its target
    findings: Mapping[str, Finding] = dc.field(default_factory=dict)
    typed: Mapping[str, str] = dc.field(default_factory=dict)  # what stands in the fields, by step and name

    def of(self, key: str) -> Finding:
        """What is known of a step."""
        return self.findings.get(key, Finding())

    def found(self, key: str, finding: Finding) -> Record:
        """With what came of a step; steps that were judged on top of it are open again where it failed."""
        findings = {**self.findings, key: finding}
        if not finding.done:
            for later in _after(key):
                findings.pop(later, None)
        return dc.replace(self, findings=findings)

    def text(self, step: str, name: str, usual: str = "") -> str:
        """What was typed there."""
        return self.typed.get(f"{step}.{name}", usual)

    def with_text(self, step: str, name: str, text: str) -> Record:
        return dc.replace(self, typed={**self.typed, f"{step}.{name}": text})

    def missing(self, step: Step, steps: tuple[Step, ...]) -> str:
        """What has to be done before this step, as a sentence, or nothing."""
        there = {each.key for each in steps}
        first = [BY_KEY[key].title for key in step.needs if key in there and not self.of(key).done]
        return f"First: {', '.join(first)}." if first else ""

    def at(self, steps: tuple[Step, ...]) -> int:
        """The step to go on with: the first that is not done."""
        return next((place for place, step in enumerate(steps) if not self.of(step.key).done), len(steps) - 1)

    @property
    def name(self) -> str:
        """The file it is kept in."""
        return f"{re.sub(r'[^a-z0-9]', '', self.model)}-{self.serial}-{self.axis}{SUFFIX}"


def _after(key: str) -> set[str]:
    """Every step that builds on this one."""
    found: set[str] = set()
    todo = {key}
    while todo:
        todo = {each.key for each in BY_KEY.values() if todo & set(each.needs)} - found
        found |= todo
    return found


def keep(record: Record, folder: Path) -> str:
    """Writes it; a sentence where that was not possible."""
    told = {
        **{name: getattr(record, name) for name in ("axis", "model", "serial", "sine", "error")},
        "findings": {key: dc.asdict(finding) for key, finding in record.findings.items()},
        "typed": dict(record.typed),
    }
    try:
        folder.mkdir(parents=True, exist_ok=True)
        save_text(folder / record.name, json.dumps(told, indent=1) + "\n")
    except OSError as failure:
        return f"The findings cannot be kept in {folder} ({failure.strerror or failure})."
    return ""


def resumed(folder: Path, axis: str, model: str, serial: int) -> Record:
    """What was kept of this axis; a fresh record where nothing was, or where it cannot be read."""
    fresh = Record(axis, model, serial)
    try:
        told = json.loads((folder / fresh.name).read_text(encoding="utf-8"))
        findings = {str(key): _finding(each) for key, each in told["findings"].items() if key in BY_KEY}
        typed = {str(name): str(text) for name, text in told["typed"].items()}
        error = int(told.get("error", 0))
        return dc.replace(fresh, sine=told["sine"] is True, error=error, findings=findings, typed=typed)
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return fresh


def _finding(told: Mapping[str, object]) -> Finding:
    """One finding as it was written; raises where it is none."""
    advice, facts = told["advice"], told["facts"]
    if not isinstance(advice, list) or not isinstance(facts, list):
        raise TypeError("no lists")
    pairs = tuple((str(name), str(text)) for name, text in facts)
    verdict, sentence = Verdict(str(told["verdict"])), str(told["sentence"])
    return Finding(verdict, sentence, tuple(map(str, advice)), pairs, str(told["when"]))
