"""The facts by which an action is allowed or not, gathered once per tick and compared as one value."""

from __future__ import annotations

from dataclasses import dataclass

from device.api import Badge, Kind, State


@dataclass(frozen=True)
class Facts:
    """What is the case right now."""

    kind: Kind = Kind.OFFLINE
    state: State = State.OFFLINE
    control: bool = False
    prompt: bool = False
    busy: str = ""  # what is being done with the controller's memory: "Downloading"
    badge: Badge = Badge.UNKNOWN
    steps: int = 0
    dirty: bool = False

    @property
    def connected(self) -> bool:
        return self.state is State.READY and self.kind is not Kind.OFFLINE


# A need answers why something is not possible now; empty when it is.


def connected(facts: Facts) -> str:
    """A controller that answers."""
    if facts.kind is Kind.OFFLINE:
        return "Connect a controller or start the simulator first."
    if facts.state is State.CONNECTING:
        return "Still connecting; a moment please."
    if facts.state is not State.READY:
        return f"The controller does not answer ({facts.state.value})."
    return ""


def live(facts: Facts) -> str:
    """Something that can be read, not a recording."""
    return connected(facts) or ("A recording can only be watched." if facts.kind is Kind.REPLAY else "")


def control(facts: Facts) -> str:
    """Permission to change something."""
    return live(facts) or ("" if facts.control else "This is Watch: switch to Control first.")


def quiet(facts: Facts) -> str:
    """Nothing else is going on with the controller's memory, and no program waits for an answer."""
    if facts.busy:
        return f"{facts.busy}; wait for it or cancel it."
    return "The program waits for an answer; answer it or stop it first." if facts.prompt else ""


def something(facts: Facts) -> str:
    """A program with at least one instruction."""
    return "" if facts.steps else "The program is empty: add an instruction first."


def is_online(facts: Facts) -> str:
    """Some connection, also a lost one, that can be closed."""
    return "Nothing is connected." if facts.kind is Kind.OFFLINE else ""
