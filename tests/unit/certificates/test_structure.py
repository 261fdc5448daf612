"""Who knows whom: a file is decided about without what searches."""

import subprocess
import sys

import grimp
import pytest

ROOM = "wspd_design.certificates"


@pytest.fixture(scope="module")
def graph():
    return grimp.build_graph("wspd_design", include_external_packages=True, cache_dir=None)


def test_replay_knows_neither_search_nor_checks(graph):
    chains = [
        graph.find_shortest_chain(f"{ROOM}.replay", name)
        for name in _below(graph, "search", "checks", "suite")
    ]
    assert not any(chains)


@pytest.mark.parametrize("heavy", ["casadi", "scipy", "cvxpy", "crival", "ival", "control"])
def test_theorems_import_nothing_that_only_a_search_needs(graph, heavy):
    importers = graph.find_modules_that_directly_import(heavy) if heavy in graph.modules else set()
    # Corners that Qhull finds are hints alone: a wrong one makes a bound larger.
    importers -= {f"{ROOM}.theorems.from_rolling.support"} if heavy == "scipy" else set()
    assert not importers & _below(graph, "theorems", "replay")


def test_an_arrow_back_up_would_be_seen(graph):
    """Plant the fault: a theorem that imports what searches."""
    graph.add_import(importer=f"{ROOM}.theorems.theorem", imported=f"{ROOM}.search.settle")
    assert graph.find_shortest_chain(f"{ROOM}.replay", f"{ROOM}.search.settle")
    graph.remove_import(importer=f"{ROOM}.theorems.theorem", imported=f"{ROOM}.search.settle")


def test_at_run_time_a_file_is_decided_about_without_what_searches():
    program = (
        "import sys, wspd_design.certificates.replay\n"
        "print([name for name in sys.modules if name.startswith(('wspd_design.certificates.search', "
        "'wspd_design.certificates.checks', 'casadi', 'cvxpy', 'scipy', 'ival', 'crival', 'sympy'))])"
    )
    found = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "[]"


def _below(graph, *rooms):
    roots = {f"{ROOM}.{room}" for room in rooms}
    return {
        name for name in graph.modules if any(name == root or name.startswith(f"{root}.") for root in roots)
    }
