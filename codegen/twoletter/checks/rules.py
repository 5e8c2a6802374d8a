"""All rules by name."""

from __future__ import annotations

from codegen.twoletter.checks.meaning_rules import MEANING
from codegen.twoletter.checks.syntax_rules import SYNTAX
from codegen.twoletter.problems import Rule, by_name

RULES: dict[str, Rule] = by_name(SYNTAX + MEANING)
SYNTAX_RULES: frozenset[str] = frozenset(rule.name for rule in SYNTAX)
