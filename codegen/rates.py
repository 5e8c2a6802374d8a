"""Baud rates a controller can be set to, and what has to be switched for each."""

from __future__ import annotations

from codegen.models import Model

# rate: (switch 2 "1200", switch 3 "9600", switch 4 "19.2K"); Tol-O-Motion manual, chapter 5, l.1518-1526
RATES: dict[int, tuple[bool, bool, bool]] = {
    300: (True, True, False),
    1200: (True, False, False),
    4800: (True, False, True),
    9600: (False, True, False),
    19200: (False, False, True),
    38400: (False, True, True),
}
SWITCHES = ("MRST", "1200", "9600", "19.2K", "HSHK")
# rate: (jumper "9600", jumper "38.4K"); dmc-1412-1414.txt l.477-481
JUMPERS: dict[int, tuple[bool, bool]] = {
    1200: (True, True),
    9600: (True, False),
    19200: (False, False),
    38400: (False, True),
}


def switch_words(rate: int, handshake: bool = True) -> str:
    """The DIP switches of an SSC for a rate, in words; HSHK is on where RTS/CTS is used."""
    on = (*RATES[rate], handshake)
    return ", ".join(f"{name} {'ON' if set_ else 'OFF'}" for name, set_ in zip(SWITCHES[1:], on, strict=True))


def jumper_words(rate: int) -> str:
    """The jumpers of a DMC-1412 or DMC-1414 for a rate, in words; nothing where they have none for it."""
    if rate not in JUMPERS:
        return ""
    first, second = JUMPERS[rate]
    return f"jumper 9600 {'set' if first else 'open'}, jumper 38.4K {'set' if second else 'open'}"


def setting_words(rate: int, model: Model | None, handshake: bool = True) -> str:
    """How a controller is set to a rate: of the type it is, or of both where that is not known."""
    if rate not in RATES:
        return ""
    ssc, dmc = f"switches {switch_words(rate, handshake)}", jumper_words(rate)
    if model is not None:
        return ssc if model.family == "ssc" else dmc
    return f"SSC: {ssc}" + (f"; DMC-1412/1414: {dmc}" if dmc else "")
