"""The example of docs/contact.md runs and its numbers are those it states."""

import re
from pathlib import Path

import pytest

PAGE = (Path(__file__).parents[2] / "docs" / "contact.md").read_text()


def test_example():
    (example,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    names = {}
    exec(example, names)
    assert names["load"] == pytest.approx(94.2e3, rel=1e-3)
    assert 0.3 * names["load"] < names["along"] < 0.5 * names["load"]
    assert 0.0 < names["across"] < 0.1 * names["along"]
