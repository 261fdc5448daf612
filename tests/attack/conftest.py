"""The four designs that are attacked, and their certificates, made by the program as a user makes them."""

from functools import cache

import pytest

from tests.attack.case import read_case
from wspd_design.cli.app import run

COMMANDS = {
    "smc": ("--law", "smc", "--rail", "polach-wet"),
    "feedback-wet": ("--law", "torque-feedback", "--rail", "polach-wet", "--sample-time", "20 ms"),
    "feedback-dry": ("--law", "torque-feedback", "--rail", "polach-dry", "--sample-time", "20 ms"),
    "adaptive": ("--rail", "polach-wet"),
}
SCHEDULED = (  # what is edited in the adaptive design: rates alpha/v, and a range of slip that the brake can hold
    ("[gains.scheduled_rates]\nvalue = false", "[gains.scheduled_rates]\nvalue = true"),
    ("slips = [0.02, 0.6]", "slips = [0.02, 0.4]"),
)


@pytest.fixture(scope="session")
def design(tmp_path_factory):
    """Make the design file with one of the four names, once."""

    @cache
    def made(name):
        path = tmp_path_factory.mktemp("designs") / f"{name}.toml"
        assert run(["design", *COMMANDS[name], "--output", str(path)]) == 0
        if name == "adaptive":
            text = path.read_text()
            for old, new in SCHEDULED:
                assert old in text
                text = text.replace(old, new)
            path.write_text(text)
        return path

    return made


@pytest.fixture(scope="session")
def certified(design):
    """Certify some checks of a design, once, and return the folder."""

    @cache
    def made(name, checks):
        folder = design(name).with_suffix(f".{'-'.join(checks)}")
        chosen = [word for check in checks for word in ("--only", check)]
        run(["certify", str(design(name)), *chosen, "--output", str(folder), "--force"])
        return folder

    return made


@pytest.fixture(scope="session")
def adaptive_case(design):
    return read_case(design("adaptive"))
