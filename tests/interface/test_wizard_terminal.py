"""The wizard on a real pseudo-terminal: what stands on the screen of a user."""

import os
import re
import sys
import time
from contextlib import suppress

import pexpect
import pyte
import pytest

ROWS, COLUMNS = 40, 60
PATIENCE = 30.0  # s

pytestmark = [
    pytest.mark.terminal,
    pytest.mark.skipif(not os.path.exists("/dev/ptmx"), reason="this machine has no pseudo-terminals"),
]


class Terminal:
    """A process in a pseudo-terminal, with the screen that its user would see."""

    def __init__(self, arguments, folder, rows, columns, changes):
        root = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
        environment = {k: v for k, v in os.environ.items() if k not in ("COLUMNS", "LINES", "NO_COLOR")}
        self.child = pexpect.spawn(
            sys.executable,
            ["-c", "from wspd_design.cli import main; main()", *arguments],
            cwd=str(folder),
            env=environment | {"TERM": "xterm-256color", "PYTHONPATH": root} | changes,
            dimensions=(rows, columns),
        )
        self.screen = pyte.Screen(columns, rows)
        # prompt_toolkit asks where the cursor is and draws nothing below the prompt until it is told.
        self.screen.write_process_input = self.child.send
        self.stream = pyte.ByteStream(self.screen)

    @property
    def text(self):
        return "\n".join(line.rstrip() for line in self.screen.display)

    def wait_for(self, words):
        """Feed the screen until it shows the words."""
        deadline = time.monotonic() + PATIENCE
        while words not in self.text:
            assert time.monotonic() < deadline, f"no {words!r} on the screen:\n{self.text}"
            try:
                self.stream.feed(self.child.read_nonblocking(4096, timeout=0.2))
            except pexpect.TIMEOUT:
                continue
            except pexpect.EOF:
                assert words in self.text, self.text

    def exit_code(self):
        self.child.expect(pexpect.EOF, timeout=PATIENCE)
        self.stream.feed(self.child.before)
        self.child.close()
        return self.child.exitstatus


@pytest.fixture
def terminal(tmp_path):
    opened = []

    def start(*arguments, rows=ROWS, columns=COLUMNS, **changes):
        opened.append(Terminal(arguments, tmp_path, rows, columns, changes))
        return opened[-1]

    yield start
    for each in opened:
        each.child.close(force=True)


def test_wizard_on_a_screen(terminal, tmp_path):
    screen = terminal()
    screen.wait_for("> er24pc ")
    assert "Ctrl-C leaves and keeps the answers." in screen.text
    screen.child.send("\r")
    screen.wait_for("> polach-wet ")
    screen.child.send("\x1b[A")
    screen.wait_for("> polach-dry ")
    screen.child.send("\r")
    screen.wait_for("> afsmc ")
    screen.child.send("\r")
    screen.wait_for("> 0.03")  # the constant slip that stops shortest on this rail
    screen.wait_for("= 0.03")
    screen.child.send("\x151.4")  # the preview stands right below the number
    screen.wait_for("> 1.4\nslip = 1.4 must lie in (0, 1)")
    screen.child.send("\x1520 %\r")
    screen.wait_for("= 2.778 m/s to 33.33 m/s")
    screen.child.send("\x1b")  # a lonely Esc goes back
    screen.wait_for("> 20 %\n= 0.2")
    screen.child.send("\x03")
    assert screen.exit_code() == 130
    assert "wspd new --resume design.toml.part" in screen.text
    assert 'rail = "polach-dry"' in (tmp_path / "design.toml.part").read_text()


@pytest.mark.parametrize(("rows", "columns"), [pytest.param(24, 80, marks=pytest.mark.reference), (20, 60)])
def test_help_completion_and_the_review(rows, columns, terminal, tmp_path):
    """Own file by Tab, help at ``?``, a note that follows the list, an answer changed in the review, and resumed."""
    (tmp_path / "vehicles").mkdir()
    for name in ("coach7", "coach8"):
        (tmp_path / "vehicles" / f"{name}.toml").write_text('base = "coach"\n')
    screen = terminal("new", rows=rows, columns=columns)
    screen.wait_for("Vehicle  1 of 9")
    screen.child.send("?")
    screen.wait_for("Key of the answer: vehicle.")
    screen.child.send("?\x1b[A")
    screen.child.send("\x1b[A" * 2)
    screen.wait_for("> own file")
    screen.child.send("\r")
    screen.wait_for("File of the vehicle  2 of 10")
    screen.child.send("v\tc\t")
    screen.wait_for("> vehicles/coach\ncoach7.toml  coach8.toml")
    screen.child.send("7\t")
    screen.wait_for("> vehicles/coach7.toml\n= vehicle coach7")
    screen.child.send("\r")
    screen.wait_for("the protection stays")  # polach-wet gives this coach more than it asks for
    screen.child.send("\x1b[A" * 2)
    screen.wait_for("wheels slide without a")
    screen.child.send("\r")
    screen.wait_for("4 of 10")
    screen.child.send("\r" * 6)
    screen.wait_for("Review  10 of 10")
    screen.wait_for("> save")  # drawn after its title
    screen.child.send("\x1b[A" * 3)
    screen.wait_for("> Sample time")
    screen.wait_for("within one")
    screen.child.send("\r")
    screen.wait_for("> 100 ms")
    screen.child.send("\x1520 ms\r")
    screen.wait_for("Sample time          20 ms")
    screen.child.send("\x03")
    assert screen.exit_code() == 130
    resumed = terminal("new", "--resume", "design.toml.part", rows=rows, columns=columns, NO_COLOR="1")
    resumed.wait_for("Review  10 of 10")
    assert {cell.fg for row in resumed.screen.buffer.values() for cell in row.values()} == {"default"}
    resumed.child.send("\r")
    resumed.wait_for("Again:")
    assert resumed.exit_code() == 0
    assert "Written: design.toml" in resumed.text
    assert "sample_time = 0.02" in (tmp_path / "design.toml").read_text()


def test_progress_leaves_no_trace(terminal):
    screen = terminal("simulate", "none", "--speed", "20 km/h")
    assert screen.exit_code() == 0
    assert screen.text.lstrip().startswith("none on polach-wet")
    assert "stop with none" not in screen.text


def test_ctrl_c_keeps_the_stops_that_are_done(terminal, tmp_path):
    screen = terminal("simulate", "none", "--speed", "60 km/h", "--runs", "30000", "-o", "rows.csv")
    screen.wait_for("/30000")
    deadline = time.monotonic() + PATIENCE
    while " 0/30000" in screen.text or "/30000" not in screen.text:
        assert time.monotonic() < deadline, screen.text
        with suppress(pexpect.TIMEOUT):
            screen.stream.feed(screen.child.read_nonblocking(4096, timeout=0.2))
    screen.child.send("\x03")
    assert screen.exit_code() == 130
    said = re.search(r"interrupted after (\d+) of 30000 stops", " ".join(screen.text.split()))
    assert said is not None, screen.text
    rows = (tmp_path / "rows.csv").read_text().splitlines()
    assert len(rows) - 1 == int(said[1])
    assert 0 < int(said[1]) < 30000


def test_vehicle_wizard_on_a_screen(terminal, tmp_path):
    """Question, preview of the derived torque, one wrong unit, back, and the file."""
    screen = terminal("new", "vehicle", "car.toml")
    screen.wait_for("> coach ")
    assert "Ctrl-C leaves and keeps the answers." in screen.text
    screen.child.send("\x1b[B" * 3)
    screen.wait_for("> metro ")
    screen.child.send("\r")
    screen.wait_for("> 36 t\n= 36000 kg")
    screen.child.send("\x1540 kg")
    screen.wait_for("did you mean\n40 t?")
    screen.child.send("\x1540 t\r")
    screen.wait_for("> 60 t\n= 60000 kg")  # as much load in proportion
    screen.child.send("\x15none\r")
    screen.wait_for("= 4 axles in 2 bogies of 2")  # the load-dependent brake is not asked for
    screen.child.send("\x02")
    screen.wait_for("> none\n= none")
    screen.child.send("\r" * 7)
    screen.wait_for("= a torque of")
    assert "asks for an adhesion" in " ".join(screen.text.split())
    screen.child.send("\r")
    screen.wait_for("> electro-pneumatic ")
    screen.child.send("\r" * 5)
    screen.wait_for("> save ")
    screen.child.send("\r")
    screen.wait_for("Written: car.toml")
    assert screen.exit_code() == 0
    assert 'at = "EN 14531 backwards' in (tmp_path / "car.toml").read_text()


def test_rail_wizard_keeps_its_answers(terminal, tmp_path):
    screen = terminal("new", "rail")
    screen.wait_for("> none\n= none")
    screen.child.send("\x15nowhere.csv")
    screen.wait_for("cannot be read")
    screen.child.send("\x15none\r")
    screen.wait_for("> low-adhesion ")
    screen.child.send("\x03")
    assert screen.exit_code() == 130
    assert "wspd new rail --resume rail.toml.part" in screen.text
    assert 'curve = "none"' in (tmp_path / "rail.toml.part").read_text()
