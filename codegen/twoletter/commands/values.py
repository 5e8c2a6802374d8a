"""Keywords and functions of expressions, operands that can be recorded, and commands of later controllers."""

from __future__ import annotations

from codegen.twoletter.rows import DMC141X, FunctionRow, KeywordRow

KEYWORD_ROWS: tuple[KeywordRow, ...] = (
    KeywordRow(name="TIME", title="Clock", help="Samples since power-up or reset.", example="V1=TIME"),
    KeywordRow(
        name="P1CH",
        title="Last character of port 1",
        help="The last character received in data mode, as a one-character string.",
        example='JP #A,P1CH="X"',
        is_string=True,
    ),
    KeywordRow(
        name="P1ST",
        title="Last string of port 1",
        help="The last string ended by Enter; reading it clears P1CD.",
        example="V1=P1ST",
        is_string=True,
    ),
    KeywordRow(
        name="P1NM",
        title="Last number of port 1",
        help="The last number ended by Enter; reading it clears P1CD.",
        example="PR P1NM",
    ),
    KeywordRow(
        name="P1CD",
        title="Input status of port 1",
        help="-1 data mode off, 0 nothing, 1 character, 2 string, 3 number received.",
        example="JP #A,P1CD<>3",
    ),
    KeywordRow(
        name="P2CH",
        title="Last character of port 2",
        help="The last character received on port 2, as a one-character string.",
        example='JP #A,P2CH="X"',
        is_string=True,
    ),
    KeywordRow(
        name="P2ST",
        title="Last string of port 2",
        help="The last string ended by Enter; reading it clears P2CD.",
        example="V1=P2ST",
        is_string=True,
    ),
    KeywordRow(
        name="P2NM",
        title="Last number of port 2",
        help="The last number ended by Enter; reading it clears P2CD.",
        example="PR P2NM",
    ),
    KeywordRow(
        name="P2CD",
        title="Input status of port 2",
        help="-1 data mode off, 0 nothing, 1 character, 2 string, 3 number received.",
        example="JP #A,P2CD<>3",
    ),
    *(
        KeywordRow(
            name=f"F{number}",
            title=f"Function key {number}",
            help=f"The character the terminal sends for key F{number} (code {21 + number}).",
            example=f"JP #A,P2CH=F{number}",
            is_string=True,
        )
        for number in range(1, 6)
    ),
)

FUNCTION_ROWS: tuple[FunctionRow, ...] = (
    FunctionRow(name="SIN", title="Sine", help="Sine of an angle in degrees.", example="V1=@SIN[30]", unit="deg"),
    FunctionRow(name="COS", title="Cosine", help="Cosine of an angle in degrees.", example="V1=@COS[60]", unit="deg"),
    FunctionRow(name="ABS", title="Absolute value", help="The value without its sign.", example="V1=@ABS[V2]"),
    FunctionRow(
        name="INT",
        title="Integer part",
        help="The value without its fraction.",
        example="V1=@INT[2.5]",
        profile="negative values are cut towards zero (inferred)",
        confidence="medium",
    ),
    FunctionRow(
        name="FRAC",
        title="Fraction part",
        help="The value without its integer part; keeps the sign.",
        example="V1=@FRAC[2.5]",
        profile="sign of negative values (inferred)",
        confidence="medium",
    ),
    FunctionRow(name="RND", title="Rounded", help="The nearest integer; .5 goes up.", example="V1=@RND[2.5]"),
    FunctionRow(
        name="SQR",
        title="Square root",
        help="The square root.",
        example="V1=@SQR[2]",
        profile="a negative argument gives the root of its absolute value (recall)",
        confidence="medium",
    ),
    FunctionRow(
        name="COM",
        title="Complement",
        help="All 32 integer bits inverted.",
        example="V1=@COM[255]",
        families=DMC141X,
        profile="documented for the DMC-141x only",
        confidence="medium",
    ),
    FunctionRow(
        name="IN",
        title="Input",
        help="1 while the input is high, 0 while it is low.",
        example="JP #A,@IN[1]=0",
        pure=False,
        low=1,
        high=8,
        step=1,
        high_from="inputs",
    ),
    FunctionRow(
        name="OUT",
        title="Output",
        help="1 while the output is on, 0 while it is off.",
        example="JP #A,@OUT[1]=0",
        pure=False,
        low=1,
        high=8,
        step=1,
        high_from="outputs",
        families=DMC141X,
        profile="documented for the DMC-141x only",
        confidence="medium",
    ),
    FunctionRow(
        name="AN",
        title="Analog input",
        help="The voltage at the analog input.",
        example="V1=@AN[1]",
        pure=False,
        unit="V",
        low=1,
        high=7,
        step=1,
    ),
)

# What RD can record (dmc-1412-1414.txt l.3423-3436; _AF: SSC manual).
RECORDABLE: frozenset[str] = frozenset(["DE", "TP", "TE", "SH", "RL", "TI", "OP", "TS", "SC", "NO", "TT", "AF"])

_OPTIMA = "DMC-1600/1700/1800 and later"
_ACCELERA = "DMC-18x6/21x3/40x0 and later"
_SINCE_OPTIMA = "VV HS DR IA IH IK MB MW QR QZ SY WH LO CF CO"
_SINCE_ACCELERA = "PT PV BT PW SI SS SD TK YA YB YC YR YS EY EI LB LC LD NB NF NZ SL"

# Commands of later controllers of the same language: where they appear (recall).
LATER: dict[str, str] = {
    "IF": _OPTIMA,
    "ELSE": _OPTIMA,
    "ENDIF": _OPTIMA,
    **dict.fromkeys(_SINCE_OPTIMA.split(), _OPTIMA),
    **dict.fromkeys(_SINCE_ACCELERA.split(), _ACCELERA),
}
