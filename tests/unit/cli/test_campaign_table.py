"""One table of several campaigns, of which one has figures that the other has not."""

from types import SimpleNamespace

import numpy as np

from wspd_design.cli.campaign import labelled


def campaign(controller, *columns):
    table = np.ones(3, dtype=[("run", int), *((name, float) for name in columns)])
    return SimpleNamespace(controller=controller, rail="leaves", table=table)


def test_what_a_law_has_not_is_nan():
    blocks = [*labelled([campaign("none", "distance_m"), campaign("own", "speed_error", "distance_m")])]
    table = np.concatenate(blocks)
    assert table.dtype.names == ("controller", "rail", "run", "distance_m", "speed_error")
    assert list(table["controller"]) == ["none"] * 3 + ["own"] * 3
    assert np.isnan(table["speed_error"][:3]).all()
    assert (table["speed_error"][3:] == 1.0).all()
    assert (table["distance_m"] == 1.0).all()
