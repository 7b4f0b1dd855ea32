"""How these pages become a book, by Sphinx with Markdown (myst-parser); see docs/contributors/book.md."""

import os
import re
from pathlib import Path

project = "wakemix"
html_title = "wakemix"
author = "the authors of wakemix"
extensions = ["myst_parser"]
html_theme = "furo"
html_static_path = ["book.css"]
html_css_files = ["book.css"]
html_show_sphinx = False
html_show_copyright = False
html_copy_source = False
# Headings are targets of links; a dash is a dash.
myst_heading_anchors = 4
smartquotes = False
# Which level a heading has, and colours of code, are a matter of taste; lost links are not.
suppress_warnings = ["myst.header", "misc.highlighting_failure"]
html_theme_options = {"top_of_page_buttons": []}

DOCS = Path(__file__).resolve().parent
ROOT = DOCS.parent
# Files of the root that are pages of the book.
PAGES = {
    "CONTRIBUTING.md": "contributors/contributing.md",
    "ARCHITECTURE.md": "contributors/architecture.md",
}


def setup(app):
    app.connect("source-read", read)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def read(_app, name, source):
    """Puts what the book adds into the page called `name`."""
    folder, text = (DOCS / name).parent, source[0]
    shown = re.search(r"^<!-- page (\S+) -->$", text, re.MULTILINE)
    if shown:
        path = (folder / shown[1]).resolve()
        text = links(path.read_text(encoding="utf-8"), path.parent, folder)
    else:
        text = links(text, folder, folder)
    if name == "index":
        text += side_bar(text)
    elif (DOCS / name).name == "index":
        text += "\n```{toctree}\n:hidden:\n:glob:\n\n*\n```\n"
    source[0] = text


def links(text, written_in, shown_in):
    """`text` with links that were right in the folder `written_in` made right for a page in `shown_in`.

    Folders and pages outside the book become plain words; files outside are offered for download.
    """

    def mended(found):
        mark, words, target, anchor = found[1], found[2], found[3], found[4] or ""
        if "://" in target or target.startswith("mailto:") or not target:
            return found[0]
        path = (written_in / target).resolve()
        path = DOCS / PAGES.get(os.path.relpath(path, ROOT), path)
        if path.is_dir() and (path / "index.md").exists():
            path /= "index.md"
        outside = DOCS not in path.parents and path != DOCS
        if path.is_dir() or (outside and path.suffix == ".md"):
            return words
        return f"{mark}[{words}]({os.path.relpath(path, shown_in)}{anchor})"

    return re.sub(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^()#\s]*)(#[^()\s]*)?\)", mended, text)


def side_bar(text):
    """Each list of links under a heading of the front page is a part of the book."""
    parts = []
    for part in re.split(r"^## ", text, flags=re.MULTILINE)[1:]:
        heading, *lines = part.splitlines()
        pages = [found[1] for line in lines if (found := re.match(r"- \[[^]]+\]\(([^)]+)\.md\)", line))]
        parts.append(
            "\n".join(["", "```{toctree}", ":hidden:", f":caption: {heading}", "", *pages, "```", ""])
        )
    return "".join(parts)
