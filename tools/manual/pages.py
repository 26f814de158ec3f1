"""Collects the pages of the site (mkdocs.yml) from the repository, where they stand: a page is written once, and its
links lead to the right place both in the repository and on the site.

The manual's pages are at the top of the site, those of other folders in folders of the same names. A source file that
a page links to is copied as text; a link to a folder leads to the page of that folder, or becomes plain text.
"""
import json
import posixpath
import re
from pathlib import Path

from mkdocs.structure import files as structure
from mkdocs.structure.files import File, Files

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = ("core", "precision")  # whose pages are added to the section below
SECTION = "How it works"
OTHERS = ("README.md", "tools/README.md", "tests/README.md", ".github/CONTRIBUTING.md", ".github/CHANGELOG.md",
          "bench/README.md")
PICTURES = (".png", ".svg")
ITEM = re.compile(r"([-*]|\d+\.) ")
LINK = re.compile(r"(!?)\[([^\]]*)\]\(([^)\s#:]+)(#[^)]*)?\)")
PLACES = {"README.md": "cradle.html", ".github/CONTRIBUTING.md": "contributing.html",
          ".github/CHANGELOG.md": "changes.html", "tools/manual/README.md": "index.html"}


def below(folder, pattern):
    return sorted(path.relative_to(ROOT).as_posix() for path in (ROOT / folder).glob(pattern))


def pages():
    """Every page, by its path in the repository."""
    return [*OTHERS, *below("tools/manual", "*.md"), *below("bench/results", "*.md"),
            *(page for folder in FOLDERS for page in below(folder, "**/README.md"))]


def outside_code(markdown):
    """The lines of a page, each with whether it is text, and no part of a block of code."""
    code = False
    for line in markdown.split("\n"):
        fence = line.lstrip().startswith("```")
        yield line, not code and not fence
        code ^= fence


def target(page, link):
    """What a link of a page leads to, by its path in the repository."""
    return posixpath.normpath(posixpath.join(posixpath.dirname(page), link))


def place(path):
    """Where a page, a picture or a source is on the site."""
    if path in PLACES:
        return PLACES[path]
    if path.endswith(".md"):
        path = path.removeprefix("tools/manual/")
        return re.sub(r"(README)?\.md$", lambda found: ("index" if found[1] else "") + ".html", path)
    return path if path.endswith(PICTURES) else path + ".txt"


def file_of(path, config):
    file = File(path, str(ROOT), config["site_dir"], False)
    file.dest_uri = file.url = place(path)
    file.abs_dest_path = posixpath.join(config["site_dir"], file.dest_uri)
    if hasattr(structure, "InclusionLevel"):  # MkDocs from 1.5 on leaves out what is in hidden folders
        file.inclusion = structure.InclusionLevel.INCLUDED
    return file


def on_config(config):
    """Pages of folders that mkdocs.yml does not name are added to their section."""
    named = set(re.findall(r"[\w./-]+\.md", str(config["nav"])))
    for section in config["nav"]:
        if SECTION in section:
            section[SECTION] += [page for page in pages() if page not in named and page.startswith(FOLDERS)]
    return config


def on_files(files, config):
    """The pages, and the files that they link to."""
    found = {path: file_of(path, config) for path in pages()}
    for page in list(found):
        for line, text in outside_code((ROOT / page).read_text(encoding="utf-8")):
            for _, _, link, _ in LINK.findall(line) if text else ():
                path = target(page, link)
                if path not in found and (ROOT / path).is_file():
                    found[path] = file_of(path, config)
    return Files([*files, *found.values()])


def headings_of_keys(markdown):
    """What the program prints of its keys, with a heading for each table and key, which links and the search find."""
    page, _, keys = markdown.partition("<!-- output of: cradle scenes --keys -->\n```text\n")
    table, entries = "", re.findall(r"^(\S+)  \((.*)\)\n    (.*)", keys, re.M)
    for key, kind, meaning in entries:
        first, several = key.split(".")[0], sum(key == other for other, *_ in entries) > 1
        of = re.search(r' with initial.type = "(\w+)"', meaning) if several else None
        page += (f"\n## {first}\n" * (first != table and first != key) + f"\n### {key}{f' ({of[1]})' if of else ''}\n"
                 + f"\n`{kind}`: {meaning}\n")
        table = first
    return page


def on_page_markdown(markdown, page, **_):
    """What GitHub reads and Python-Markdown does not: links to folders, a list without an empty line before it, and
    what belongs to an item of a list and is indented by less than four."""
    here = page.file.src_uri

    def led(match):
        image, words, link, _ = match.groups()
        folder = target(here, link)
        if image or not (ROOT / folder).is_dir():
            return match[0]
        return f"[{words}]({posixpath.join(link, 'README.md')})" if f"{folder}/README.md" in pages() else words

    if here == "tools/manual/keys.md":
        markdown = headings_of_keys(markdown)
    lines, before, within_list = [], "", False
    for line, text in outside_code(markdown):
        if text:
            line = LINK.sub(led, line)
            item = ITEM.match(line)
            if item and before and not ITEM.match(before):
                lines.append("")
            if line.strip():
                within_list = bool(item) or (within_list and line.startswith(" "))
            if within_list:
                line = re.sub(r"^ {2,3}(?=\S)", "    ", line)
        lines.append(line)
        before = line
    return "\n".join(lines)


def on_post_build(config, **_):
    """The words in titles that are questions are tags as well, which the search ranks first. Its index once more, as a
    script, for pages that are opened from a disk."""
    folder = Path(config["site_dir"]) / "search"
    index = json.loads((folder / "search_index.json").read_text(encoding="utf-8"))
    for page in index["docs"]:
        if page["title"].endswith("?"):
            page["tags"] = page["title"].split()
    text = json.dumps(index)
    (folder / "search_index.json").write_text(text, encoding="utf-8")
    # Version 9 of the theme takes it from __index, earlier ones from __search.
    script = f"var __index = {text};\nvar __search = {{index: Promise.resolve(__index)}};\n"
    (folder / "search_index.js").write_text(script, encoding="utf-8")


def on_page_content(html, page, **_):
    """Gives each argument of the Python package a line: `name: what it is`."""
    if 'class="doc doc-contents' not in html:
        return html
    return re.sub(r"(<p>|\n)((?:\w+, )*\w+): ", lambda found: (found[1] if found[1] == "<p>" else "<br>\n")
                  + f"<code>{found[2]}</code>: ", html)
