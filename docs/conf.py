"""How Sphinx makes the site of these pages, of the examples and of the docstrings."""

from importlib import metadata
from pathlib import Path

project = "murkscan"
release = metadata.version("murkscan")
extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx_gallery.gen_gallery",
]
html_theme = "furo"
html_title = "murkscan"
html_show_sphinx = False
exclude_patterns = ["_build", "gallery/*.ipynb", "gallery/*.py", "gallery/*.md5", "gallery/*.json"]

myst_heading_anchors = 3
autodoc_member_order = "bysource"
autodoc_typehints = "none"  # shapes stand in the signature
autodoc_typehints_format = "short"
napoleon_use_ivar = True

sphinx_gallery_conf = {
    "examples_dirs": "../examples",
    "gallery_dirs": "gallery",
    "filename_pattern": r"/\d\d_",
    "within_subsection_order": "FileNameSortKey",
    "plot_gallery": "True",
    "abort_on_example_error": True,
    "download_all_examples": False,
    "remove_config_comments": True,
    "default_thumb_file": str(Path(__file__).parent / "ship" / "propeller.png"),
    "show_memory": False,
    "min_reported_time": 3600,
    "reset_modules": (),
}
