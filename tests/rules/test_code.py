"""House rules that the syntax of the code shows."""

from __future__ import annotations

import ast
import warnings

import pytest

from codegen.twoletter.commands import COMMANDS
from tests.rules.sources import PACKAGES, python_files, relative, syntax

LONGEST_MODULE = 500
BROAD = ("Exception", "BaseException")
SPELLINGS = frozenset(name for name in COMMANDS if len(name) == 2)
HOME_OF_SPELLINGS = (
    "codegen/twoletter/",
    "codegen/smartmotor/",
    "device/simulator/",
    "device/door.py",  # what leaves in Watch is listed by name, on purpose
)
MOST_SPELLINGS = 6


def broad_excepts(tree: ast.Module) -> list[int]:
    """Lines of handlers that catch everything."""
    found = []
    for node in ast.walk(tree):
        if not isinstance(node, ast.ExceptHandler):
            continue
        kinds = node.type.elts if isinstance(node.type, ast.Tuple) else [node.type]
        if any(kind is None or (isinstance(kind, ast.Name) and kind.id in BROAD) for kind in kinds):
            found.append(node.lineno)
    return found


@pytest.mark.parametrize("package", ["codegen", "device"])
def test_nothing_catches_everything(package: str) -> None:
    wrong = [f"{relative(path)}:{line}" for path in python_files(package) for line in broad_excepts(syntax(path))]
    assert not wrong, "\n".join(wrong)


def test_a_broad_except_is_seen() -> None:
    text = "try:\n    pass\nexcept (ValueError, Exception):\n    pass\ntry:\n    pass\nexcept:\n    pass\n"
    assert broad_excepts(ast.parse(text)) == [3, 7]


def spelling_tables(tree: ast.Module) -> list[int]:
    """Lines of literal lists, sets and dicts that hold several spellings of commands."""
    found = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Dict):
            entries = [key for key in node.keys if key is not None]
        elif isinstance(node, ast.List | ast.Tuple | ast.Set):
            entries = node.elts
        else:
            continue
        texts = [entry.value for entry in entries if isinstance(entry, ast.Constant) and isinstance(entry.value, str)]
        if len(set(texts) & SPELLINGS) >= MOST_SPELLINGS:
            found.append(node.lineno)
    return found


def test_spellings_of_commands_stand_in_their_tables_only() -> None:
    wrong = [
        f"{relative(path)}:{line}: a second table of commands"
        for path in python_files(*PACKAGES)
        if not relative(path).startswith(HOME_OF_SPELLINGS)
        for line in spelling_tables(syntax(path))
    ]
    assert not wrong, "\n".join(wrong)


def test_a_second_table_of_commands_is_seen() -> None:
    assert spelling_tables(ast.parse("X = {'PR': 1, 'PA': 2, 'SP': 3, 'AC': 4, 'DC': 5, 'BG': 6}")) == [1]


def length(path: object) -> int:
    """Lines of a file."""
    return len(path.read_text(encoding="utf-8").splitlines())  # type: ignore[attr-defined]


def test_modules_stay_short() -> None:
    lengths = {relative(path): length(path) for path in python_files(*PACKAGES, "tests")}
    reach = sorted(((lines, name) for name, lines in lengths.items() if lines > 400), reverse=True)
    if reach:
        warnings.warn("modules over 400 lines: " + ", ".join(f"{name} {lines}" for lines, name in reach), stacklevel=1)
    assert not [f"{name}: {lines} lines" for lines, name in reach if lines > LONGEST_MODULE]


ASSERTING = ("assert", "check", "expect", "wait_until", "waituntil", "waitsignal", "raises", "fail", "verify", "must_")


Function = ast.FunctionDef | ast.AsyncFunctionDef


def called(node: ast.Call) -> str:
    """The bare name of what is called."""
    return node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")


def asserts(function: Function, helpers: frozenset[str] = frozenset()) -> bool:
    """Whether a test can fail by what it says, itself or through a helper of the same file."""
    for node in ast.walk(function):
        if isinstance(node, ast.Assert):
            return True
        if isinstance(node, ast.Call):
            name = called(node)
            if name in helpers or any(word in name.lower() for word in ASSERTING):
                return True
    return False


def idle_tests(tree: ast.Module) -> list[tuple[int, str]]:
    """Tests that cannot fail."""
    functions = [node for node in ast.walk(tree) if isinstance(node, Function)]
    helpers = frozenset(node.name for node in functions if not node.name.startswith("test_") and asserts(node))
    return [
        (node.lineno, node.name) for node in functions if node.name.startswith("test_") and not asserts(node, helpers)
    ]


def test_every_test_asserts_something() -> None:
    wrong = [
        f"{relative(path)}:{line}: {name} asserts nothing"
        for path in python_files("tests")
        if path.name.startswith("test_")
        for line, name in idle_tests(syntax(path))
    ]
    assert not wrong, "\n".join(wrong)


def test_a_test_without_assertion_is_seen() -> None:
    assert idle_tests(ast.parse("def test_nothing():\n    print(1)\n")) == [(1, "test_nothing")]
    assert not idle_tests(ast.parse("def right():\n    assert x\ndef test_it():\n    right()\n"))


def test_nothing_sleeps_in_the_language() -> None:
    wrong = [
        f"{relative(path)}:{node.lineno}"
        for path in python_files("codegen")
        for node in ast.walk(syntax(path))
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr == "sleep"
    ]
    assert not wrong, "\n".join(wrong)


NESTED = ("exec", "exec_", "processEvents", "getOpenFileName", "getSaveFileName", "getExistingDirectory", "getText")


def nested_loops(tree: ast.Module) -> list[int]:
    """Lines that run another event loop, or some events, within the present one."""
    calls = [node for node in ast.walk(tree) if isinstance(node, ast.Call)]
    named = [(node.lineno, node.func.attr) for node in calls if isinstance(node.func, ast.Attribute)]
    loops = [node.lineno for node in ast.walk(tree) if isinstance(node, ast.Name) and node.id == "QEventLoop"]
    return sorted({line for line, name in named if name in NESTED} | set(loops))


def test_nothing_runs_a_loop_within_the_loop() -> None:
    """Ticks put F12's filter aside while they run: within one no key may come (app/stop_key.py, safety.md 1)."""
    wrong = [
        f"{relative(path)}:{line}" for path in python_files("app", "widgets") for line in nested_loops(syntax(path))
    ]
    assert [place.split(":")[0] for place in wrong] == ["app/studio.py"], "\n".join(wrong)  # the program's own loop


def test_a_nested_loop_is_seen() -> None:
    text = "menu.exec(place)\nQApplication.processEvents()\nloop = QEventLoop()\nexecute()\n"
    assert nested_loops(ast.parse(text)) == [1, 2, 3]
