"""The journal of a search: one line for each finished evaluation, so that nothing finished is computed twice.

The first line holds the content key of the search. A line that a killed process left half written is not a line, and
neither is what follows it.
"""

import json
import os
from pathlib import Path

from wspd_design.design.search.methods import Point
from wspd_design.design.search.score import Score, plain_score
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.writing import write_whole

_SCHEMA = "wspd-search-journal/1"


class Journal:
    """Finished evaluations of one search in a file."""

    def __init__(self, path: Path, key: str) -> None:
        self.path, self.replaced = path, False  # whether the file was of another search
        self._key = key
        self._known = self._read()

    def known(self, point: Point) -> Score | None:
        """Return the score of a point that was evaluated before."""
        return self._known.get(point)

    def add(self, point: Point, score: Score) -> None:
        """Keep the score of a point."""
        if point in self._known:
            return
        self._known[point] = score
        line = json.dumps({"point": point, **plain_score(score)})
        try:
            with self.path.open("a", encoding="utf-8") as file:
                file.write(f"{line}\n")
                file.flush()
                os.fsync(file.fileno())
        except OSError as error:
            raise UserError(
                f"{self.path} cannot be written ({error.strerror}); free some space or mend its permissions, and the "
                "same command goes on from there"
            ) from None

    def _read(self) -> dict[Point, Score]:
        """Read the whole lines of this search, and leave a file of just these."""
        try:
            lines = self.path.read_bytes().decode("utf-8", errors="replace").splitlines(keepends=True)
        except FileNotFoundError:
            lines = []
        except OSError as error:
            raise UserError(f"{self.path} cannot be read ({error.strerror}); mend its permissions") from None
        head = json.dumps({"schema": _SCHEMA, "search": self._key}) + "\n"
        self.replaced = bool(lines) and lines[0] != head
        whole = [] if self.replaced else lines[1:]
        found: dict[Point, Score] = {}
        for line in whole:
            if not line.endswith("\n"):
                break
            try:
                entry = json.loads(line)
                found[tuple(map(float, entry["point"]))] = Score(
                    objective=float(entry["objective"]),
                    unstopped=float(entry["unstopped"]),
                    reached={str(name): float(value) for name, value in entry["reached"].items()},
                )
            except (ValueError, TypeError, KeyError, AttributeError):
                break
        text = head + "".join(whole[: len(found)])
        write_whole(self.path, lambda part: part.write_text(text, encoding="utf-8"))
        return found
