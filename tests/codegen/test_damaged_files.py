"""Damaged program and setup files: one sentence each, nothing is overwritten, nothing is half understood."""

from __future__ import annotations

import random
from collections.abc import Callable
from pathlib import Path

import resources
from codegen import files
from codegen.disk import FileUnreadable
from tests.long import count, record

SEED = 20
PROGRAMS = sorted(Path(resources.path("examples")).glob("*.tlp"))
TOKENS = [
    b'"id"',
    b'"do"',
    b"[",
    b"]",
    b"{",
    b"}",
    b",",
    b":",
    b"null",
    b"1e999",
    b"NaN",
    b'"s1"',
    b"-",
    b"true",
    b"\\u0000",
]


def spoilt(data: bytes, chance: random.Random) -> bytes:
    """One to four things that happen to files: cut, bytes turned, taken out, doubled, exchanged, other values."""
    for _ in range(chance.randrange(1, 5)):
        at = chance.randrange(len(data) or 1)
        size = chance.choice((1, 1, 2, 8, 60, 400))
        match chance.randrange(7):
            case 0:
                data = data[:at]
            case 1:
                data = data[:at] + bytes(chance.randrange(256) for _ in range(size)) + data[at + size :]
            case 2:
                data = data[:at] + data[at + size :]
            case 3:
                data = data[:at] + data[at : at + size] + data[at:]
            case 4:
                data = data[:at] + chance.choice(TOKENS) + data[at:]
            case 5:
                data = data.replace(chance.choice(TOKENS), chance.choice(TOKENS), chance.randrange(1, 4))
            case _:
                other = chance.randrange(len(data) or 1)
                data = data[:at] + data[other : other + size] + data[at + size :]
    return data


def one_sentence(words: str) -> None:
    assert words and "\n" not in words and len(words) < 400, words
    assert "Traceback" not in words and "Error" not in words, words


def spoil_all(tmp_path: Path, originals: list[bytes], read: Callable[[Path], object], suffix: str, rounds: int) -> int:
    """Reads every damaged file; how many of them were refused."""
    chance, path, refused = random.Random(SEED), tmp_path / f"damaged{suffix}", 0
    for _ in range(rounds):
        data = spoilt(chance.choice(originals), chance)
        path.write_bytes(data)
        try:
            read(path)
        except FileUnreadable as failure:
            refused += 1
            one_sentence(str(failure))
        assert path.read_bytes() == data
    assert [each.name for each in tmp_path.iterdir()] == [path.name]
    return refused


def read_program(path: Path) -> object:
    """What can be read is whole: written again and read again it is the same, and it can be generated."""
    from codegen.generate import generate

    document = files.load(path)
    assert files.loads(files.dumps(document)) == document
    return generate(document)


def read_setup(path: Path) -> object:
    setup = files.load_setup(path)
    assert files.setup_loads(files.setup_dumps(setup)) == setup
    return setup


def test_damaged_programs(tmp_path: Path) -> None:
    rounds = count(350, 3500)
    refused = spoil_all(tmp_path, [path.read_bytes() for path in PROGRAMS], read_program, ".tlp", rounds)
    assert refused > rounds // 2
    record(
        "damaged program files, each one sentence", "pytest tests/codegen/test_damaged_files.py", SEED, rounds, "files"
    )


def test_damaged_setups(tmp_path: Path) -> None:
    rounds = count(150, 1500)
    setups = [files.setup_dumps(files.load(path).setup).encode() for path in PROGRAMS]
    refused = spoil_all(tmp_path, setups, read_setup, ".tls", rounds)
    assert refused > rounds // 3
    record(
        "damaged setup files, each one sentence", "pytest tests/codegen/test_damaged_files.py", SEED, rounds, "files"
    )
