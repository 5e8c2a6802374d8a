"""Moving by hand, as a jog panel uses it: holding, latched jogs, planned moves, zero and home; one hand at a time.

A jog panel needs no more than this (`motion` is `controller.motion`; nothing here waits, answers come in futures):

* Say once which machine it is: `motion.setup = document.setup`. Its top speeds and limits hold here too.
* Hold-to-run: `motion.hold("X", speed, ac, dc, owner="mouse")` on press, `motion.renew("mouse")` every 50 ms while it
  is held, `motion.release("mouse")` on release, focus loss, hiding, closing. Whoever forgets to renew for 150 ms has
  let go, and has to press again. Another owner is refused as long as the first one holds. The future ends when the
  axis stands, with a `Ran`: `run_on` (counts) and `seconds` from letting go until it stood, to be shown.
* Latched jog: `motion.set_latch(True)` (off at start, and off again after STOP, Watch, a lost line), then
  `motion.run("X", speed, ac, dc, owner="panel")`; ends with `motion.release("panel")`.
* Several axes at speeds that change: `motion.drive({"X": v, "Y": v}, ac, dc, owner="stick")` with ramps by axis, then
  `motion.steer("stick", {…})` whenever the hand moves (0, or not named: that axis stops), `renew` and `release` as
  above. `along` names live values that are read meanwhile. The future ends with a `Drove`.
* `motion.undertake(make)` is for work of several moves in one hand (`device.teach`).
* Everything else is a plan of `device.jog` (`by`, `to`, `line`, `arc`, `home`, `zero`): show `plan.ghost(places)` as
  the marker and `plan.passes(places)` before the start, then `motion.go(plan, owner=…, homed=letters)`. `places` come
  from `motion.look(axes)`, or from the live row (`commanded.x`) with `Places(…).narrowed(setup)`. `go` looks afresh:
  a move that passes a limit, or goes to a place of an axis that is not homed, fails with a `NeedsConfirmation` whose
  text is the question; after a yes `go(plan, confirmed=True)`. `release(owner)` stops it. The future ends with an
  `Ended`.
* `motion.ghost` is where the held axis stops when it is let go now; `motion.busy` what moves by hand, in words.

All of it is refused in Watch, while a question of a program waits or may come, and for axes that a running program
drives. STOP ends everything here; nothing starts again by itself.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import Future
from contextlib import suppress
from functools import partial
from typing import TYPE_CHECKING, Any, TypeVar

from codegen.fields import Dimension
from device.commands import SETTLING
from device.going import Ended, Going
from device.happenings import NoticeKind
from device.jog import Places, Plan, axes_driven, told
from device.lease import COUNTS, EXCHANGE, FLAG, LINE_S, Exchange, Lease, Ran, StopNeeded
from device.poll import requests
from device.quiet import until_stopped
from device.steer import SLOWEST, Drive, Drove, Track
from device.tasks import LinkError, NotAllowed, Priority, Steps, Stopped, Wait

if TYPE_CHECKING:
    from codegen.setup import Setup
    from device.api import Controller

T = TypeVar("T")
G = TypeVar("G", bound="Going")
FEWEST_COLUMNS = 31  # of a poll while somebody holds: one value
SHARE_S = 0.03  # of the line, one way, that a poll may take then
ONE_HAND = "is moved by hand already ({}); let go there first."


class NeedsConfirmation(NotAllowed):
    """The person has to say yes first; the text is what to ask."""


class Motion:
    """Moving by hand; the module's text says how a panel uses it."""

    def __init__(self, controller: Controller) -> None:
        self._c = controller
        self._now: Lease | Going | Drive | None = None
        self._ended: Future[Any] | None = None
        self._settling: Future[Any] | None = None  # speeds and ramps put back behind a STOP
        self.setup: Setup | None = None
        self.taken = self.taken_axis = ""  # why nothing may be moved by hand: an axis is being tuned
        self.latch = False

    # ---------------------------------------------------------------- holding

    def hold(
        self, axis: str, speed_counts_s: float, acceleration: float, deceleration: float, owner: str = ""
    ) -> Future[Ran]:
        """Moves while `renew` is called at least every 150 ms; speed with the sign of the direction, as SP takes it."""
        c = self._c
        if EXCHANGE * c.line.byte_s > LINE_S:
            return refused(f"Not moved: holding needs a faster line than {c.line.baud} baud; move by increments.")
        return self._lease(axis, speed_counts_s, acceleration, deceleration, owner, latched=False)

    def renew(self, owner: str = "") -> None:
        """Goes on holding; to be called every 50 ms."""
        if isinstance(self._now, Lease | Drive) and self._now.owner == owner:
            self._c.used()
            self._now.renew()

    def release(self, owner: str | None = None) -> None:
        """Lets go, or stops the planned move; without an owner whoever it is."""
        if self._now is not None and owner in (None, self._now.owner):
            self._now.release()

    def drive(
        self,
        speeds: Mapping[str, float],
        acceleration: Mapping[str, float],
        deceleration: Mapping[str, float],
        owner: str = "",
        along: Iterable[str] = (),
    ) -> Future[Drove]:
        """Holds the axes that are named, at speeds (counts/s with sign) that `steer` changes; ramps by axis."""
        c, letters = self._c, "".join(speeds)
        problem = self._objection(letters, owner) or self._unsteerable(speeds, acceleration, deceleration)
        if problem:
            return refused(f"Not moved: {problem}")
        exchange = self._exchange()
        tracks = {
            letter: Track(letter, math.trunc(acceleration[letter]), math.trunc(deceleration[letter]), exchange)
            for letter in letters
        }
        columns, poller = exchange.columns, c.poller
        keys = [key for key in poller.ring.columns if key in set(along)]
        drive = Drive(
            tracks, exchange, owner, resting=lambda: next(filter(None, map(self._endangered, letters)), ""),
            one_at_a_time=len(tracks) > 1 and self.alone, along=requests(keys, columns),
            told=lambda values: poller.ring.write(values, c.clock(), keep=poller.wanted()), renewed=c.clock(),
        )  # fmt: skip
        drive.steer(speeds)
        return self._begin(drive, self._driven(drive), Priority.LEASE)

    @property
    def alone(self) -> bool:
        """Whether the line is so slow that a stick moves one axis at a time, the one it is pushed to more."""
        return 2 * EXCHANGE * self._c.line.byte_s > LINE_S

    def steer(self, owner: str, speeds: Mapping[str, float]) -> str:
        """Other speeds for the axes that are driven; why not, or nothing."""
        now = self._now
        if not isinstance(now, Drive) or now.owner != owner or not now.held:
            return "Nothing is driven by this hand."
        problem = next((text for axis in now.axes if (text := self._too_fast(axis, speeds.get(axis, 0.0)))), "")
        if not problem:
            now.steer(speeds)
        return problem

    def _driven(self, drive: Drive) -> Steps[Drove]:
        places = yield from self._look(drive.axes)
        for letter, track in drive.tracks.items():
            track.low, track.high = places.reverse[letter], places.forward[letter]
        return (yield from drive.steps())

    # ----------------------------------------------------------- latched jogs

    def set_latch(self, on: bool) -> None:
        """Whether jogs may go on by themselves; ends the one that runs when it is switched off."""
        self.latch = on and self._c.control
        if not on and isinstance(self._now, Lease) and self._now.latched:
            self._now.release()

    def run(
        self, axis: str, speed_counts_s: float, acceleration: float, deceleration: float, owner: str = ""
    ) -> Future[Ran]:
        """A jog that goes on until `release`, STOP or a limit; needs the latch."""
        if not self.latch:
            return refused("Not moved: switch the latch on to let a jog go on by itself.")
        return self._lease(axis, speed_counts_s, acceleration, deceleration, owner, latched=True)

    def unclaimed(self, what: str) -> None:
        """NotAllowed while an axis is tuned or brought to life: its limits and gains are not its own then."""
        if self.taken:
            raise NotAllowed(f"{what}: {self.taken}")

    def let_go(self, watching: bool = False) -> None:
        """STOP, Watch, another controller: nothing is held and nothing latched any more.

        Watch (a lost line, too) lets nothing be put back: what stays in the controller is told.
        """
        if watching and self.busy and self._now is not None and self._now.as_before:
            before = "; ".join(self._now.as_before)
            self._c.notify(
                NoticeKind.CONTROL,
                f"{self.busy}: let go, and its speeds and ramps stay in the controller. Before it: {before}.",
            )
        self.latch = False
        self.release()

    def last_words(self) -> bytes:
        """What ends it when the line is closed: a stop of what moves by hand, or is tuned or brought to life."""
        now = self._now
        if self.taken and not self._c.door.question:
            return f"ST {self.taken_axis}\r".encode()
        if now is None or not self._busy() or self._c.door.question:
            return b""
        return f"ST {now.axis if isinstance(now, Lease) else now.axes}\r".encode()

    # ---------------------------------------------------------- planned moves

    def look(self, axes: Iterable[str]) -> Future[Places]:
        """Where axes are commanded to be, and the nearer of the limits of controller and setup."""
        return self._c.run(self._look("".join(axes)), Priority.USER, "poll")

    def go(self, plan: Plan, *, owner: str = "", homed: Iterable[str] = (), confirmed: bool = False) -> Future[Ended]:
        """Starts a plan; fails with NeedsConfirmation where a person has to say yes first."""
        problem = plan.problem or self._objection(plan.axes, owner)
        if problem:
            return refused(f"Not moved: {problem}")
        going = Going(plan, owner, self._exchange())
        return self._begin(going, self._checked(going, frozenset(homed), confirmed), Priority.USER)

    def undertake(self, make: Callable[[Exchange, Callable[[str], str]], G]) -> tuple[G, Future[Any]]:
        """Several moves of one hand, made with what they need: refused like one move, ended like one."""
        going = make(self._exchange(), self._endangered)
        problem = going.plan.problem or self._objection(going.plan.axes, going.owner)
        if problem:
            return going, refused(f"Not moved: {problem}")
        return going, self._begin(going, going.steps(), Priority.USER)

    # ------------------------------------------------------------ for display

    @property
    def ghost(self) -> dict[str, int]:
        """Where the held axis stops when it is let go now, counts; empty when nothing is held."""
        now = self._now
        if not self._busy() or now is None or isinstance(now, Going):
            return {}
        return {now.axis: now.ghost} if isinstance(now, Lease) else now.ghost

    @property
    def busy(self) -> str:
        """What moves by hand now, in words, or nothing."""
        now = self._now
        if not self._busy() or now is None:
            return ""
        if isinstance(now, Going):
            return now.plan.title
        return f"axis {now.axis}" if isinstance(now, Lease) else f"axes {' and '.join(now.axes)}"

    # ----------------------------------------------------------------- inside

    def _busy(self) -> bool:
        return self._ended is not None and not self._ended.done()

    def _lease(
        self, axis: str, speed: float, acceleration: float, deceleration: float, owner: str, *, latched: bool
    ) -> Future[Ran]:
        problem = self._objection(axis, owner) or self._unfit(axis, speed, acceleration, deceleration)
        if problem:
            return refused(f"Not moved: {problem}")
        c = self._c
        lease = Lease(
            axis, math.trunc(speed), math.trunc(acceleration), math.trunc(deceleration), self._exchange(),
            latched=latched, resting=partial(self._endangered, axis), owner=owner, renewed=c.clock(),
        )  # fmt: skip
        return self._begin(lease, lease.steps(), Priority.LEASE)

    def _begin(self, now: Lease | Going | Drive, steps: Steps[T], priority: Priority) -> Future[T]:
        """One after the other: the one before is let go and stands first."""
        before = self._ended if self._busy() else None
        self.release()
        self._now = now
        self._c.used()
        future = self._c.run(self._in_turn(now, before, steps), priority, "user")
        self._ended = future
        return future

    def _in_turn(self, now: Lease | Going | Drive, before: Future[Any] | None, steps: Steps[T]) -> Steps[T]:
        while any(each is not None and not each.done() for each in (before, self._settling)):
            yield Wait(0.01)
        if not now.held:
            steps.close()
            raise NotAllowed("Not moved: it was let go before it began.")
        poller = self._c.poller
        poller.brief = 0 if isinstance(now, Going) else self._brief()
        try:
            return (yield from steps)
        except StopNeeded:
            self._c.stop()
            raise
        except Stopped:
            self._settling = self._c.run(self._as_before(now), Priority.USER, SETTLING)
            raise
        finally:
            poller.brief = 0

    def _as_before(self, now: Lease | Going | Drive) -> Steps[None]:
        """Once STOP is proved speeds and ramps are as they were: what runs next may brake by them."""
        with suppress(LinkError):
            yield from until_stopped(self._c)
            yield from now.exchange.put_back(now.as_before)

    def _brief(self) -> int:
        """Columns of a poll while somebody holds: its end must not keep a release waiting."""
        byte_s = self._c.line.byte_s
        return max(FEWEST_COLUMNS, int(SHARE_S / byte_s)) if byte_s else 0

    def _exchange(self) -> Exchange:
        c = self._c
        return Exchange(c.clock, c.nonces, c.model.columns if c.model is not None else 40, c.line.byte_s)

    def _objection(self, axes: str, owner: str) -> str:
        """Why nothing may be moved by hand now."""
        c = self._c
        if not c.control:
            return "this is Watch. Switch to Control first."
        if self.taken:
            return self.taken
        if self._busy() and self._now is not None and self._now.held and self._now.owner != owner:
            return f"{self.busy} {ONE_HAND.format(self._now.owner or 'elsewhere')}"
        missing = [letter for letter in axes if letter not in c.axes]
        if missing:
            return f"this controller has no axis {missing[0]}."
        return next((text for axis in axes if (text := self._endangered(axis))), "")

    def _endangered(self, axis: str) -> str:
        """Why this axis is not ours now: a question waits or may come, or a running program drives it."""
        c = self._c
        if c.resting():
            return c.resting()
        if not c.waiting.position:
            return ""
        listing = c.waiting.listing
        if listing is None:
            return "a program runs whose text is not known. Halt it first."
        if axis in axes_driven(listing.text, c.axes):
            return f"the running program drives axis {axis}. Halt it first."
        return ""

    def _unfit(self, axis: str, speed: float, acceleration: float, deceleration: float) -> str:
        numbers = (speed, acceleration, deceleration)
        if not all(math.isfinite(number) for number in numbers) or math.trunc(speed) == 0:
            return "the speed is no number above 0."
        if acceleration < 1024 or deceleration < 1024:
            return "acceleration and deceleration must be at least 1024 counts/s²."
        return self._too_fast(axis, speed)

    def _unsteerable(
        self, speeds: Mapping[str, float], acceleration: Mapping[str, float], deceleration: Mapping[str, float]
    ) -> str:
        """Why these axes cannot be driven."""
        c = self._c
        if EXCHANGE * c.line.byte_s > LINE_S:
            return f"driving needs a faster line than {c.line.baud} baud; move by increments."
        for axis, speed in speeds.items():
            fastest = math.copysign(max(abs(speed), SLOWEST), speed)  # one that stands now may move later
            if problem := self._unfit(axis, fastest, acceleration[axis], deceleration[axis]):
                return problem
        return "" if speeds else "no axis was named."

    def _too_fast(self, axis: str, speed: float) -> str:
        c = self._c
        if not math.isfinite(speed):
            return "the speed is no number."
        top = float(c.model.servo_max_counts_s) if c.model is not None else math.inf
        if self.setup is not None:
            factor = self.setup.factor(Dimension.SPEED, axis)
            top = min(top, float(self.setup.bounds(Dimension.SPEED, axis)[1] * factor))
        return f"{abs(speed):g} counts/s is above the top speed of axis {axis}, {top:g}." if abs(speed) > top else ""

    def _look(self, axes: str) -> Steps[Places]:
        exchange = self._exchange()
        names = ("RP", "FL", "BL")
        values = yield from exchange.read(*((f"_{name}{axis}", COUNTS) for name in names for axis in axes))
        if values is None:
            raise LinkError("Not moved: the controller did not say where the axes are.")
        count = len(axes)
        parts = [dict(zip(axes, map(int, values[n * count : (n + 1) * count]), strict=True)) for n in range(3)]
        return Places(*parts).narrowed(self.setup)

    def _checked(self, going: Going, homed: frozenset[str], confirmed: bool) -> Steps[Ended]:
        """Looks afresh, then goes."""
        plan = going.plan
        moving = yield from going.exchange.read(*((f"_BG{letter}", FLAG) for letter in plan.axes))
        if moving is None or any(moving):
            raise NotAllowed("Not moved: an axis of it moves already; stop it first.")
        places = yield from self._look(plan.axes)
        if not confirmed:
            unknown = [letter for letter in plan.axes if plan.absolute and letter not in homed]
            if unknown:
                place = told(plan.ghost(places)[unknown[0]], unknown[0], self.setup)
                raise NeedsConfirmation(
                    f"Axis {unknown[0]} was not seen homed: {place} may be anywhere. Move there anyway?"
                )
            if passes := plan.passes(places, self.setup):
                raise NeedsConfirmation(f"{passes} Move anyway?")
        return (yield from going.steps())


def refused(sentence: str) -> Future[Any]:
    """A future that has already failed, with the sentence that says why."""
    future: Future[Any] = Future()
    future.set_exception(NotAllowed(sentence))
    return future
