"""How Sphinx makes one site of README.md, docs/ and the reference that make_site.py writes."""

project = "flinch"
author = "the flinch authors"
extensions = ["myst_parser", "sphinx.ext.mathjax"]
include_patterns = ["index.md", "README.md", "CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md", "docs/*.md", "reference/*.md"]
myst_enable_extensions = ["dollarmath", "amsmath"]
myst_heading_anchors = 6
suppress_warnings = ["myst.header", "myst.xref_missing"]  # tests/house/links.py looks at links

html_theme = "sphinx_rtd_theme"
html_title = "flinch"
html_show_copyright = False
html_show_sphinx = False
html_copy_source = False
