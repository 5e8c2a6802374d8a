"""Communication, recording, and what the machine's setup holds."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from codegen.fields import PerAxisText
from codegen.instructions.limits import FollowingError, Integrator, MotorDisable, PositionLimits, TorqueLimit
from codegen.instructions.machine import Encoder, Motor
from codegen.instructions.records import (
    OF_AXIS,
    Communication,
    Interrupting,
    Link,
    PortMode,
    RecordData,
    UserSetup,
)
from codegen.instructions.servo import FeedForward, PidGains
from codegen.numbers import parse_number
from codegen.setup import Axis
from codegen.twoletter.calls import Statement, listed, numbers
from codegen.twoletter.emit import machine
from codegen.twoletter.emit.build import Build, raw
from codegen.twoletter.emit.motion import smoothing

CODES = {Interrupting.NONE: 0, Interrupting.LINE: 1, Interrupting.CHARACTER: 2, Interrupting.CLEAR: -1}


def communication(link: Communication, build: Build) -> Iterator[Statement]:
    if link.what is Link.PORT:
        chain = link.mode is PortMode.CHAIN
        echo = int(link.echo and not chain)
        yield numbers("CC", int(link.baud.value), int(link.handshake), int(chain), echo)
    else:
        yield numbers("CI", CODES[link.first], CODES[link.second], int(link.live))


def record_data(record: RecordData, build: Build) -> Iterator[Statement]:
    """Arrays that are made here, then which, what, and how often (negative: over and over)."""
    for row in record.recordings:
        if row.size.strip():
            yield listed("DM", f"{row.array.strip()}[{raw(row.size)}]")
    yield listed("RA", *(f"{row.array.strip()}[]" for row in record.recordings))
    yield listed(
        "RD", *(f"_{row.source.value}{row.axis if row.source in OF_AXIS else ''}" for row in record.recordings)
    )
    exponent = int(record.interval.value)
    count = parse_number(record.values if record.endless else record.count)
    if count is None:
        yield numbers("RC", exponent)
    else:
        yield numbers("RC", exponent, -int(count) if record.endless else int(count))


def user_setup(chosen: UserSetup, build: Build) -> Iterator[Statement]:
    """Each part as its own instruction would send it."""
    setup = build.setup

    def texts(of: Callable[[Axis], str], servo: bool = False) -> PerAxisText:
        x, y, z, w = (
            of(setup.axis(letter)) if letter in setup.letters and not (servo and setup.axis(letter).is_stepper) else ""
            for letter in "XYZW"
        )
        return x, y, z, w

    if chosen.motors:
        yield from machine.motor(Motor(types=texts(lambda axis: axis.motor.value)), build)
    if chosen.encoders:
        yield from machine.encoder(Encoder(main=texts(lambda axis: axis.main_encoder.value)), build)
    if chosen.pid:
        gains = PidGains(
            proportional=texts(lambda axis: axis.kp, True),
            integral=texts(lambda axis: axis.ki, True),
            derivative=texts(lambda axis: axis.kd, True),
        )
        yield from machine.pid_gains(gains, build)
    if chosen.feed_forward:
        ahead = FeedForward(velocity=texts(lambda axis: axis.fv, True), acceleration=texts(lambda axis: axis.fa, True))
        yield from machine.feed_forward(ahead, build)
    if chosen.smoothing:
        for letter, text in zip("XYZW", texts(lambda axis: axis.smoothing), strict=True):
            if text:
                yield smoothing(letter, text, build)
    if chosen.limits:
        yield from _limits(texts, build)


def _limits(texts: Callable[..., PerAxisText], build: Build) -> Iterator[Statement]:
    positions = PositionLimits(
        forward=texts(lambda axis: axis.forward_limit), reverse=texts(lambda axis: axis.reverse_limit)
    )
    yield from machine.position_limits(positions, build)
    error = FollowingError(error=texts(lambda axis: axis.error_limit, True))
    if any(error.error):
        yield from machine.following_error(error, build)
    switches = MotorDisable(axes=texts(lambda axis: "on" if axis.off_on_error else "off", True))
    if any(switches.axes):
        yield from machine.motor_disable(switches, build)
    yield from machine.torque_limit(TorqueLimit(limit=texts(lambda axis: axis.torque_limit, True)), build)
    yield from machine.integrator(Integrator(limit=texts(lambda axis: axis.integrator_limit, True)), build)
