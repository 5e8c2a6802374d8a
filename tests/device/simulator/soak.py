"""Random programs, operators and hosts for a simulated controller, and how it is brought back to rest."""

from __future__ import annotations

import random
import re

from codegen.models import model
from device.simulator.plant import Plant
from device.simulator.simulation import Simulation
from tests.device.simulator.bench import MS
from tests.device.simulator.test_fuzz import LEAVE, QUIET, command

FRAME = re.compile("\x1e([a-z0-9]{2})([ -][0-9]{10})\x1f\r\n")
ROUTINES = {
    "LIMSWI": 'MG "LIMIT";RE1',
    "POSERR": "V3=V3+1;RE",
    "ININT": "V4=V4+1;RI1",
    "MCTIME": 'MG "LATE";EN',
    "CMDERR": "V5=_TC;ZS0;EN",
    "COMINT": "V6=P2CD;V7=P2NM;EN1,1",
}
STEPS = [
    "PR {far},{near}",
    "SP {fast},{fast}",
    "AC {rate}",
    "BGX",
    "BGY",
    "AMX",
    "AMXY",
    "MCX",
    "BGXY;AMXY",
    "WT {short}",
    "AT 0;AT {short}",
    "STX",
    "JG {near};BGX;WT {short};STX;AMX",
    "FEX;BGX;WT {short};STX;AMX",
    "DP 0,0",
    "GA X;GR ,{ratio}",
    "GR ,0",
    "LM XY;LI {near},{near};LI {far},{near};LE;BGS;AMS",
    "VM XY;CR 500,0,360;VP {near},{near};VE;BGS;AMS",
    "IT {ratio}",
    "ER {fast};OE 1",
    "SHXY",
    "MOX",
    "V1=V1+{ratio}",
    "V2=@SIN[V1]*{far}",
    "V2=@RND[V1*{near}/7]",
    "A[{index}]=_TPX",
    "A[{index}]=V2&255|A[{index}]",
    'MG "AT ",_RPX{{F8.0}},{{^32}},V1{{F4.2}}',
    'MG{{P2}}"POSITION",_TPX{{F8.0}}',
    'MG "NO END",V1{{N}}',
    "V1=",
    "TPXY",
    "SB {bit};CB {bit}",
    "OP {byte}",
    "AI {bit}",
    "II {bit}",
    "CI ,2",
    "CI ,-1",
    "JS #S1",
    "JP #L{label},V1<{short}",
    "JP #L{label},_BGX=1",
    "XQ #T{thread},{thread}",
    "HX {thread}",
    "RA A[];RD _TPX;RC 3",
    "CM X;DT 4;CD {near};WC;CD 0;DT 0;CD 0",
    "TR {flag}",
    "EO {flag}",
    "LZ {flag}",
    "CW ,{flag}",
    "SP 999999999",
]


def step(chance: random.Random) -> str:
    """One line of a program."""
    return chance.choice(STEPS).format(
        far=chance.randint(-60000, 60000),
        near=chance.randint(-900, 900),
        fast=chance.randint(100, 30000),
        rate=chance.randint(1, 900) * 1024,
        short=chance.randint(1, 300),
        ratio=round(chance.uniform(0.01, 1), 2),
        index=chance.randint(0, 10),
        bit=chance.randint(1, 8),
        byte=chance.randint(0, 255),
        flag=chance.randint(0, 1),
        label=chance.randint(0, 3),
        thread=chance.randint(0, 3),
    )


def program(chance: random.Random, columns: int) -> list[str]:
    """A program of four threads, a subroutine and some automatic routines; not all of it makes sense."""
    lines = []
    for thread in range(4):
        lines += [f"#T{thread}", *(step(chance) for _ in range(chance.randint(1, 12)))]
        lines += [f"#L{thread}", *(step(chance) for _ in range(chance.randint(1, 6)))]
        lines += [chance.choice([f"JP #T{thread}", f"WT 20;JP #T{thread}", "EN", f"JP #L{thread},V1<50"])]
    lines += ["EN", "#S1", step(chance), "EN"]
    for name, text in ROUTINES.items():
        if chance.random() < (0.9 if name == "CMDERR" else 0.5):
            lines += [f"#{name}", text]
    return [line[:columns] for line in lines]


class Soak:
    """A controller that is never left in peace; every answer it owes is looked for."""

    def __init__(self, seed: int, name: str = "ssc2") -> None:
        self.chance = random.Random(seed)
        plant = Plant(viscous_friction=0.003, forward_limit=50_000, reverse_limit=-50_000, home_switch=(900, 1000))
        self.simulation = Simulation(model(name), {"X": plant, "Y": plant}, seed=seed)
        self.episodes = self.answers = 0
        self.looks = self.busy = 0  # how often it was looked at, and found at work

    @property
    def seconds(self) -> float:
        """Virtual seconds so far."""
        return self.simulation.ticks / (1000 * MS)

    def wait(self, ms: float) -> str:
        self.simulation.advance(round(ms * MS))
        self.simulation.transmit(2)
        self.simulation.rest(200)
        return bytes(byte & 0x7F for byte in self.simulation.transmit(1)).decode("ascii")

    def type(self, text: str, ms: float, port: int = 1) -> str:
        self.simulation.receive(port, text.encode("latin-1"))
        return self.wait(ms)

    def episode(self) -> None:
        """A program is downloaded, runs while everybody interferes, and is stopped."""
        chance = self.chance
        answer = self.type("DL\r" + "\r".join(program(chance, self.simulation.model.columns)) + "\r\\", 60)
        assert answer.endswith(":"), answer
        self.type("OE 0,0;ER 9000,9000;SHXY;DP 0,0;V1=0;V3=0;V4=0;V5=0;V6=0;DM A[10]\r", 20)
        self.type("XQ #T0;XQ #T1,1\r", 10)
        for _ in range(chance.randint(3, 12)):
            self.wait(chance.choice([1, 30, 300, 3000]))
            if not self.simulation.unit.running():
                self.type("SHXY;XQ #T0;XQ #T1,1\r", 10)
            self.looks += 1
            self.busy += self.simulation.unit.running() or self.simulation.unit.moving()
            chance.choice([self.host, self.operator, self.machine, self.noise, self.read])()
        self.rest()
        self.episodes += 1

    def host(self) -> None:
        """A command line, as a person at the terminal types it."""
        self.type(command(self.chance) + "\r", self.chance.choice([0, 2, 20]))

    def operator(self) -> None:
        """Keys at port 2."""
        self.type(self.chance.choice(["\x16", "\x17", "12.5\r", "S", "X", "\r", "-3\r", "AB\r", "\x1b"]), 5, port=2)

    def machine(self) -> None:
        """Switches, inputs, pushes."""
        signal = self.chance.choice(["in1", "in2", "in5", "abort", "home_x", "fls_x", "position_x", "an1"])
        value = {"position_x": self.chance.randint(-300, 300), "an1": self.chance.uniform(-10, 10)}.get(
            signal, self.chance.randint(0, 1)
        )
        self.simulation.stimulus(signal, value)

    def noise(self) -> None:
        """Characters of no meaning, on either port."""
        text = "".join(chr(self.chance.choice([self.chance.randrange(256), 13, 59])) for _ in range(30))
        self.type(text, 20, port=self.chance.choice([1, 2]))

    def read(self) -> None:
        """What the link asks all the time; whether it is answered now depends on what the host has done."""
        self.type('MG{^30},"zz",_TPX{F10.0},{^31}\r', 20)

    def rest(self) -> None:
        """Whatever state it is in, it stops, answers in frames and is well."""
        self.simulation.stimulus("abort", 1)
        recovery = f"{LEAVE}%{self.simulation.unit.address}\r{QUIET}"
        for _ in range(2):
            self.type(recovery, 1500)
        self.type("EO 0;TR 0;CW 2,0;CI 0,0,0\r", 30)
        assert not self.simulation.unit.running()
        assert not self.simulation.unit.moving()
        mark = f"{self.episodes % 1296 // 36:x}"[-1] + "k"
        assert self.type(f"V9={self.episodes}-7\r", 30) == ":"
        answer = self.type(f'MG{{^30}},"{mark}",V9{{F10.0}},{{^31}}\r', 30)
        found = FRAME.fullmatch(answer[:-1])
        assert found is not None and answer[-1] == ":", answer
        assert found.group(1) == mark
        assert int(found.group(2).replace(" ", "")) == self.episodes - 7
        self.answers += 1
