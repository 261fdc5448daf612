"""What the completion of a shell offers for names and files."""

from collections.abc import Callable, Iterable

from wspd_design.cli.path_completion import paths

Offers = Callable[[str], list[str]]
"""Takes what was typed, returns what it may become."""


def names(*known: str) -> Offers:
    """Offer names."""
    return lambda incomplete: _starting(known, incomplete)


def names_or_files(known: Iterable[str], *endings: str) -> Offers:
    """Offer names, and paths of files with one of some endings."""
    kept = tuple(known)

    def offers(incomplete: str) -> list[str]:
        found = {path for ending in endings for path in paths(incomplete, ending)}
        return [*_starting(kept, incomplete), *sorted(found)]

    return offers


def checks(incomplete: str) -> list[str]:
    """Offer the names of the checks."""
    from wspd_design.certificates.theorems.table import THEOREMS

    return _starting(THEOREMS, incomplete)


def _starting(known: Iterable[str], incomplete: str) -> list[str]:
    return [each for each in known if each.startswith(incomplete)]
