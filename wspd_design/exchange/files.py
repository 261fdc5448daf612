"""The schema files in the package.

``python -m wspd_design.exchange.files`` writes them and the tables of ``docs/json.md`` and ``docs/vehicle-files.md``
again.
"""

import json
from importlib.resources import files
from pathlib import Path
from typing import Any

from wspd_design.exchange.documentation import with_tables
from wspd_design.exchange.forms import Form, json_schema
from wspd_design.exchange.parameter_schema import with_key_tables
from wspd_design.exchange.vocabulary import WITH_SCHEMA

FOLDER = "data/schemas"


def schema_file(form: Form) -> str:
    """Return the name of the schema file of a form, ``wspd-stop-2.json`` for ``wspd-stop/2``."""
    return f"{form.schema.replace('/', '-')}.json"


def schema_text(form: Form) -> str:
    """Return the content of the schema file of a form."""
    return json.dumps(json_schema(form), indent=1, ensure_ascii=False) + "\n"


def read_schema(name: str) -> dict[str, Any]:
    """Read a schema of the package by the name that stands in the key ``schema`` of an object."""
    place = files("wspd_design").joinpath(FOLDER, f"{name.replace('/', '-')}.json")
    schema: dict[str, Any] = json.loads(place.read_text(encoding="utf-8"))
    return schema


def write_schemas(folder: Path) -> None:
    """Write the schema file of every form that stands alone."""
    for form in WITH_SCHEMA:
        (folder / schema_file(form)).write_text(schema_text(form), encoding="utf-8")


if __name__ == "__main__":
    package = Path(__file__).parents[1]
    write_schemas(package / FOLDER)
    for name, with_all in (("json.md", with_tables), ("vehicle-files.md", with_key_tables)):
        page = package.parent / "docs" / name
        page.write_text(with_all(page.read_text(encoding="utf-8")), encoding="utf-8")
