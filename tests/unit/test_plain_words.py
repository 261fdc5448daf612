"""Words that were put into plain English do not come back: sentences, names, help, docstrings and pages."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
UNIDIOMATIC = re.compile(
    r"at the begin of|(?<!there )\bis no (number|proof|plant|law|point|sum)\b|broken (exponent|power)|neither shown nor refuted"
    r"|\bmake the design again\b|takes the ground from|\bWishes\b|\bStopWords\b|numbers that are certain"
    r"|all that it needs is proved|found no ground to stand",
    re.IGNORECASE,
)
FOLDERS = ("wspd_design", "derivations", "docs", "tests", "benchmarks")
ENDINGS = (".py", ".md", ".toml", ".html", ".typ")
FILES = [
    path
    for path in (*ROOT.glob("*.md"), *(each for folder in FOLDERS for each in (ROOT / folder).rglob("*.*")))
    if path.suffix in ENDINGS and path != Path(__file__)
]


def test_no_word_of_the_list_is_left():
    assert len(FILES) > 300
    left = [
        f"{path.relative_to(ROOT)}:{number}: {line.strip()}"
        for path in FILES
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1)
        if UNIDIOMATIC.search(line)
    ]
    assert left == []


@pytest.mark.parametrize("sentence", ["1.5 is no number", "at the begin of a stop", "a broken exponent"])
def test_such_a_word_would_be_seen(sentence):
    assert UNIDIOMATIC.search(sentence)
    assert not UNIDIOMATIC.search("is not a number, at the start of a stop, a fractional exponent")
