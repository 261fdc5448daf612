"""Build the documentation site: ``python docs/site/build.py OUT``, or ``make docs``.

The pages are staged (``stage.py``), rendered by Sphinx with every warning an error, and the result is checked
(``check.py``): each link leads somewhere, and no page asks another host for anything.
"""

import argparse
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

from check import faults
from stage import stage

SITE = Path(__file__).parent


def main() -> int:
    """Build the site and return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("output", type=Path, help="folder of the site; what Sphinx reads goes beside it")
    parser.add_argument("--without-notebooks", action="store_true", help="show the code of notebooks alone")
    arguments = parser.parse_args()
    source = arguments.output.with_name(f"{arguments.output.name}-source")
    stage(source)
    # A notebook that did not run does not know its own language.
    unrun = ["-D", "nb_execution_mode=off", "-D", "suppress_warnings=myst-nb.lexer"]
    options = unrun if arguments.without_notebooks else []
    command = [sys.executable, "-m", "sphinx", "--builder", "html", "--conf-dir", str(SITE)]
    strict = ["--fail-on-warning", "--keep-going", "--quiet", "--fresh-env"]
    print("Sphinx reads the pages and runs the notebooks ...", flush=True)
    words = [*command, *strict, *options, str(source), str(arguments.output)]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if done.returncode != 0:  # else it holds nothing but what kernels of notebooks say about themselves
        print(done.stdout + done.stderr)
        return done.returncode
    found = faults(arguments.output)
    print(*found, sep="\n", end="\n" if found else "")
    if not found:
        print(f"{arguments.output / 'index.html'}: every link leads somewhere, no other host is asked")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
