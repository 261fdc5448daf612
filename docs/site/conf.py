"""Settings of Sphinx; ``build.py`` stages what it reads."""

import sys
from importlib.metadata import version as _version
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[2]))

from docs.site.api import without_attributes

project = "wspd_design"
author = "The wspd_design authors"
copyright = "the wspd_design authors, MIT license"
release = version = _version("wspd-design")
language = "en"

extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]

# Links to headings of other pages are spelled as on GitHub.
myst_heading_anchors = 4
myst_enable_extensions = ["colon_fence"]

# Every cell runs when the site is built; one that fails fails the build.
nb_execution_mode = "force"
nb_execution_in_temp = True
nb_execution_raise_on_error = True
nb_execution_timeout = 300
nb_merge_streams = True
nb_mime_priority_overrides = [("html", "image/svg+xml", 0)]

# What a docstring points at has to be on the page. Types are another matter: those of other packages, and records of
# ours that no public name leads to, have no page here.
nitpicky = True
nitpick_ignore_regex = [("py:class", ".*")]

autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_typehints_format = "short"
autodoc_preserve_defaults = True
python_use_unqualified_type_names = True
napoleon_numpy_docstring = True
napoleon_google_docstring = False
napoleon_use_rtype = False
python_maximum_signature_line_length = 88

html_theme = "furo"
html_title = f"wspd_design {release}"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_show_sourcelink = False
html_copy_source = False
html_show_sphinx = False
# A page that is opened as a file must not read other files: search lists pages without their first lines.
html_show_search_summary = False
html_theme_options = {"navigation_with_keys": True, "top_of_page_buttons": []}
# No page has formulas that a script would set; nothing is ever asked of another host.
mathjax_path = "no-script-is-loaded.js"


def _table_in_place(_app: Any, what: str, _name: str, _item: Any, _options: Any, lines: list[str]) -> None:
    if what == "class":
        lines[:] = without_attributes(lines)


def setup(app: Any) -> None:
    """Leave out what tables of the page show, before the docstring is read as NumPy's style."""
    app.connect("autodoc-process-docstring", _table_in_place, priority=400)
