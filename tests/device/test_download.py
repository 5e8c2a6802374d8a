"""Downloads: verified, the old program kept, every failure one sentence that claims nothing, and it works again."""

from __future__ import annotations

from datetime import datetime
from pathlib import Path

import pytest

from codegen.models import model
from device.api import Badge, DownloadFailed, LinkError, State, StopState
from device.download import Job, difference, objection, program_lines, refusal, write_dated
from device.transport import TransportLost
from tests.device.bench import Bench
from tests.long import is_long

PROGRAM = "\n".join(["#A", *(f"PR {n},{n};SP {1000 + n};NO LINE {n}" for n in range(60)), "EN"])
MOMENTS = [0.0, 0.003, 0.011, 0.017, 0.029] if is_long() else [0.0]  # s after a phase has begun
PHASES = ("before DL", "first line", "first third", "second third", "last line", "backslash", "verifying")


def at(bench: Bench, phase: str, job: Job[object]) -> bool:
    """Whether the download has come to this phase."""
    if phase == "before DL":
        return b"UL\r" in bench.sent
    share = {"first line": 0.02, "first third": 0.33, "second third": 0.66, "last line": 0.94}.get(phase)
    if share is not None:
        return job.phase == "sending" and job.fraction >= share
    return job.phase == {"backslash": "finishing", "verifying": "verifying"}[phase]


def begun(phase: str, later_s: float = 0.0, *typed: str) -> tuple[Bench, Job[object]]:
    """A download that has come to this phase, or a little further."""
    bench = Bench("ssc4").ready()
    bench.result(bench.controller.download("#OLD\nEN").future)
    for line in typed:
        bench.ask(line)
    bench.sent.clear()
    job = bench.controller.download(PROGRAM)
    bench.run_until(lambda: at(bench, phase, job))
    bench.run(later_s)
    assert not job.future.done()
    return bench, job


def fails_in_one_sentence(bench: Bench, job: Job[object]) -> str:
    with pytest.raises(LinkError) as failure:
        bench.result(job.future, 60.0)
    text = str(failure.value)
    assert "verified." not in text
    assert "\n" not in text
    assert text.endswith(".")
    return text


def true_or_a_sentence(bench: Bench, job: Job[object], erased: bool = False) -> None:
    """A success only where the controller holds the program (or held it, when it was erased while it was read)."""
    while_read = erased and job.phase == "verifying"
    try:
        bench.result(job.future, 60.0)
    except LinkError as failure:
        assert "verified." not in str(failure)
        assert "\n" not in str(failure)
        assert str(failure).endswith(".")
    else:
        assert while_read or bench.simulation.unit.state.program == tuple(PROGRAM.split("\n"))


def works_again(bench: Bench) -> None:
    bench.run_until(lambda: bench.controller.state is State.READY, 30.0)
    again = bench.result(bench.controller.download(PROGRAM).future, 60.0)
    assert again.verified
    assert bench.result(bench.controller.upload().future).rstrip("\n") == PROGRAM


def test_a_download_is_verified_and_the_old_program_kept(tmp_path: Path) -> None:
    bench = Bench("ssc4", program_folder=tmp_path).ready()
    bench.result(bench.controller.download("#OLD\nPR 5\nEN").future)
    assert list(tmp_path.iterdir()) == []
    done = bench.result(bench.controller.download(PROGRAM).future)
    assert done.verified
    assert done.kept is not None
    assert done.kept.read_text() == "#OLD\nPR 5\nEN\n"
    assert bench.result(bench.controller.upload().future).rstrip("\n") == PROGRAM


def test_remarks_are_the_hosts_and_never_sent() -> None:
    assert program_lines("#A\nREM a remark\n  REM another\nPR 1\nEN\n\n") == ["#A", "PR 1", "EN"]
    bench = Bench("ssc4").ready()
    bench.result(bench.controller.download("#A\nREM secret\nEN").future)
    assert b"secret" not in bench.sent


@pytest.mark.parametrize("later_s", MOMENTS)
@pytest.mark.parametrize("phase", PHASES)
def test_a_cable_that_is_pulled(phase: str, later_s: float) -> None:
    bench, job = begun(phase, later_s)
    bench.loopback.unplugged = True
    fails_in_one_sentence(bench, job)
    assert bench.controller.program_badge is not Badge.SAME
    bench.run(3.0)
    bench.loopback.unplugged = False
    works_again(bench)


@pytest.mark.parametrize("later_s", MOMENTS)
@pytest.mark.parametrize("phase", PHASES)
def test_a_port_that_goes_away(phase: str, later_s: float, monkeypatch: pytest.MonkeyPatch) -> None:
    bench, job = begun(phase, later_s)

    def gone(data: bytes) -> int:
        raise TransportLost("The port is gone.")

    with monkeypatch.context() as patch:
        patch.setattr(bench.loopback, "write", gone)
        patch.setattr(bench.loopback, "read", gone)
        text = fails_in_one_sentence(bench, job)
        assert "connection was lost" in text
    works_again(bench)


@pytest.mark.parametrize("later_s", MOMENTS)
@pytest.mark.parametrize("phase", PHASES)
def test_garbage_on_the_line(phase: str, later_s: float) -> None:
    bench, job = begun(phase, later_s)
    transmit = bench.simulation.transmit
    noise = [b"\xf7?\x00:", b"\x81\xfe??"]
    bench.simulation.transmit = lambda port: (noise.pop() if noise else b"") + transmit(port)  # type: ignore[method-assign]
    true_or_a_sentence(bench, job)
    works_again(bench)


@pytest.mark.parametrize("later_s", MOMENTS)
@pytest.mark.parametrize("phase", PHASES)
def test_garbage_towards_the_controller(phase: str, later_s: float) -> None:
    """Three characters of what is sent are turned into others."""
    bench, job = begun(phase, later_s)
    receive, left = bench.simulation.receive, [3]

    def spoiled(port: int, data: bytes) -> None:
        if left[0] and data:
            left[0] -= 1
            data = data[:-1] + b"Z"
        receive(port, data)

    bench.simulation.receive = spoiled  # type: ignore[method-assign]
    true_or_a_sentence(bench, job)
    works_again(bench)


@pytest.mark.parametrize("later_s", MOMENTS)
@pytest.mark.parametrize("phase", PHASES)
def test_a_controller_switched_off_and_on(phase: str, later_s: float) -> None:
    bench, job = begun(phase, later_s)
    bench.simulation.stimulus("reset", 0)
    bench.simulation.stimulus("reset", 1)
    true_or_a_sentence(bench, job, erased=True)
    assert not any(axis["moving"] for axis in bench.simulation.state()["axes"].values())
    works_again(bench)


def test_cancelling_says_what_the_controller_holds() -> None:
    bench, job = begun("first third")
    job.cancel()
    assert "cancelled at line" in fails_in_one_sentence(bench, job)
    assert bench.ask("TPX") == " 0000000000"
    works_again(bench)


@pytest.mark.parametrize("later_s", MOMENTS)
@pytest.mark.parametrize("phase", PHASES)
def test_stop_ends_a_download_and_what_moves(phase: str, later_s: float) -> None:
    bench, job = begun(phase, later_s, "SH", "JG 20000;BG X")
    assert not bench.still()
    bench.controller.stop()
    assert "STOP was pressed" in fails_in_one_sentence(bench, job)
    bench.run_until(lambda: bench.controller.stop_state is StopState.STOPPED)
    assert bench.still()
    bench.run(1.0)
    assert "ST" not in bench.result(bench.controller.upload().future).replace("\n", ";").split(";")
    works_again(bench)


def test_a_running_program_is_not_replaced() -> None:
    bench = Bench("ssc4").ready()
    bench.result(bench.controller.download("#A\nWT 10\nJP #A").future)
    bench.result(bench.controller.execute("A", anyway=True))
    with pytest.raises(DownloadFailed, match="a program is running"):
        bench.result(bench.controller.download(PROGRAM).future)


def test_a_double_label_is_named_with_its_line() -> None:
    bench = Bench("ssc4").ready()
    with pytest.raises(LinkError, match=r"error 61, the label #A in line 2"):
        bench.result(bench.controller.download("#A\nEN\n#A\nEN").future)


def test_what_can_not_be_a_program_is_not_sent() -> None:
    bench = Bench("dmc1412").ready()
    with pytest.raises(DownloadFailed, match="Line 1 has 41 characters; this controller takes 40"):
        bench.result(bench.controller.download("#A\n" + "N" * 41 + "\nEN").future)
    assert b"DL" not in bench.sent
    assert "backslash" in objection(['MG "\\"'], None)
    assert "251 lines; this controller takes 250" in objection(["NO"] * 251, model("dmc1412"))


def test_the_first_difference_in_words() -> None:
    assert difference(["#A", "PR 1"], ["#A", "PR 7"]) == "line 1 is “PR 7” in the controller, but “PR 1” was sent"
    assert difference(["#A", "EN"], ["#A"]) == "the controller holds 1 lines, 2 were sent"
    assert difference(["#A", "EN"], ["#A", "EN"]) == ""


def test_refusals_in_words() -> None:
    assert "error 62, it has 3 labels" in refusal(62, ["#A", "#B;#C"], None)
    assert "longest is line 1" in refusal(60, ["#A", "N" * 90], None)


def test_files_of_old_programs_are_never_overwritten(tmp_path: Path) -> None:
    now = datetime(2024, 5, 6, 7, 8, 9)
    first, second = write_dated(tmp_path, "#A", now), write_dated(tmp_path, "#B", now)
    assert first.name == "2024-05-06 07.08.09.dmc"
    assert first.read_text() == "#A\n"
    assert second.read_text() == "#B\n"


@pytest.mark.parametrize("lines", [60, 120, 500])
@pytest.mark.parametrize("baud", [9600, 19200])
def test_a_download_uses_nine_tenths_of_the_line(baud: int, lines: int) -> None:
    """From DL to the final prompt, 10 bits a character; the lines of 26 characters as technicians write them."""
    bench = Bench("ssc1", baud=baud).ready()
    listing = "\n".join(["#A", *(f"PR {1000 + n * 7};SP 20000;BGX;AMX" for n in range(lines - 2)), "EN"])
    job = bench.controller.download(listing)
    bench.run_until(lambda: b"DL\r" in bench.sent)
    start, place = bench.loopback.clock(), bench.sent.index(b"DL\r")
    bench.run_until(lambda: job.phase == "verifying", 100.0)
    taken = bench.loopback.clock() - start
    limit = (bench.sent.index(b"\\") - place + 2) * 10 / baud
    assert limit / taken >= 0.90
    bench.result(job.future, 100.0)


@pytest.mark.parametrize("baud", [9600, 38400, 115200])
@pytest.mark.parametrize("line", ["AM", "PR 1000;SP 20000;BGX;AMX"])
def test_between_the_lines_of_a_download_the_line_is_never_idle(baud: int, line: str) -> None:
    """10 bits a character; short lines would leave gaps if only one were handed over at a time."""
    bench = Bench("ssc4", baud=baud).ready()
    job = bench.controller.download("\n".join(["#A", *[line] * 300, "EN"]))
    bench.run_until(lambda: job.phase == "sending" and job.done > 1)
    start, place = bench.loopback.clock(), len(bench.sent)
    bench.run_until(lambda: job.phase == "finishing")
    taken = bench.loopback.clock() - start
    assert (len(bench.sent) - place) * 10 / baud / taken >= 0.98


@pytest.mark.parametrize("late_s", [0.045, 0.2])
def test_a_refused_dl_is_waited_for_as_long_as_the_way_takes(late_s: float) -> None:
    """An adapter or a network keeps what comes back for a while; the lines must not leave before the `?` is here."""
    bench = Bench("ssc4").ready()
    bench.ask("SH")
    receive, transmit = bench.simulation.receive, bench.simulation.transmit
    kept: list[tuple[float, bytes]] = []

    def later(port: int) -> bytes:
        now = bench.loopback.clock()
        data = transmit(port)
        if data:
            kept.append((now + late_s, data))
        due = [part for at, part in kept if at <= now]
        kept[:] = [(at, part) for at, part in kept if at > now]
        return b"".join(due)

    bench.simulation.receive = lambda port, data: receive(port, data.replace(b"DL", b"D"))  # type: ignore[method-assign]
    bench.simulation.transmit = later  # type: ignore[method-assign]
    bench.run(1.0)
    bench.sent.clear()
    text = fails_in_one_sentence(bench, bench.controller.download("PR 1000\nBG X\nEN"))
    assert "did not go into download mode" in text
    assert b"PR 1000" not in bench.sent
    assert bench.still()


def test_the_badge_tells_how_program_and_document_stand() -> None:
    bench = Bench("ssc4").ready()
    controller = bench.controller
    assert controller.program_badge is Badge.UNKNOWN
    controller.show_listing(PROGRAM)
    bench.result(controller.download(PROGRAM).future)
    assert controller.program_badge is Badge.SAME
    controller.show_listing(PROGRAM + "\n#B\nEN")
    assert controller.program_badge is Badge.CHANGED
    with pytest.raises(LinkError, match="changed since the download"):
        bench.result(controller.execute("A"))
    bench.ask("RS")
    bench.run(3.0)
    assert controller.program_badge is Badge.UNKNOWN


@pytest.mark.parametrize("lost", [3, 30, 400, 1200])
def test_a_lost_character_is_found_and_the_lines_are_sent_again_slower(lost: int) -> None:
    """Without handshake a character may be overrun (dmc-1412-1414.txt l.1278)."""
    bench = Bench("ssc4").ready()
    receive, count, once = bench.simulation.receive, [0], [True]

    def dropping(port: int, data: bytes) -> None:
        for byte in data:
            count[0] += b"DL\r" in bench.sent
            if count[0] == lost and once[0]:
                once[0] = False
                continue
            receive(port, bytes([byte]))

    bench.simulation.receive = dropping  # type: ignore[method-assign]
    bench.sent.clear()
    done = bench.result(bench.controller.download(PROGRAM).future, 60.0)
    assert done.verified
    assert bench.sent.count(b"DL\r") == 2
    assert bench.still()
    assert bench.result(bench.controller.upload().future).rstrip("\n") == PROGRAM


def test_a_character_lost_every_time_is_a_failure_in_words() -> None:
    bench = Bench("ssc4").ready()
    receive = bench.simulation.receive
    bench.simulation.receive = lambda port, data: receive(port, data.replace(b"7", b""))  # type: ignore[method-assign]
    text = fails_in_one_sentence(bench, bench.controller.download(PROGRAM))
    assert text.startswith("Not downloaded, tried twice: line 8 is “PR ,;SP 100;NO LINE”")


def test_a_lost_dl_never_runs_the_lines_as_commands() -> None:
    """DL itself is garbled: the controller would take the lines for commands."""
    bench = Bench("ssc4").ready()
    bench.ask("SH")
    receive = bench.simulation.receive
    bench.simulation.receive = lambda port, data: receive(port, data.replace(b"DL", b"D"))  # type: ignore[method-assign]
    text = fails_in_one_sentence(bench, bench.controller.download("PR 1000\nBG X\nEN"))
    assert "did not go into download mode" in text
    assert b"PR 1000" not in bench.sent
    assert bench.still()


DL_LINE = len('MG{^30},"k7",{^31};DL\r')


@pytest.mark.parametrize("change", [b"", b"M", *([b"\x00", b"1", b";", b"\r"] if is_long() else [])])
def test_whatever_happens_to_dl_no_line_of_the_program_is_carried_out(change: bytes) -> None:
    """Each character of the line with DL is lost or turned into another; the program's first line would move."""
    for place in range(DL_LINE):
        bench = Bench("ssc1").ready()
        bench.ask("SH")
        receive, seen = bench.simulation.receive, [-1]

        def spoiled(port: int, data: bytes, bench: Bench = bench, place: int = place) -> None:
            for byte in data:
                if seen[0] < 0 and b";DL\r" in bench.sent:  # noqa: B023
                    seen[0] = 0  # noqa: B023
                hit = seen[0] == place  # noqa: B023
                seen[0] += seen[0] >= 0  # noqa: B023
                receive(port, change if hit else bytes([byte]))  # noqa: B023

        bench.simulation.receive = spoiled  # type: ignore[method-assign]
        job = bench.controller.download("JG 5000;BG X\nEN")
        bench.run_until(job.future.done, 60.0)
        assert seen[0] > place
        assert bench.still(), place
        assert job.future.result().verified, place
        assert bench.simulation.unit.state.program == ("JG 5000;BG X", "EN"), place
