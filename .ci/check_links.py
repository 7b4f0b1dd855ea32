#!/usr/bin/env python3
"""Links of a built book lead somewhere: pages, headings, pictures and files. usage: check_links.py FOLDER"""

import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


class Page(HTMLParser):
    """Targets that a page offers, and links that it has."""

    def __init__(self, path):
        super().__init__()
        self.targets, self.links = set(), []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.targets.update(attributes[key] for key in ("id", "name") if attributes.get(key))
        self.links += [attributes[key] for key in ("href", "src") if attributes.get(key)]


def lost(folder):
    """Every link in the HTML files of `folder` that leads nowhere, with its page."""
    pages = {path: Page(path) for path in sorted(folder.rglob("*.html"))}
    for path, page in pages.items():
        for link in page.links:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            target = target / "index.html" if target.is_dir() else target
            known = target in pages and (
                not parts.fragment or unquote(parts.fragment) in pages[target].targets
            )
            if not (known or (target not in pages and target.is_file())):
                yield f"{path.relative_to(folder)}: the link to {link} leads nowhere"


def main():
    folder = Path(sys.argv[1]).resolve()
    n_pages = len(list(folder.rglob("*.html")))
    found = sorted(set(lost(folder)))
    print(*found, sep="\n", end="\n" if found else "")
    if found or not n_pages:
        sys.exit(f"{len(found)} links lead nowhere on {n_pages} pages of {folder}")
    print(f"links: {n_pages} pages, every link leads somewhere")


main()
