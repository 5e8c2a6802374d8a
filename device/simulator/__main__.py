"""`python -m device.simulator`: a simulated controller in real time, on a socket or a pseudo-terminal.

The line is announced before the simulation is loaded; what a client sends meanwhile waits in it.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from codegen.models import MODELS, Model
from device.simulator.eeprom import EepromUnreadable, read_eeproms
from device.simulator.lines import open_line, open_second
from device.simulator.server import MOST_IN_CHAIN, maker, serve
from device.simulator.uart_faults import Fault

if TYPE_CHECKING:
    from device.simulator.plant import Plant
    from device.simulator.server import Served
    from device.simulator.twoletter.profile import Profile


class Unusable(Exception):
    """An option that names an unusable file; the text is one sentence."""


def arguments(parser: argparse.ArgumentParser) -> None:
    """The options of a served simulator."""
    parser.add_argument("--controller", default="ssc4", metavar="MODEL", help=" ".join(two_letter_models()))
    parser.add_argument("--plant", type=Path, metavar="PLANT.toml", help="what is bolted to the controller")
    parser.add_argument("--tcp", metavar="HOST:PORT", help="where to listen; port 0 picks one")
    parser.add_argument("--pty", action="store_true", help="a pseudo-terminal instead of a socket")
    parser.add_argument("--baud", type=int, metavar="N", help="pace the line to N baud")
    parser.add_argument("--no-handshake", action="store_true", help="characters that come too fast are lost (error 5)")
    parser.add_argument("--eeprom", type=Path, metavar="FILE", help="where burned data is kept")
    parser.add_argument("--chain", type=int, metavar="N", help="N controllers in a daisy chain")
    parser.add_argument("--port2", metavar="HOST:PORT|pty", help="port 2 as a line of its own")
    parser.add_argument("--profile", type=Path, metavar="PROFILE.toml", help="answers of a real controller")
    parser.add_argument("--fault", choices=list(Fault), default=Fault.NONE, help="what is wrong with the connection")
    parser.add_argument("--seed", type=int, default=0, help="of the encoder noise")
    parser.add_argument("--control", action="store_true", help="take signal,value and state lines from standard input")


def two_letter_models() -> list[str]:
    return [name for name, model in MODELS.items() if model.family != "smartmotor"]


def maker_of(options: argparse.Namespace, model: Model) -> Callable[[], Served]:
    """Reads the files the options name; the simulation itself is made later."""
    plants: Mapping[str, Plant] | None = None
    if options.plant:
        from device.simulator.plant_file import PlantUnreadable, load_plants

        try:
            plants = load_plants(options.plant)
        except PlantUnreadable as reason:
            raise Unusable(str(reason)) from reason
    if options.chain is not None and not 1 <= options.chain <= MOST_IN_CHAIN:
        raise Unusable(f"--chain {options.chain}: a daisy chain has 1 to {MOST_IN_CHAIN} controllers")
    try:
        eeproms = read_eeproms(options.eeprom, options.chain or 1)
    except EepromUnreadable as reason:
        raise Unusable(str(reason)) from reason

    return maker(
        model,
        plants,
        eeproms,
        chain=options.chain is not None,
        baud=options.baud,
        seed=options.seed,
        handshake=not options.no_handshake,
        profile=_profile(options.profile),
    )


def _profile(path: Path | None) -> Profile | None:
    if path is None:
        return None
    from device.simulator.twoletter.profile_file import ProfileUnreadable, load_profile

    try:
        return load_profile(path)
    except ProfileUnreadable as reason:
        raise Unusable(str(reason)) from reason


def main(argv: Sequence[str] | None = None) -> int:
    """Serves; 2 when the options are unusable."""
    parser = argparse.ArgumentParser(prog="twoletter simulate", description=__doc__)
    arguments(parser)
    options = parser.parse_args(argv)
    if options.controller not in two_letter_models():
        print(f"twoletter: no controller {options.controller}; {' '.join(two_letter_models())}", file=sys.stderr)
        return 2
    try:
        make = maker_of(options, MODELS[options.controller])
    except Unusable as reason:
        print(f"twoletter: {reason}", file=sys.stderr)
        return 2
    try:
        line = open_line(pty=options.pty, tcp=options.tcp)
        second = open_second(options.port2) if options.port2 else None
    except (OSError, ValueError) as reason:
        print(f"twoletter: cannot listen ({getattr(reason, 'strerror', None) or reason})", file=sys.stderr)
        return 2
    serve(make, line, second=second, control=options.control, fault=Fault(options.fault))
    return 0


if __name__ == "__main__":
    sys.exit(main())
