"""The store of a campaign: what is in it is not computed again, and what is not what was written is seen."""

import io

import numpy as np
import pytest

from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_entries, load_rail
from wspd_design.simulation import campaign, campaign_rows, parquet
from wspd_design.simulation.campaign import CHUNK, simulate_many
from wspd_design.simulation.campaign_store import Store
from wspd_design.simulation.draws import within_bounds
from wspd_design.simulation.records import Scenario

COUNT = 2 * CHUNK + 5


@pytest.fixture(scope="module")
def made(er24pc, make_controller):
    """Simulate a campaign with a store."""
    law = make_controller("trenitalia")
    stop = Scenario(rail=load_rail("polach-wet"), initial_speed=3.0, seed=2)
    bounds = within_bounds(load_entries("vehicle", "er24pc"))

    def simulated(store, **options):
        chosen = {"count": COUNT, "draws": bounds, "check_every": 0, **options}
        return simulate_many(er24pc, law, stop, store=store, **chosen)

    return simulated


@pytest.fixture(scope="module")
def plain(made):
    return made(None)


@pytest.fixture
def computed(monkeypatch):
    """First runs of the chunks that are computed."""
    seen, true = [], campaign_rows.compute_rows

    def counting(plan, first, count):
        seen.append(first)
        return true(plan, first, count)

    monkeypatch.setattr(campaign, "compute_rows", counting)
    return seen


def files(store):
    return sorted(store.iterdir())


def test_a_finished_campaign_is_read_back(made, plain, computed, tmp_path):
    first = made(tmp_path / "store")
    assert sorted(computed) == [0, CHUNK, 2 * CHUNK]
    assert first.table.tobytes() == plain.table.tobytes()
    computed.clear()
    again = made(tmp_path / "store")
    assert computed == []
    assert again.table.tobytes() == plain.table.tobytes()
    assert again.remade == ()


def test_what_is_missing_is_computed(made, plain, computed, tmp_path):
    made(tmp_path)
    (lost,) = tmp_path.glob(f"*-{CHUNK:010d}-*.parquet")
    lost.unlink()
    computed.clear()
    assert made(tmp_path).table.tobytes() == plain.table.tobytes()
    assert computed == [CHUNK]


def test_parts_fill_one_store(made, plain, computed, tmp_path):
    for number in (3, 1, 2):
        first, count = campaign.shard(COUNT, number, 3)
        made(tmp_path, first=first, count=count)
    assert sorted(computed) == [0, CHUNK, 2 * CHUNK]
    computed.clear()
    assert made(tmp_path).table.tobytes() == plain.table.tobytes()
    assert computed == []


def truncated(content):
    return content[: len(content) // 2]


def flipped(content):
    middle = len(content) // 3
    return content[:middle] + bytes([content[middle] ^ 1]) + content[middle + 1 :]


def other_rows(content):
    """A whole file with the marks of the true one and one number changed."""
    source = io.BytesIO(content)
    columns = [("run", "i8"), ("seed", "i8")]
    from pyarrow import parquet as arrow

    names = arrow.ParquetFile(source).schema_arrow.names
    columns = [(n, "i8" if n in ("run", "seed") else "?" if n == "stopped" else "f8") for n in names]
    rows, marks = parquet.read_rows(io.BytesIO(content), columns)
    rows["distance_m"][3] = np.nextafter(rows["distance_m"][3], 0.0)
    return parquet.rows_as_parquet(rows, marks)


DAMAGED, CHANGED = "is damaged or not a file of rows", "holds other rows than were written"


@pytest.mark.parametrize(
    ("spoil", "why"),
    [
        (truncated, DAMAGED),
        (flipped, ""),
        (lambda _content: b"", DAMAGED),
        (lambda _content: b"run,seed\n1,2\n", DAMAGED),
        (other_rows, CHANGED),
    ],
    ids=["truncated", "a bit flipped", "empty", "text", "other rows"],
)
def test_a_spoilt_file_is_made_anew(made, plain, computed, tmp_path, spoil, why):
    made(tmp_path)
    before = {path: path.read_bytes() for path in files(tmp_path)}
    victim = files(tmp_path)[1]
    victim.write_bytes(spoil(before[victim]))
    computed.clear()
    again = made(tmp_path)
    assert computed == [CHUNK]
    (sentence,) = again.remade
    assert sentence.startswith(f"{victim} ")
    assert sentence.endswith("; its stops are simulated anew")
    assert why in sentence
    assert again.table.tobytes() == plain.table.tobytes()
    assert {path: path.read_bytes() for path in files(tmp_path)} == before


def test_a_file_of_another_campaign_is_seen(made, plain, tmp_path):
    made(tmp_path)
    mine = files(tmp_path)[0]
    made(tmp_path / "other", check_every=1000)
    other = files(tmp_path / "other")[0]
    assert mine.name != other.name  # campaigns share a folder
    mine.write_bytes(other.read_bytes())
    again = made(tmp_path)
    assert [sentence.partition(";")[0] for sentence in again.remade] == [
        f"{mine} belongs to another campaign"
    ]
    assert again.table.tobytes() == plain.table.tobytes()


def test_a_key_is_that_of_all_a_row_depends_on(er24pc, make_controller, monkeypatch):
    stop = Scenario(rail=load_rail("polach-wet"), initial_speed=3.0, seed=2)
    bounds = within_bounds(load_entries("vehicle", "er24pc"))
    base = {"plant": "planar", "draws": bounds, "check_every": 5}

    def key(law="trenitalia", scenario=stop, sample_time=0.1, **changes):
        controller = make_controller(law, sample_time=sample_time)
        return campaign_rows.plan_key(
            campaign_rows.make_plan(er24pc, controller, scenario, **{**base, **changes})
        )

    mine = key()
    assert key() == mine
    others = {
        key("none"),
        key(sample_time=0.05),
        key(plant="quarter"),
        key(draws=bounds[:-1]),
        key(check_every=6),
        key(scenario=Scenario(rail=load_rail("polach-dry"), initial_speed=3.0, seed=2)),
        key(scenario=Scenario(rail=load_rail("polach-wet"), initial_speed=3.0, seed=3)),
    }
    monkeypatch.setattr(campaign_rows, "program_fingerprint", lambda: "another program")
    others.add(key())
    assert len(others) == 8
    assert mine not in others


def test_a_worker_with_another_program_is_refused(er24pc, make_controller, monkeypatch):
    stop = Scenario(rail=load_rail("polach-wet"), initial_speed=3.0)
    plan = campaign_rows.make_plan(
        er24pc, make_controller("none"), stop, plant="quarter", draws=(), check_every=0
    )
    monkeypatch.setattr(campaign_rows, "program_fingerprint", lambda: "another program")
    with pytest.raises(UserError, match="a worker has another version of wspd_design"):
        campaign_rows.compute_rows(plan, 0, 1)


def test_what_killed_writers_left_is_removed(made, tmp_path):
    made(tmp_path)
    name = files(tmp_path)[0].name
    (tmp_path / f".{name}.xyz.part").write_bytes(b"half")
    (tmp_path / ".0123456789abcdef-0-1.parquet.xyz.part").write_bytes(b"of another campaign")
    made(tmp_path)
    left = [path.name for path in files(tmp_path) if path.suffix == ".part"]
    assert left == [".0123456789abcdef-0-1.parquet.xyz.part"]


def test_a_store_that_cannot_be_is_refused(made, tmp_path):
    (tmp_path / "file").write_text("")
    for folder in (tmp_path / "file", tmp_path / "no" / "store"):
        with pytest.raises(UserError, match=r"store .* cannot be made \((File exists|No such file)"):
            made(folder)


def test_without_pyarrow_there_is_no_store(made, tmp_path, monkeypatch):
    monkeypatch.setattr(parquet, "find_spec", lambda _name: None)
    with pytest.raises(UserError, match=r'store .* needs pyarrow.*pip install "wspd-design\[parquet\]"'):
        made(tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_the_store_is_parquet_for_others(made, plain, tmp_path):
    """DuckDB, which shares no code with what wrote the files, reads the same numbers."""
    duckdb = pytest.importorskip("duckdb")
    made(tmp_path)
    with duckdb.connect() as database:
        found = database.sql(f"SELECT * FROM '{tmp_path}/*.parquet' ORDER BY run").fetchnumpy()
    assert list(found) == list(plain.table.dtype.names)
    for name in ("run", "vehicle.mass", "distance_m", "stopped"):
        np.testing.assert_array_equal(found[name], plain.table[name])


def test_rows_have_one_form_in_memory_and_in_the_file(tmp_path):
    store = Store(tmp_path, "k" * 64)
    columns = [("run", "i8"), ("seed", "i8"), ("distance_m", "f8"), ("stopped", "?")]
    rows = np.array([(7, 8, np.nan, True), (8, 9, -0.0, False)], dtype=columns)
    store.write(7, rows)
    back = store.read(7, 2, columns)
    assert back is not None
    assert back.tobytes() == rows.tobytes()
    assert store.read(9, 2, columns) is None
    assert store.remade == []
