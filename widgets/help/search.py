"""Which pages of the help belong to words that somebody types, and where in a page they stand."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field

LONGEST_PHRASE = 3  # words
WHOLE = 3  # a whole word counts more than any place of the beginning of one
OFTEN = 9  # as often as this counts


@dataclass(frozen=True)
class Word:
    """One word, or a phrase, with what the pages may say in its place."""

    spellings: tuple[str, ...]
    pattern: re.Pattern[str] = field(init=False)  # its beginning; the group "whole" tells that it is all of it

    def __post_init__(self) -> None:
        stems = "|".join(re.escape(_stem(each)) for each in self.spellings)
        made = rf"(?<![a-z0-9])(?:{stems})(?P<whole>(?:e?s)?(?![a-z0-9]))?"
        object.__setattr__(self, "pattern", re.compile(made, re.IGNORECASE))

    def weight(self, text: str) -> int:
        """0 where it is not, 1 for its beginning, more for all of it."""
        ends = [found["whole"] is not None for found in self.pattern.finditer(text)]
        return 0 if not ends else 1 + WHOLE * any(ends)


def words_of(text: str, also: Mapping[str, tuple[str, ...]]) -> list[Word]:
    """What was typed, word by word; `also` holds what the pages say for words and phrases of daily life."""
    left, found = text.lower().split(), []
    while left:
        length = next(n for n in range(LONGEST_PHRASE, 0, -1) if n == 1 or " ".join(left[:n]) in also)
        word = " ".join(left[:length])
        found.append(Word((word, *also.get(word, also.get(_stem(word), ())))))
        del left[:length]
    return found


def pages_with(words: list[Word], pages: Mapping[str, str]) -> list[str]:
    """Titles of the pages that hold every word: whole words first, then those in a title, then in a heading."""
    weights = {title: [_place(word, title, text) for word in words] for title, text in pages.items()}
    found = [title for title, each in weights.items() if all(each)]
    return sorted(found, key=lambda title: (-sum(weights[title]), title.lower()))


def _place(word: Word, title: str, text: str) -> float:
    """How much a page is about a word: where it stands, then how often; 0 when it is not in it."""
    if not (inside := word.weight(text)):
        return 0
    headings = "\n".join(line for line in text.splitlines()[1:] if line.startswith("#"))
    places = ((2, word.weight(title)), (1, word.weight(headings)), (0, inside))
    often = min(OFTEN, sum(1 for _ in word.pattern.finditer(text))) / (OFTEN + 1)
    return max(weight + bonus for bonus, weight in places if weight) + often


def _stem(word: str) -> str:
    return word[:-1] if len(word) > 3 and word.endswith("s") and not word.endswith("ss") else word
