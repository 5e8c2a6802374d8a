"""The group 2-Letter Code: code written by hand, and comments."""

from __future__ import annotations

import dataclasses as dc

from codegen.fields import Code, Flag, Text, value
from codegen.instructions.instruction import Group, Instruction


@dc.dataclass(frozen=True, kw_only=True)
class TwoLetterCode(Instruction):
    """Code of the controller, word for word."""

    title = "2-Letter Code"
    group = Group.TWO_LETTER
    section = "C/M"
    sentence = "Code: [{text}|…]"
    help = "Adds statements of the controller's own language. They are checked first, and kept as they are."

    text: str = value(Code(label="Code", help="One statement or more, each on a line of its own or joined by ;"), "")

    @classmethod
    def example(cls) -> TwoLetterCode:
        return cls(text="PR 4000;BG X\nAM X")


@dc.dataclass(frozen=True, kw_only=True)
class Comment(Instruction):
    """A remark for the reader of the program."""

    title = "Comment"
    group = Group.CONFIGURATION
    section = "C/M"
    sentence = "'[ {text}]"
    help = "A remark for people. It sends nothing, unless it is asked for in the code as well."

    text: str = value(Text(label="Text", lines=True, required=False, help="What the reader should know."), "")
    in_code: bool = value(Flag(label="Keep in the code", help="Send it as a line that the controller skips."), False)

    @classmethod
    def example(cls) -> Comment:
        return cls(text="Feeds the wire.", in_code=True)
