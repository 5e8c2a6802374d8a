"""The arguments of every call, as `argparse` reads them."""

from __future__ import annotations

import argparse
from typing import NoReturn

from app.cli.failure import Failure
from codegen.models import MODELS

HANDSHAKES = ("rts", "xon", "both", "none")
CALLS = (
    "demo",
    "compile",
    "check",
    "import",
    "run",
    "simulate",
    "terminal",
    "download",
    "upload",
    "backup",
    "restore",
    "conform",
    "ports",
    "doctor",
)


class Version(argparse.Action):
    """Prints the version and ends; it is looked up only then."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        from app.cli.version import version

        print(f"twoletter {version()}")
        parser.exit()


class Parser(argparse.ArgumentParser):
    """A parser whose complaints are one line."""

    def error(self, message: str) -> NoReturn:
        """Turns a wrong argument into one sentence."""
        raise Failure(f"{message} (twoletter --help shows the calls)")


def controller_option(parser: argparse.ArgumentParser) -> None:
    """--controller, where a model can be chosen."""
    parser.add_argument("--controller", metavar="MODEL", choices=list(MODELS), help=" ".join(MODELS))


def line_options(parser: argparse.ArgumentParser, profile: bool = True) -> None:
    """Options of every call that talks to a controller."""
    parser.add_argument("--port", required=True, help="serial device, socket://host:port or simulator[:MODEL]")
    parser.add_argument("--baud", type=int, metavar="N", help="speed of the line (default 9600)")
    parser.add_argument("--handshake", choices=HANDSHAKES, default="none")
    parser.add_argument("--address", type=int, choices=range(8), metavar="0-7", help="address in a daisy chain")
    if profile:
        parser.add_argument("--profile", metavar="PROFILE.toml", help="how this controller answers, from conform")
    parser.add_argument(
        "--control", action="store_true", help="may set, move and download; never needed for a simulator"
    )


def file_calls(calls: argparse._SubParsersAction[Parser]) -> None:
    """The calls that work on files."""
    demo = calls.add_parser("demo", help="the wire cutter on the simulator, without a window")
    demo.add_argument("-o", "--picture", metavar="FILE.svg", default="twoletter-demo.svg", help="picture of the motion")
    compile_ = calls.add_parser("compile", help="program to source")
    compile_.add_argument("file", metavar="FILE.tlp")
    compile_.add_argument("-o", "--output", metavar="OUT")
    controller_option(compile_)
    compile_.add_argument("--compact", action="store_true", help="join statements up to the line length")
    compile_.add_argument("--map", metavar="MAP.json", help="which line comes from which step")
    check = calls.add_parser("check", help="checks source or programs")
    check.add_argument("files", metavar="FILE", nargs="+")
    controller_option(check)
    check.add_argument("--json", action="store_true")
    import_ = calls.add_parser("import", help="source to visual program")
    import_.add_argument("file", metavar="FILE")
    import_.add_argument("-o", "--output", metavar="OUT.tlp", required=True)
    controller_option(import_)
    import_.add_argument("--force", action="store_true", help="overwrite an existing file")


def simulator_calls(calls: argparse._SubParsersAction[Parser]) -> None:
    """The calls that use the simulator."""
    run = calls.add_parser("run", help="runs source or a program on the simulator")
    run.add_argument("file", metavar="FILE")
    controller_option(run)
    run.add_argument("--setup", metavar="SETUP.tls")
    run.add_argument("--plant", metavar="PLANT.toml")
    run.add_argument("--entry", metavar="LABEL")
    run.add_argument("--time", type=float, default=60.0, metavar="SECONDS", help="virtual seconds (default 60)")
    run.add_argument("--stimulus", metavar="CSV", help="what happens outside: ms,signal,value")
    run.add_argument("--trace", metavar="OUT.csv|OUT.npz")
    run.add_argument("--every", type=int, default=1, metavar="N", help="one row of the trace for every N samples")
    run.add_argument("--json", action="store_true")
    run.add_argument("--real-time", action="store_true")
    run.add_argument("--profile", metavar="PROFILE.toml", help="answers of a real controller, from conform")
    simulate = calls.add_parser("simulate", help="serves a simulated controller in real time")
    controller_option(simulate)
    simulate.add_argument("--plant", metavar="PLANT.toml")
    simulate.add_argument("--tcp", metavar="HOST:PORT", help="default 127.0.0.1:0, which picks a port")
    simulate.add_argument("--pty", action="store_true", help="a pseudo-terminal instead of TCP")
    simulate.add_argument("--baud", type=int, metavar="N", help="paces the line to N baud")
    simulate.add_argument("--eeprom", metavar="FILE")
    simulate.add_argument("--chain", type=int, metavar="N", help="N controllers in a daisy chain")
    simulate.add_argument("--port2", metavar="HOST:PORT|pty", help="port 2 as a line of its own")
    simulate.add_argument("--no-handshake", action="store_true", help="characters that come too fast are lost")
    simulate.add_argument("--profile", metavar="PROFILE.toml", help="answers of a real controller, from conform")


def line_calls(calls: argparse._SubParsersAction[Parser]) -> None:
    """The calls that talk to a controller."""
    line_options(calls.add_parser("terminal", help="types to a controller"))
    download = calls.add_parser("download", help="sends a program and verifies it")
    download.add_argument("file", metavar="FILE")
    line_options(download)
    upload = calls.add_parser("upload", help="reads the program of a controller")
    line_options(upload)
    upload.add_argument("-o", "--output", metavar="FILE")
    upload.add_argument("--force", action="store_true", help="overwrite an existing file")
    backup = calls.add_parser("backup", help="everything a controller holds, in one readable file")
    line_options(backup)
    backup.add_argument("-o", "--output", metavar="FILE", required=True)
    backup.add_argument("--note", default="", metavar="TEXT", help="kept in the file")
    backup.add_argument("--setup", metavar="SETUP.tls", help="kept in the file as well")
    backup.add_argument("--force", action="store_true", help="overwrite an existing file")
    restore = calls.add_parser("restore", help="puts a back-up back; the motors are off afterwards")
    restore.add_argument("file", metavar="FILE")
    line_options(restore)
    conform = calls.add_parser("conform", help="compares a controller with the simulator; nothing moves")
    line_options(conform, profile=False)
    conform.add_argument("-o", "--output", metavar="PROFILE.toml", help="what was found (default MODEL-profile.toml)")
    conform.add_argument("--force", action="store_true", help="overwrite an existing file")
    controller_option(conform)
    conform.add_argument("--cw", type=int, choices=(1, 2), help="what CW is set to there: lets marks be looked at")
    calls.add_parser("ports", help="serial ports that are there")
    line_options(calls.add_parser("doctor", help="what is wrong with a connection, in words"), profile=False)


def calls_parser() -> Parser:
    """The parser of `twoletter CALL …`."""
    parser = Parser(prog="twoletter", description="Program and run motion controllers that speak two-letter code.")
    parser.add_argument("--version", action=Version, nargs=0, help="which version this is")
    calls = parser.add_subparsers(dest="call", metavar="CALL", required=True, parser_class=Parser)
    file_calls(calls)
    simulator_calls(calls)
    line_calls(calls)
    return parser


def studio_parser() -> Parser:
    """The parser of `twoletter [FILE] …`, which opens the studio."""
    parser = Parser(
        prog="twoletter",
        description="Opens the studio. Other calls: " + ", ".join(CALLS) + " (twoletter CALL --help).",
    )
    parser.add_argument("--version", action=Version, nargs=0, help="which version this is")
    parser.add_argument("file", metavar="FILE", nargs="?", help="a program (.tlp)")
    way = parser.add_mutually_exclusive_group()
    way.add_argument("--simulator", metavar="MODEL", nargs="?", const="", help="connect to the bundled simulator")
    way.add_argument("--port", metavar="PORT", help="connect to a serial device or socket://host:port")
    way.add_argument("--offline", action="store_true", help="connect to nothing")
    return parser
