"""The pytest plugin: fixture ``wspd``, marker ``wspd``, figures for JUnit, and short words for mistakes of users.

pytest loads this module in every run where the program is installed, so that it imports nothing heavy.
"""

import sys
from collections.abc import Generator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from wspd_design.testing.running import SAMPLED, SEARCHED, Running, running

if TYPE_CHECKING:
    from wspd_design.certificates.records import Certificate
    from wspd_design.simulation.campaign import Campaign

MARKER = "wspd"
_STATUSES = ("proved", "evidence", "limitation", "refuted")
_OPTIONS = ("vehicle", "rail", "effort")
_SIGNATURE = (
    f"{MARKER}(design, {', '.join(f'{each}=[]' for each in _STATUSES)}, vehicle=None, rail=None, effort=1.0)"
)
_PACKAGE = Path(__file__).parents[1]


@dataclass(frozen=True, slots=True, kw_only=True)
class Expected:
    """What one line of a marked test states."""

    design: Any
    check: str
    status: str  # one of those that the marker takes
    options: dict[str, Any]


class Wspd:
    """Assertions about designs, whose files are named from the folder of the test file."""

    def __init__(self, expected: Expected | None) -> None:
        self._expected = expected

    def assert_certified(self, design: Any, *names: str, **options: Any) -> "tuple[Certificate, ...]":
        """Assert that checks succeed: :func:`wspd_design.testing.assert_certified`."""
        from wspd_design.testing import stability

        __tracebackhide__ = True
        return stability.assert_certified(design, *names, **options)

    def assert_refuted(self, design: Any, *names: str, **options: Any) -> "tuple[Certificate, ...]":
        """Assert that checks are refuted: :func:`wspd_design.testing.assert_refuted`."""
        from wspd_design.testing import stability

        __tracebackhide__ = True
        return stability.assert_refuted(design, *names, **options)

    def assert_stops(self, design: Any, **options: Any) -> "Campaign":
        """Assert that drawn stops keep limits: :func:`wspd_design.testing.assert_stops`."""
        from wspd_design.testing import stops

        __tracebackhide__ = True
        return stops.assert_stops(design, **options)

    def hold(self) -> None:
        """Assert what the marker of this test states about one check."""
        from wspd_design.certificates.records import Status
        from wspd_design.parameters.errors import UserError

        __tracebackhide__ = True
        given = self._expected
        if given is None:
            raise UserError(
                f'this test has no marker; write @pytest.mark.{MARKER}("mine.toml", proved=["reaching"])'
            )
        match given.status:
            case "refuted":
                self.assert_refuted(given.design, given.check, **given.options)
            case "limitation":
                self.assert_certified(given.design, given.check, limitation=True, **given.options)
            case status:
                least = Status[status.upper()]
                self.assert_certified(given.design, given.check, at_least=least, **given.options)


def pytest_configure(config: pytest.Config) -> None:
    """Register the marker."""
    config.addinivalue_line(
        "markers", f"{_SIGNATURE}: one line a check; the test takes the fixture wspd and calls wspd.hold()"
    )


@pytest.fixture
def wspd(request: pytest.FixtureRequest) -> Wspd:
    """Assertions about designs of wspd_design; files are named from the folder of the test file."""
    return Wspd(getattr(request, "param", None))


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Make one test of each check that a marker names."""
    marker = metafunc.definition.get_closest_marker(MARKER)
    if marker is None or "wspd" not in metafunc.fixturenames:
        return
    expected = _expected(marker)
    metafunc.parametrize("wspd", expected, indirect=True, ids=[each.check for each in expected])


def _expected(marker: pytest.Mark) -> list[Expected]:
    """Read a marker; a mistake is told without a way through the program."""
    wrong = [key for key in marker.kwargs if key not in (*_STATUSES, *_OPTIONS)]
    lists = {key: marker.kwargs.get(key, []) for key in _STATUSES}
    if len(marker.args) != 1 or wrong or any(isinstance(names, str) for names in lists.values()):
        said = f"; {wrong[0]} is none of its words" if wrong else ""
        raise pytest.Collector.CollectError(f"the marker is {_SIGNATURE}{said}")
    options = {key: marker.kwargs[key] for key in _OPTIONS if key in marker.kwargs}
    found = [
        Expected(design=marker.args[0], check=name, status=status, options=options)
        for status, names in lists.items()
        for name in names
    ]
    if not found:
        raise pytest.Collector.CollectError(f'the marker {MARKER} names no check; write proved=["reaching"]')
    return found


# Hook wrappers of the older kind, which every pytest from 7 on takes: no unrelated project stops at this plugin.
@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_protocol(item: pytest.Item) -> Generator[None, Any, None]:
    """Let assertions know the folder of the test and where its figures go."""
    with running(Running(folder=item.path.parent, record=lambda *each: item.user_properties.append(each))):
        yield


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport(item: pytest.Item, call: pytest.CallInfo[None]) -> Generator[None, Any, None]:
    """Show a mistake of the user as a sentence with the line that it is in."""
    outcome = yield
    _shorten(outcome.get_result(), call.excinfo, item.config)


@pytest.hookimpl(hookwrapper=True)
def pytest_make_collect_report(collector: pytest.Collector) -> Generator[None, Any, None]:
    """Do the same for what a test file does when it is read."""
    outcome = yield
    report = outcome.get_result()
    call = getattr(report, "call", None)
    _shorten(report, None if call is None else call.excinfo, collector.config)


def _shorten(report: Any, caught: pytest.ExceptionInfo[BaseException] | None, config: pytest.Config) -> None:
    if caught is not None and _is_mistake(caught) and not config.getoption("fulltrace"):
        report.longrepr = _short(caught)


def _is_mistake(caught: pytest.ExceptionInfo[BaseException]) -> bool:
    module = sys.modules.get(
        "wspd_design.parameters.errors"
    )  # where it is not loaded, nothing of it was raised
    return module is not None and isinstance(caught.value, module.UserError)


def _short(caught: pytest.ExceptionInfo[BaseException]) -> Any:
    """Leave of the way to a mistake what is outside of this package and of pytest."""

    def outside(entry: Any) -> bool:
        path = Path(str(entry.path))
        return not path.is_relative_to(_PACKAGE) and not {"_pytest", "pluggy", "importlib"} & set(path.parts)

    kept = caught.traceback.filter(outside)
    shown = pytest.ExceptionInfo.from_exc_info((caught.type, caught.value, caught.tb))
    shown.traceback = kept if len(kept) else caught.traceback
    return shown.getrepr(style="short", chain=False)


def pytest_terminal_summary(terminalreporter: Any) -> None:
    """Say which checks were searched, since nothing that is accepted lies beside the design."""
    searched = {
        (name.rpartition("/")[0], str(why))
        for reports in terminalreporter.stats.values()
        for report in reports
        for name, why in getattr(report, "user_properties", ())
        if isinstance(name, str) and name.endswith(f"/{SEARCHED}")
    }
    if not searched:
        return
    terminalreporter.section("wspd: checks that were searched, not only checked again")
    for name, why in sorted(searched):
        terminalreporter.write_line(f"{name.replace('/', ': ')}, {why}")
    if any(why != SAMPLED for _, why in searched):
        terminalreporter.write_line(
            "Keep what is found with wspd certify DESIGN --force, and commit DESIGN.certificates."
        )
