"""One version everywhere, and a release date in the citation only when the changelog gives the same one."""

import re
import shutil
import subprocess
import tomllib
from importlib.metadata import version
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
HEADING = re.compile(r"^## (?P<version>\S+) \((?P<date>[^)]+)\)$", re.MULTILINE)
RELEASED = re.compile(r"^date-released: (?P<date>\S+)$", re.MULTILINE)


def release_dates(citation: str, changelog: str) -> tuple[str, str]:
    """Return the dates that both files state for the newest version; unreleased where there is none."""
    cited, newest = RELEASED.search(citation), HEADING.search(changelog)
    assert newest is not None
    return (cited["date"] if cited else "unreleased"), newest["date"]


def test_citation_and_changelog_state_one_release():
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    cited, stated = release_dates(citation, (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"))
    assert cited == stated
    early, _ = release_dates(citation + "date-released: 2026-11-22\n", "## 0.1.0 (unreleased)\n")
    assert early != "unreleased"


def test_one_version():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["version"]
    changelog = HEADING.search((ROOT / "CHANGELOG.md").read_text(encoding="utf-8"))
    assert changelog is not None
    assert changelog["version"] == project == version("wspd_design")
    assert f"\nversion: {project}\n" in (ROOT / "CITATION.cff").read_text(encoding="utf-8")


def wrong_tags(tags: list[str], project: str) -> list[str]:
    """Return the tags of a version that state another one."""
    return [tag for tag in tags if re.fullmatch(r"v\d.*", tag) and tag != f"v{project}"]


@pytest.mark.skipif(shutil.which("git") is None, reason="no git: nothing is known about tags")
def test_a_tag_at_this_commit_states_this_version():
    git = ["git", "-C", str(ROOT), "tag", "--points-at", "HEAD"]
    tags = subprocess.run(git, capture_output=True, text=True, check=False).stdout.split()
    assert wrong_tags(tags, version("wspd_design")) == []
    assert wrong_tags(["v0.0.9", "v0.1.0", "nightly"], "0.1.0") == ["v0.0.9"]
