"""Attack what the certificates of a design say: python -m tests.attack DESIGN CERTIFICATES --evaluations N."""

import argparse
import sys
import time
from pathlib import Path

import numpy as np

from tests.attack.case import AXLE, Case, Stated, read_case, read_stated, with_axles
from tests.attack.claims import GOOD, WHOLE, attacks, untouched
from tests.attack.search import Found, assail


def chosen(case: Case, stated: Stated, wish: str) -> tuple[str, ...]:
    """Return the numbers to vary: those that the file says it varies, all with bounds, none, or a list."""
    bounds = with_axles(case, stated).data.bounds
    if wish == "all":
        return tuple(name for name in bounds if name not in AXLE or name in stated.varied)
    if wish == "stated":
        return tuple(name for name in stated.varied if name in bounds)
    return tuple(name for name in wish.split(",") if name and name != "none")


def assault(
    case: Case,
    files: list[Stated],
    *,
    wish: str,
    evaluations: int,
    seed: int = 0,
    cpu_seconds: float = np.inf,
) -> list[Found]:
    """Attack what files state; the time is an upper limit alone, shared equally by the statements."""
    listed = [each for one in files for each in attacks(case, one, chosen(case, one, wish))]
    found = []
    for k, attack in enumerate(listed):
        share = cpu_seconds / len(listed)
        deadline = time.process_time() + share
        found.append(assail(attack, evaluations=evaluations, seed=seed + k, deadline=deadline))
    return found


def main(arguments: list[str]) -> int:
    """Print evaluations, least margin and counterexample for each statement; 1 if one was violated."""
    parser = argparse.ArgumentParser(prog="python -m tests.attack", description=__doc__)
    parser.add_argument("design", type=Path)
    parser.add_argument("certificates", type=Path)
    parser.add_argument("--vehicle")
    parser.add_argument("--rail")
    parser.add_argument(
        "--varied",
        default="stated",
        help="stated by the file, all numbers with bounds, none, or names with commas",
    )
    parser.add_argument(
        "--free",
        action="append",
        default=[],
        help="NAME=LOW:HIGH in SI units, for example load_share=0.85:1.15",
    )
    parser.add_argument("--only", action="append", help="name of a check")
    parser.add_argument("--evaluations", type=int, default=200_000, help="per statement")
    parser.add_argument("--cpu-seconds", type=float, default=np.inf, help="at most, over all statements")
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args(arguments)
    free = {name: _ends(text) for name, _, text in (each.partition("=") for each in given.free)}
    case = read_case(given.design, vehicle=given.vehicle, rail=given.rail, free=free)
    paths = sorted(given.certificates.glob("*.json"))
    files = [each for each in map(read_stated, paths) if not given.only or each.check in given.only]
    for each in files:
        if each.status in GOOD and each.check in WHOLE:
            print(f"attacked {WHOLE[each.check]}: {each.check}")
        for quantity in untouched(each):
            print(f"not attacked  {each.check}: {quantity}")
    started = time.process_time()
    found = assault(
        case,
        files,
        wish=given.varied,
        evaluations=given.evaluations,
        seed=given.seed,
        cpu_seconds=given.cpu_seconds,
    )
    for each in found:
        verdict = "BROKEN  " if each.broken else "held    " if each.evaluations else "no time "
        print(
            f"{verdict} {each.attack.check}: {each.attack.statement}: least margin {each.margin:.6g} "
            f"{each.attack.unit} in {each.evaluations} points"
        )
        if each.broken:
            print("          at " + ", ".join(f"{name} {value:.6g}" for name, value in each.point.items()))
    print(
        f"{len(found)} statements, {sum(each.evaluations for each in found)} points, "
        f"{sum(each.broken for each in found)} broken, {time.process_time() - started:.0f} s of CPU"
    )
    return int(any(each.broken for each in found))


def _ends(text: str) -> tuple[float, float]:
    low, _, high = text.partition(":")
    return float(low), float(high)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
