"""Reads the files a call works on: programs (.tlp), source (.dmc, .txt) and machine setups (.tls)."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.failure import Failure
from codegen.disk import FileUnreadable
from codegen.document import Document
from codegen.files import load, load_setup
from codegen.generate import Listing, generate
from codegen.models import MODELS, Model, model
from codegen.read import cannot
from codegen.setup import Setup
from codegen.twoletter.facts import is_host_comment
from codegen.twoletter.parse import parse_line

if TYPE_CHECKING:
    from device.simulator.twoletter.profile import Profile

DEFAULT_MODEL = "ssc4"
PRECIOUS = (".tlp", ".tls")


@dataclass(frozen=True)
class Loaded:
    """A file ready to be checked, run or downloaded: its two-letter text, and what it came from."""

    path: Path
    text: str
    model: Model
    setup: Setup
    document: Document | None = None
    listing: Listing | None = None
    bare: bool = False
    """Source without a setup: the controller keeps its factory limits (OE 0)."""

    @property
    def stimulus(self) -> str:
        """What the program's file says happens outside, as CSV; empty when nothing."""
        return self.document.stimulus if self.document else ""


def sentence(problem: OSError) -> str:
    """The reason of the operating system, without its number."""
    return (problem.strerror or str(problem)).lower()


def read_text(path: Path) -> str:
    """A text file, whatever its encoding; a lone carriage return ends a line too, as controllers send it."""
    readable(path)
    try:
        data = path.read_bytes()
    except OSError as problem:
        raise Failure(f"{path}: {sentence(problem)}") from problem
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    return text.replace("\r\n", "\n").replace("\r", "\n")


def readable(path: Path) -> None:
    """Refuses what is no file at all, before anything else is said about it."""
    if not path.exists():
        raise Failure(f"{path}: no such file")
    if path.is_dir():
        raise Failure(f"{path}: is a folder")


def target(text: str, *inputs: Path, ending: str = "") -> Path:
    """Where something is written: never onto a file that is read, nor onto a program or setup."""
    path = Path(text)
    if any(path.exists() and each.exists() and path.samefile(each) for each in inputs):
        raise Failure(f"{path}: is the file that is read; choose another name")
    if path.suffix.lower() in PRECIOUS:
        raise Failure(f"{path}: a program or setup is not overwritten; choose another name")
    if ending and path.suffix.lower() != ending:
        raise Failure(f"{path}: its name must end in {ending}")
    if path.is_dir():
        raise Failure(f"{path}: is a folder")
    if not path.parent.is_dir():
        raise Failure(f"{path}: there is no folder {path.parent}")
    return path


def write_text(path: Path, text: str, force: bool = True) -> None:
    """Writes a text file; an existing one only where that is wanted."""
    if path.exists() and not force:
        raise Failure(f"{path} exists already (--force overwrites it)")
    try:
        path.write_text(text, encoding="utf-8")
    except OSError as problem:
        raise Failure(f"{path}: {sentence(problem)}") from problem


def said_of(path: Path, problem: Exception) -> Failure:
    """A complaint about a file, with the file's name in front."""
    text = str(problem)
    for name in (str(path), path.name):
        text = text.removeprefix(f"{name}: ").removeprefix(f"{name} ")
    return Failure(f"{path}: {text}")


def is_program(path: Path) -> bool:
    """Whether a file is a visual program."""
    return path.suffix.lower() == ".tlp"


def read_document(path: Path) -> Document:
    """A visual program."""
    readable(path)
    try:
        return load(path)
    except FileUnreadable as problem:
        raise said_of(path, problem) from problem
    except OSError as problem:
        raise Failure(f"{path}: {sentence(problem)}") from problem


def read_setup(text: str | None) -> Setup | None:
    """A machine setup, where one is given."""
    if text is None:
        return None
    path = Path(text)
    readable(path)
    try:
        return load_setup(path)
    except FileUnreadable as problem:
        raise said_of(path, problem) from problem
    except OSError as problem:
        raise Failure(f"{path}: {sentence(problem)}") from problem


def read_profile(text: str | None) -> Profile | None:
    """What a real controller answered, where it is given."""
    if text is None:
        return None
    from device.simulator.twoletter.profile_file import ProfileUnreadable, load_profile

    path = Path(text)
    readable(path)
    try:
        return load_profile(path)
    except ProfileUnreadable as problem:
        raise said_of(path, problem) from problem


def errors_of(listing: Listing) -> list[str]:
    """What stops steps from becoming code, one sentence each."""
    return [finding.message for finding in listing.problems if finding.severity == "error"]


def fitted(document: Document, setup: Setup | None, controller: str | None, path: Path) -> Document:
    """The document with another setup or controller; refused when the program does not fit that controller."""
    wanted = setup or document.setup
    if controller:
        wanted = dataclasses.replace(wanted, model=controller)
    of_two_letters(wanted.model, path)
    fitting = dataclasses.replace(document, setup=wanted)
    reasons = [cannot(type(step.instruction), wanted) for step in fitting.program.steps() if step.enabled]
    known = errors_of(generate(document))
    reasons += [message for message in errors_of(generate(fitting)) if message not in known]
    if found := [reason for reason in reasons if reason]:
        raise Failure(f"{path}: the program does not fit {wanted.model}: {found[0]}")
    return fitting


def plain(path: Path, text: str) -> None:
    """Refuses characters that no controller has; comments that stay in the file (REM) may hold them."""
    for number, line in enumerate(text.split("\n"), 1):
        if not line.isascii() and not is_host_comment(parse_line(line)):
            letter = next(character for character in line if not character.isascii())
            raise Failure(f"{path}: line {number}: the controller knows plain characters only, not {letter!r}")


def complete(path: Path, text: str, listing: Listing | None) -> None:
    """Refuses a program whose setup is wrong or in which a step could not become code.

    What the checker finds is no reason: the controller finds it too, when it comes to it.
    """
    if listing is None:
        plain(path, text)
        return
    for finding in listing.problems:
        if finding.severity == "error" and not finding.step:
            raise Failure(f"{path}: {finding.message}")
    for line in listing.lines:
        if line.problem:
            raise Failure(f"{path}: a step is not finished: {line.problem}")


def of_two_letters(name: str, path: Path) -> Model:
    """The controller's model; SmartMotor source is another language."""
    if name == "smartmotor" or path.suffix.lower() == ".sms":
        raise Failure(f"{path}: SmartMotor code cannot be written, checked or run yet")
    return model(name)


def load_any(path: Path, controller: str | None = None, setup_path: str | None = None) -> Loaded:
    """A program or source with its controller and setup."""
    setup = read_setup(setup_path)
    if is_program(path):
        document = read_document(path)
        if setup or controller:
            document = fitted(document, setup, controller, path)
        listing = generate(document)
        chosen = of_two_letters(document.setup.model, path)
        return Loaded(path, listing.text, chosen, document.setup, document, listing)
    text = read_text(path)
    name = controller or (setup.model if setup else DEFAULT_MODEL)
    chosen = of_two_letters(name, path)
    return Loaded(path, text, chosen, dataclasses.replace(setup or Setup(), model=name), bare=setup is None)


def known_models() -> str:
    """The names of all controllers, for messages."""
    return ", ".join(MODELS)
