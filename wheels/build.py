"""Build wheels that hold compiled plants, so that stops are fast without a C compiler.

``python wheels/build.py`` makes those for Linux; names of other platforms may follow. All are cross-compiled with
``python -m ziglang cc`` (``pip install ziglang``). Those for Windows and macOS have never been run.
"""

import argparse
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT))

from wspd_design.codegen.closed_loop import closed_loop_source  # noqa: E402
from wspd_design.codegen.compiler import PORTABLE_FLAGS  # noqa: E402
from wspd_design.codegen.kernels import plant_kernels  # noqa: E402
from wspd_design.codegen.prebuilt import CPU_LEVEL, library_name  # noqa: E402
from wspd_design.parameters.files import available  # noqa: E402
from wspd_design.parameters.loading import load_vehicle  # noqa: E402
from wspd_design.plants.locomotive import LinearLocomotive, Locomotive  # noqa: E402
from wspd_design.plants.names import plant_of  # noqa: E402
from wspd_design.plants.planar import Planar  # noqa: E402
from wspd_design.plants.quarter import Quarter  # noqa: E402
from wspd_design.simulation.batch import STOPS_SIDE_BY_SIDE  # noqa: E402

AXLES = {Planar.name: (4, 6, 8, 12), Quarter.name: (1, 2, 4, 6, 8, 12)}
"""Numbers of axles on two-axle bogies whose plants are built, beside those of all shipped vehicles.

Others need a compiler on the machine that simulates them.
"""

X86_64 = {"x86-64": "x86_64", "x86-64-v3": "x86_64_v3", "x86-64-v4": "x86_64_v4"}
ARM64 = {"arm64": "generic"}


@dataclass(frozen=True, slots=True, kw_only=True)
class Platform:
    """What a wheel is built for."""

    triple: str  # for zig
    suffix: str
    targets: Mapping[str, str]  # instruction set -> its name for zig


PLATFORMS = {
    "manylinux2014_x86_64": Platform(triple="x86_64-linux-gnu.2.17", suffix=".so", targets=X86_64),
    "manylinux2014_aarch64": Platform(triple="aarch64-linux-gnu.2.17", suffix=".so", targets=ARM64),
    # Without the instruction, MinGW's fma() rounds twice: a processor without it takes the virtual machine.
    "win_amd64": Platform(
        triple="x86_64-windows-gnu", suffix=".dll", targets={k: v for k, v in X86_64.items() if k != "x86-64"}
    ),
    "macosx_11_0_x86_64": Platform(triple="x86_64-macos.11.0", suffix=".dylib", targets=X86_64),
    "macosx_11_0_arm64": Platform(triple="aarch64-macos.11.0", suffix=".dylib", targets=ARM64),
}
LINUX = tuple(name for name in PLATFORMS if "linux" in name)
ZIG = (sys.executable, "-m", "ziglang", "cc")
SETUP = """from setuptools import Distribution, setup
from setuptools.command.bdist_wheel import bdist_wheel


class Binary(Distribution):
    def has_ext_modules(self):
        return True


class Wheel(bdist_wheel):
    def get_tag(self):
        return "py3", "none", "{platform}"


setup(distclass=Binary, cmdclass={{"bdist_wheel": Wheel}})
"""


def plant_sources() -> Iterator[tuple[str, int]]:
    """Sources of all plants that are built, with their number of stops side by side; each source once.

    Those with all degrees of freedom are large: of them one stop alone is built, without the vibration of the pads.
    """
    plain = load_vehicle("er24pc")
    plants = [
        plant_of(name, replace(plain, wheelsets=axles))
        for name, numbers in AXLES.items()
        for axles in numbers
    ]
    plants += [plant_of(name, load_vehicle(vehicle)) for vehicle in available("vehicle") for name in AXLES]
    found = {
        closed_loop_source(plant_kernels(plant, disturbed=disturbed), stops=stops): stops
        for plant, disturbed, stops in product(plants, (False, True), (1, STOPS_SIDE_BY_SIDE))
    }
    whole = [
        plant_of(kind.name, vehicle)
        for vehicle in map(load_vehicle, available("vehicle"))
        if vehicle.multibody
        for kind in (Locomotive, LinearLocomotive)
    ]
    yield from (
        found | {closed_loop_source(plant_kernels(each, disturbed=False), stops=1): 1 for each in whole}
    ).items()


def compile_plants(platform: Platform, folder: Path) -> None:
    """Compile all plants for all instruction sets of a platform."""
    cc = (*ZIG, "-target", platform.triple, "-Wno-pass-failed")

    def build(source: str, name: str, *options: str) -> None:
        text = folder / f"{name}.c"
        text.write_text(source, encoding="utf-8")
        output = str(folder / f"{name}{platform.suffix}")
        subprocess.run(
            [*cc, *options, *PORTABLE_FLAGS, str(text), "-o", output, "-lm", "-s"],
            check=True,
        )
        text.unlink()

    with ThreadPoolExecutor(max_workers=2) as pool:
        jobs = []
        for (source, stops), (target, cpu) in product(plant_sources(), platform.targets.items()):
            # One stop fills half of the widest vectors, and they would only delay what the next stage waits for.
            width = ("-mprefer-vector-width=512",) if target == "x86-64-v4" and stops > 1 else ()
            jobs.append(pool.submit(build, source, library_name(source, target), f"-mcpu={cpu}", *width))
        for job in jobs:
            job.result()
    if platform.triple.startswith("x86_64"):
        template = ROOT / "wspd_design" / "codegen" / "templates" / "cpu_level.c"
        build(template.read_text(encoding="utf-8"), CPU_LEVEL, "-mcpu=x86_64")
    for other in folder.glob("*.lib"), folder.glob("*.pdb"):
        for path in other:
            path.unlink()


def build_wheel(name: str, output: Path) -> None:
    """Build the wheel of a platform from a copy of the package."""
    with tempfile.TemporaryDirectory(prefix="wspd-wheel-") as folder:
        copy = Path(folder)
        for file in ("pyproject.toml", "README.md", "LICENSE", "CHANGELOG.md"):
            shutil.copy(ROOT / file, copy)
        ignored = shutil.ignore_patterns("__pycache__", "prebuilt")
        shutil.copytree(ROOT / "wspd_design", copy / "wspd_design", ignore=ignored)
        shutil.copytree(ROOT / "docs", copy / "docs")
        prebuilt = copy / "wspd_design" / "codegen" / "prebuilt"
        prebuilt.mkdir()
        compile_plants(PLATFORMS[name], prebuilt)
        (copy / "setup.py").write_text(SETUP.format(platform=name), encoding="utf-8")
        command = [
            sys.executable,
            "-m",
            "pip",
            "wheel",
            "--no-deps",
            "--quiet",
            "--wheel-dir",
            str(output),
            str(copy),
        ]
        subprocess.run(command, check=True)
        print(f"{name}: {len(list(prebuilt.iterdir()))} libraries")


def main() -> None:
    """Build the wheels that are named, those for Linux by default."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("platforms", nargs="*", choices=(*PLATFORMS, []), help="default: those for Linux")
    parser.add_argument("--output", type=Path, default=ROOT / "dist")
    arguments = parser.parse_args()
    for name in arguments.platforms or LINUX:
        build_wheel(name, arguments.output)


if __name__ == "__main__":
    main()
