"""The link with controllers that answer otherwise than the simulator assumes, as a profile describes them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from codegen.models import model
from device.api import Controller, NoticeKind, StopState
from device.simulator.simulation import Simulation
from device.simulator.twoletter.profile import Profile
from device.simulator.twoletter.profile_file import ProfileUnreadable, profile_text
from tests.device.bench import Bench

PROGRAM = "#A\nPR 1000;BGX\nAMX\nEN\n"


def bench_with(**settings: Any) -> Bench:
    """A link that knows how its controller answers."""
    profile = Profile(**settings)
    simulation = Simulation(model("ssc2"), baud=19200, compiled=True, profile=profile)
    return Bench("ssc2", simulation=simulation, manners=profile.manners()).ready()


def works(bench: Bench) -> None:
    """Asks, is refused, downloads, uploads, and goes on reading."""
    assert bench.ask("MG 6*7{F3.0}").strip() == "042"
    assert bench.ask("V1=1;V2=2;V1=;V2=").split() == ["0000000001.0000", "0000000002.0000"]
    refused = bench.result(bench.controller.ask("QQ 5"))
    assert not refused.accepted and "Unrecognized" in refused.reason
    assert not bench.result(bench.controller.ask("V1=5;PR 99999999999;V2=6")).accepted
    done = bench.result(bench.controller.download(PROGRAM).future)
    assert done.verified
    assert bench.result(bench.controller.upload().future) == PROGRAM
    assert bench.ask("MG V1{F3.0}").strip() == "005"


@pytest.mark.parametrize("end", ["^Z", "^Z CR LF", "CR LF", "nothing"])
def test_ends_of_an_upload(end: str) -> None:
    works(bench_with(program_end=end))


def test_an_empty_program_is_uploaded() -> None:
    for end in ("^Z", "^Z CR LF", "CR LF", "nothing"):
        bench = bench_with(program_end=end)
        assert bench.result(bench.controller.upload().future).strip() == ""


def test_one_prompt_for_a_line() -> None:
    works(bench_with(prompt_per_command=False))


def test_lines_that_go_on_behind_a_refusal() -> None:
    bench = bench_with(error_ends_line=False)
    works(bench)
    assert bench.ask("MG V2{F3.0}").strip() == "006"  # it was carried out


def test_all_at_once() -> None:
    works(
        bench_with(
            prompt_per_command=False, error_ends_line=False, program_end="nothing", echo_return="CR", status_sign=True
        )
    )


@pytest.mark.parametrize("answers", ["CR LF", "CR"])
def test_a_controller_that_echoes_is_understood(answers: str) -> None:
    """EO 1 (dmc-1412-1414.txt l.1348): every character comes back, prompts and refusals of a program's text too."""
    bench = bench_with(echo_return=answers)
    assert bench.ask("EO 1") == ""
    works(bench)
    listing = '#A\nMG "SURE?:"\nIN "HOW MANY?",N\nEN\n'
    assert bench.result(bench.controller.download(listing).future).verified
    assert bench.result(bench.controller.upload().future) == listing
    bench.controller.notices()
    bench.result(bench.controller.execute("A", anyway=True))
    bench.run_until(lambda: bench.controller.pending_prompt is not None)
    prompt = bench.controller.pending_prompt
    assert prompt is not None and prompt.text == "HOW MANY?"
    bench.result(bench.controller.answer("12"))
    bench.run(1.0)
    assert [each.text for each in bench.controller.notices() if each.kind is NoticeKind.MESSAGE] == ["SURE?:"]
    assert bench.ask("MG N{F3.0}").strip() == "012"
    bench.controller.stop()
    bench.run_until(lambda: bench.controller.stop_state is StopState.STOPPED, 2.0)


def test_marked_messages_are_read_all_the_same() -> None:
    bench = bench_with(typed_message_marked=True)
    assert bench.ask("CW 1") == ""
    works(bench)


def test_a_file_that_is_no_profile_is_said_at_once(tmp_path: Path) -> None:
    path = tmp_path / "p.toml"
    path.write_text("speed = 5\n")
    with pytest.raises(ProfileUnreadable, match="there is no setting speed"):
        Controller.connect("simulator:ssc1", profile=path)
    path.write_text(profile_text(Profile(program_end="nothing")))
    controller = Controller.connect("socket://127.0.0.1:1", profile=path)
    try:
        assert not controller.link.wire.manners.upload_marked
    finally:
        controller.close()
