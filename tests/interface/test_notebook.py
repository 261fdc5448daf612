"""The ten lines that must read well in a notebook, run by a real kernel: what it shows below each cell."""

import base64
import re

import pytest

nbformat = pytest.importorskip("nbformat")
nbclient = pytest.importorskip("nbclient")

CELLS = (
    """import wspd_design as wd
loco, rail = wd.load_vehicle("er24pc"), wd.load_rail("polach-wet")
loco""",
    "wd.linearize(loco, rail, slip=0.14, speed_kmh=80)",
    """design = wd.design_controller(loco, rail, wd.Specification(sample_time=0.02), law="smc")
design""",
    """proof = wd.certify(design, only=["gain_positive", "sampling"])
print(proof.table())
proof""",
    """stop = wd.Scenario.stop(from_kmh=60, rail=rail, seed=1)
trial = wd.compare(loco, [design.build(loco, rail), *wd.baselines(loco, rail)], stop)
trial""",
    'trial.plot("slip");',
    """try:
    wd.simulate("er24pc", design, stop)
except wd.UserError as error:
    print(error)""",
)


@pytest.fixture(scope="module")
def outputs(tmp_path_factory):
    """What stands below each cell."""
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(cell) for cell in CELLS])
    folder = str(tmp_path_factory.mktemp("notebook"))
    nbclient.NotebookClient(
        notebook, timeout=120, kernel_name="python3", resources={"metadata": {"path": folder}}
    ).execute()
    return [cell["outputs"] for cell in notebook.cells]


def shown(cell, kind):
    return "".join("".join(each["data"][kind]) for each in cell if kind in each.get("data", {}))


def printed(cell):
    return "".join(each["text"] for each in cell if each["output_type"] == "stream")


@pytest.mark.filterwarnings("ignore")  # of the machinery of kernels
def test_the_ten_lines(outputs):
    assert not [each for cell in outputs for each in cell if each.get("name") == "stderr"]
    for place, title in enumerate(
        (
            "Vehicle er24pc",
            "Linearization of er24pc on polach-wet at slip 0.14 and 80 km/h",
            "Design smc-er24pc-polach-wet",
            "Certificates",
            "er24pc (planar) on polach-wet, from 60 km/h",
        )
    ):
        card = shown(outputs[place], "text/html")
        assert f'<p class="title">{title}</p>' in card
        assert shown(outputs[place], "text/plain").startswith("<")
    assert "2 checks of this closed loop: 1 refuted, 1 proved" in printed(outputs[3])
    assert "<svg" in shown(outputs[1], "text/html")
    assert base64.b64decode(shown(outputs[5], "image/png"))[:8] == b"\x89PNG\r\n\x1a\n"
    assert len([each for each in outputs[5] if "image/png" in each.get("data", {})]) == 1
    assert re.match(r'simulate takes a Vehicle, not the text "er24pc"; load it', printed(outputs[6]))
