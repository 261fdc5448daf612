"""What a shell is offered after Tab, and the script that asks for it."""

import pytest

from wspd_design.cli.app import run


@pytest.fixture
def offered(monkeypatch, tmp_path, capsys, smc_text):
    """Complete a command line as bash does."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.toml").write_text(smc_text)
    (tmp_path / "law.py").write_text("")
    (tmp_path / "notes.txt").write_text("")

    def complete(line):
        words = line.split(" ")
        monkeypatch.setenv("_WSPD_COMPLETE", "complete_bash")
        monkeypatch.setenv("COMP_WORDS", line)
        monkeypatch.setenv("COMP_CWORD", str(len(words) - 1))
        with pytest.raises(SystemExit):
            run([])
        return capsys.readouterr().out.split()

    return complete


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("wspd ver", ["verify"]),
        ("wspd new ", ["vehicle", "rail"]),
        ("wspd verify --onl", ["--only"]),
        ("wspd verify --only samp", ["sampling", "sampled_invariance"]),
        ("wspd verify --rail polach-", ["polach-dry", "polach-wet"]),
        ("wspd verify --vehicle m", ["metro", "mine.toml"]),
        ("wspd verify m", ["mitsubishi", "mine.toml"]),
        ("wspd simulate l", ["law.py"]),
        ("wspd design --law sm", ["smc"]),
        ("wspd docs own-", ["own-controller"]),
        ("wspd report --requirements en", ["en-15595-like"]),
        ("wspd verify n", ["none"]),
        ("wspd verify --rail nothing", []),
    ],
)
def test_names_and_files_are_offered(line, words, offered):
    assert offered(line) == words


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_each_shell_has_a_script(shell, monkeypatch, capsys):
    monkeypatch.setenv("_WSPD_COMPLETE", f"source_{shell}")
    with pytest.raises(SystemExit):
        run([])
    assert f"complete_{shell}" in capsys.readouterr().out


def test_help_names_the_way_to_it(wspd):
    assert "--install-completion" in wspd("--help").out
