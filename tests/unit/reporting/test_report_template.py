"""The template of a company: what it may hold, and what is refused in one sentence."""

import pytest

from tests.unit.reporting.sample_report import LOGO
from wspd_design.parameters.errors import UserError
from wspd_design.reporting.template import BLANK, Logo, Template, read_template, template_text

PNG = bytes.fromhex(
    "89504e470d0a1a0a0000000d4948445200000001000000010802000000907753de0000000c49444154789c63606060000000040001f61738"
    "550000000049454e44ae426082"
)


@pytest.fixture
def write(tmp_path):
    def written(toml, **files):
        for name, content in files.items():
            (tmp_path / name).write_bytes(content)
        path = tmp_path / "company.toml"
        path.write_text(toml, encoding="utf-8")
        return path

    return written


def test_what_a_template_holds(write):
    path = write('organization = "Bremsen Süd"\nissue = "3"\nlogo = "mark"\n', mark=LOGO)
    assert read_template(path) == Template(
        organization="Bremsen Süd", issue="3", logo=Logo(format="svg", content=LOGO)
    )
    assert read_template(write("")) == BLANK


@pytest.mark.parametrize(("content", "kind"), [(LOGO, "svg"), (PNG, "png")])
def test_its_text_holds_the_logo_and_is_read_without_any_other_file(write, tmp_path, content, kind):
    read = read_template(write('approver = "\U0001f600 \\\\ \\" x"\nlogo = "mark"\n', mark=content))
    assert read.logo is not None
    assert read.logo.format == kind
    text = template_text(read)
    (tmp_path / "mark").unlink()
    assert read_template(write(text)) == read


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('autor = "x"', "unknown key autor in .*; did you mean author?"),
        ("issue = 3", "issue = 3 in .* must be a text of one line and at most 200 characters"),
        (f'author = "{"x" * 201}"', "author = 'xxx.* must be a text of one line"),
        ('author = "a\\nb"', "must be a text of one line"),
        ("logo = 3", "logo = 3 in .* must be the path of a PNG or SVG file"),
        ('logo = "none.svg"', 'logo = "none.svg" in .* cannot be read .*check the path'),
        ('logo = "data:image/png;base64,%%"', "cannot be read"),
        ('logo = "text"', 'logo = "text" in .* is neither PNG nor SVG; save it as one of them'),
        ('logo = "large"', "has 500001 bytes; at most 500000 are allowed"),
        ('logo = "broken"', 'logo = "broken" in .* is damaged .*; save it anew as PNG'),
    ],
)
def test_what_is_refused(write, text, said):
    with pytest.raises(UserError, match=said):
        read_template(write(text, text=b"hello", large=b"x" * 500_001, broken=PNG[:40]))
