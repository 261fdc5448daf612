"""The cache of compiled code and the compilers may fail in any way; the numbers stay right or the failure is named."""

import ctypes
import errno
import os
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from wspd_design.codegen import compiler
from wspd_design.codegen.compiler import NoCompilerError, load_library

SOURCE = "double answer(void) { return 42.0; }\n"


def answer(library):
    library.answer.restype = ctypes.c_double
    return library.answer()


@pytest.fixture
def compilations(monkeypatch):
    """Count how often a compiler was really run."""
    true, count = subprocess.run, []

    def run(command, **options):
        if "-o" in command:
            count.append(command)
        return true(command, **options)

    monkeypatch.setattr(compiler.subprocess, "run", run)
    return count


def replace_by(path, content):
    """Put another file in its place; the one that this process has mapped must not change."""
    path.unlink()
    path.write_bytes(content)


def libraries(cache):
    return sorted(cache.glob("*.so"))


def test_compiled_once_and_kept_for_the_user_alone(cache, compilations):
    assert answer(load_library(SOURCE)) == 42.0
    assert answer(load_library(SOURCE)) == 42.0
    assert len(compilations) == 1
    assert len(libraries(cache)) == 1
    assert cache.stat().st_mode & 0o777 == 0o700
    assert sorted(path.suffix for path in cache.iterdir()) == [
        ".sha256",
        ".so",
    ]  # nothing is left lying about


def test_another_source_is_another_library(cache):
    load_library(SOURCE)
    assert answer(load_library(SOURCE.replace("42", "43"))) == 43.0
    assert len(libraries(cache)) == 2


@pytest.mark.parametrize(
    "damage",
    [
        lambda path: path.unlink(),
        lambda path: replace_by(path, path.read_bytes()[:1000]),
        lambda path: replace_by(path, b""),
        lambda path: replace_by(path, b"\x7fELF" + os.urandom(5000)),
        lambda path: path.with_suffix(".sha256").unlink(),
        lambda path: path.with_suffix(".sha256").write_text("0" * 64),
    ],
    ids=["deleted", "truncated", "empty", "garbage", "no checksum", "wrong checksum"],
)
def test_a_damaged_library_is_compiled_again(cache, compilations, damage):
    load_library(SOURCE)
    (library,) = libraries(cache)
    damage(library)
    assert answer(load_library(SOURCE)) == 42.0
    assert len(compilations) == 2
    assert answer(load_library(SOURCE)) == 42.0  # and what is damaged does not stay in the cache
    assert len(libraries(cache)) == 1


def test_a_deleted_cache_is_made_again(cache, compilations):
    load_library(SOURCE)
    for path in cache.iterdir():
        path.unlink()
    cache.rmdir()
    assert answer(load_library(SOURCE)) == 42.0
    assert len(compilations) == 2


def test_an_unreadable_library_is_compiled_aside(cache, monkeypatch):
    load_library(SOURCE)
    true = Path.read_bytes

    def denied(path):
        if path.parent == cache:
            raise PermissionError(errno.EACCES, "Permission denied", str(path))
        return true(path)

    monkeypatch.setattr(Path, "read_bytes", denied)
    assert answer(load_library(SOURCE)) == 42.0


def test_a_cache_that_cannot_be_made(cache):
    cache.parent.write_text("a file where the folder should be")
    assert answer(load_library(SOURCE)) == 42.0


def test_a_user_without_a_home(cache, monkeypatch):
    def homeless():
        raise RuntimeError("Could not determine home directory.")

    monkeypatch.delenv("XDG_CACHE_HOME")
    monkeypatch.setattr(Path, "home", homeless)
    assert answer(load_library(SOURCE)) == 42.0
    assert not cache.exists()


@pytest.mark.parametrize("where", ["writing the source", "renaming the library"])
def test_a_full_disk(cache, monkeypatch, where):
    def full(*_arguments, **_options):
        raise OSError(errno.ENOSPC, "No space left on device")

    if where == "renaming the library":
        true = os.replace
        monkeypatch.setattr(
            compiler.os, "replace", lambda a, b: full() if Path(b).parent == cache else true(a, b)
        )
    else:
        true_write = Path.write_text
        monkeypatch.setattr(
            Path,
            "write_text",
            lambda path, *a, **o: full() if cache in path.parents else true_write(path, *a, **o),
        )
    assert answer(load_library(SOURCE)) == 42.0
    assert libraries(cache) == []


def test_a_disk_that_is_full_everywhere_is_named(cache, monkeypatch):  # noqa: ARG001
    def full(*_arguments, **_options):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(tempfile, "mkdtemp", full)
    with pytest.raises(NoCompilerError, match=r"cannot be used: .*No space left on device"):
        load_library(SOURCE)


def test_two_processes_compile_at_once(cache):
    program = (
        "import ctypes\nfrom wspd_design.codegen.compiler import load_library\n"
        f"library = load_library({SOURCE!r})\nlibrary.answer.restype = ctypes.c_double\nprint(library.answer())\n"
    )
    environment = {**os.environ, "XDG_CACHE_HOME": str(cache.parent)}
    running = [
        subprocess.Popen(
            [sys.executable, "-c", program],
            env=environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        for _ in range(3)
    ]
    results = [process.communicate(timeout=60) for process in running]
    assert [out for out, _ in results] == ["42.0\n"] * 3, results
    assert len(libraries(cache)) == 1
    assert answer(load_library(SOURCE)) == 42.0


class TestCompilers:
    @pytest.fixture(autouse=True)
    def _own_cache(self, cache):
        """Nothing that another test compiled is found."""

    def choose(self, monkeypatch, command):
        monkeypatch.setenv("CC", command)
        compiler.find_compiler.cache_clear()

    def test_cc_that_does_not_exist_is_passed_over(self, monkeypatch):
        self.choose(monkeypatch, "no-such-compiler")
        assert answer(load_library(SOURCE)) == 42.0

    def test_cc_with_options(self, monkeypatch, compilations):
        self.choose(monkeypatch, f"{shlex.join(compiler.find_compiler())} -DEXTRA=1")
        assert answer(load_library(SOURCE.replace("42.0", "42.0 + EXTRA"))) == 43.0
        assert "-DEXTRA=1" in compilations[0]

    @pytest.mark.parametrize("command", ["false", "true"])
    def test_cc_that_is_no_compiler_is_named(self, monkeypatch, command):
        self.choose(monkeypatch, command)
        with pytest.raises(NoCompilerError, match=rf"the C compiler .*/{command} failed: exit code"):
            load_library(SOURCE)

    def test_cc_that_cannot_be_executed_is_named(self, monkeypatch, tmp_path):
        broken = tmp_path / "broken-cc"
        broken.write_bytes(b"\x00\x01 no program")
        broken.chmod(0o755)
        self.choose(monkeypatch, str(broken))
        with pytest.raises(NoCompilerError, match="broken-cc cannot be used: "):
            load_library(SOURCE)

    def test_what_the_compiler_says_is_told(self):
        with pytest.raises(NoCompilerError, match=r"failed: .*error: "):
            load_library("this is not C\n")

    def test_a_compiler_that_does_not_know_the_machine_gets_plain_flags(
        self, monkeypatch, tmp_path, compilations
    ):
        strict = tmp_path / "strict-cc"
        strict.write_text(
            '#!/bin/sh\ncase "$*" in *-march=native*) echo "unknown -march" >&2; exit 1;; esac\n'
            f'exec {shlex.join(compiler.find_compiler())} "$@"\n'
        )
        strict.chmod(0o755)
        self.choose(monkeypatch, str(strict))
        assert answer(load_library(SOURCE)) == 42.0
        assert len(compilations) == 2

    def test_no_compiler_at_all(self, monkeypatch):
        monkeypatch.delenv("CC", raising=False)
        monkeypatch.setattr(compiler.shutil, "which", lambda _name: None)
        monkeypatch.setattr(compiler, "find_spec", lambda _name: None)
        compiler.find_compiler.cache_clear()
        with pytest.raises(NoCompilerError, match="neither CC nor cc, gcc, clang or ziglang is installed"):
            load_library(SOURCE)


def test_a_library_of_another_machine_is_not_picked_up(cache, monkeypatch):
    load_library(SOURCE)
    before = libraries(cache)
    true = compiler._machine
    monkeypatch.setattr(
        compiler, "_machine", lambda command: true(command).replace("avx2", "").replace("sse2", "")
    )
    assert answer(load_library(SOURCE)) == 42.0
    assert len(libraries(cache)) == len(before) + 1


@pytest.mark.skipif(sys.platform != "linux", reason="the instruction set is read from Linux")
def test_the_instruction_set_is_part_of_the_key():
    machine = compiler._machine(compiler.find_compiler())
    assert "flags" in machine or "Features" in machine


def test_flags_keep_the_arithmetic_of_the_standard(cache):  # noqa: ARG001
    assert not {"-ffast-math", "-Ofast", "-funsafe-math-optimizations"} & {*compiler.FLAGS}
    assert "-ffp-contract=off" in compiler.FLAGS
    library = load_library(SOURCE)
    assert answer(library) == 42.0
    smallest = 5e-324
    assert smallest * 1.0 == smallest  # denormal numbers are not flushed to zero
    assert 1e-310 / 3.0 > 0.0
