#!/usr/bin/env python3
"""All pages in markdown: links and anchors lead somewhere, and the pages for readers stay short."""
import html
import os
import pathlib
import re
import unittest

ROOT = pathlib.Path(os.path.abspath(__file__)).parents[2]
NOTEBOOK = ROOT / "doc" / "notebook"
MOST_WORDS = {"doc/": 25000, "README.md": 1500}  # as wc -w counts them; doc/ without the notebook
TEXT = {".md", ".hpp", ".cpp", ".cu", ".cuh", ".py", ".yaml", ".launch", ".msg", ".srv", ".action", ".cmake", ".txt", ".xml",
        ".sh", ".html", ".jinja", ""}
OUTSIDE = re.compile(r"[a-z][a-z+.-]*:|//")


def files(suffixes):
    """Files of the repository with these suffixes, without hidden folders and builds."""
    for folder, folders, names in os.walk(ROOT):
        folders[:] = sorted(name for name in folders if not re.match(r"\.|build|__pycache__|devel$", name))
        for name in sorted(names):
            if os.path.splitext(name)[1] in suffixes and not os.path.islink(os.path.join(folder, name)):
                yield pathlib.Path(folder, name)


def without_code(text):
    """The text without blocks and spans of code, and without comments."""
    text = re.sub(r"^( *)(```+).*?^ *\2 *$", "", text, flags=re.MULTILINE | re.DOTALL)
    text = re.sub(r"<!--.*?-->", "", text, flags=re.DOTALL)
    return re.sub(r"(`+)(?!`).+?(?<!`)\1(?!`)", "code", text)


def links(text):
    text = without_code(text)
    found = re.findall(r"\]\(\s*<?([^)\s>]*)>?(?:\s+\"[^\"]*\")?\s*\)", text)
    found += re.findall(r"^ {0,3}\[[^\]]+\]:\s*<?(\S+?)>?\s*$", text, re.MULTILINE)
    found += re.findall(r"<(?:a|img|source|video)\b[^>]*?\b(?:href|src)=\"([^\"]*)\"", text)
    return [link for link in found if not OUTSIDE.match(link)]


def anchors(text):
    """Of the headings, as GitHub makes them, and of elements of HTML with an id or name."""
    found, times = set(re.findall(r"<\w+\b[^>]*?\b(?:id|name)=\"([^\"]+)\"", text)), {}
    text = re.sub(r"^( *)(```+).*?^ *\2 *$", "", text, flags=re.MULTILINE | re.DOTALL)
    for heading in re.findall(r"^#{1,6}[ \t]+(.+?)[ \t]*#*$", text, re.MULTILINE):
        heading = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", heading)
        name = re.sub(r"[^\w\- ]", "", html.unescape(heading).lower()).replace(" ", "-")
        times[name] = times.get(name, -1) + 1
        found.add(name if times[name] == 0 else "%s-%d" % (name, times[name]))
    return found


def fault_of(page, link):
    """What is wrong with a link of a page; None if it leads somewhere."""
    path, _, anchor = link.partition("#")
    target = (page.parent / path).resolve() if path else page
    if not target.exists():
        return "there is no %s" % path
    if ROOT != target and ROOT not in target.parents:
        return "%s is outside of the repository" % path
    if anchor and (target.suffix != ".md" or anchor not in anchors(target.read_text(encoding="utf-8"))):
        return "%s has no heading #%s" % (target.relative_to(ROOT), anchor)
    return None


def words(path):
    """Words of a file or of all pages of a folder but the notebook's."""
    pages = [path] if path.is_file() else [p for p in path.rglob("*.md") if NOTEBOOK not in p.parents]
    return sum(len(page.read_text(encoding="utf-8").split()) for page in pages)


class Pages(unittest.TestCase):
    maxDiff = None

    def test_links_and_anchors_lead_somewhere(self):
        faults, seen = [], 0
        for page in files({".md"}):
            for link in links(page.read_text(encoding="utf-8")):
                seen += 1
                fault = fault_of(page, link)
                if fault:
                    faults.append("%s: (%s): %s" % (page.relative_to(ROOT), link, fault))
        self.assertGreater(seen, 100)
        self.assertEqual(faults, [])

    def test_pages_that_sources_name_exist(self):
        faults = []
        for file in files(TEXT):
            if NOTEBOOK in file.parents:
                continue
            try:
                text = file.read_text(encoding="utf-8")
            except UnicodeDecodeError:
                continue
            for name in set(re.findall(r"(?<![\w/.-])doc/[\w/]+\.(?:md|png|jpg|yaml|json)\b", text)):
                if not (ROOT / name).exists():
                    faults.append("%s names %s" % (file.relative_to(ROOT), name))
        self.assertEqual(faults, [])

    def test_no_page_has_a_placeholder(self):
        self.assertEqual([str(page.relative_to(ROOT)) for page in files({".md"})
                          if re.search(r"@@\w+@@", page.read_text(encoding="utf-8"))], [])

    def test_pages_are_short(self):
        for name, most in MOST_WORDS.items():
            with self.subTest(name):
                self.assertLessEqual(words(ROOT / name), most, "words of %s; history goes to doc/notebook/" % name)

    def test_pages_of_the_notebook_begin_with_their_question(self):
        pages = sorted(NOTEBOOK.glob("*.md"))
        self.assertTrue(pages)
        self.assertEqual([page.name for page in pages
                          if not re.match(r"# .+\?\n", page.read_text(encoding="utf-8"))], [])


class Reading(unittest.TestCase):
    """What the tests above see of a page."""

    def test_links_are_those_outside_of_code(self):
        self.assertEqual(links("[a](b.md#c) ![d](e.png) `[f](g)`\n```\n[h](i)\n```\n[j](https://k) <img src=\"l.jpg\">"),
                         ["b.md#c", "e.png", "l.jpg"])

    def test_anchors_are_those_of_github(self):
        self.assertEqual(anchors("# A, b & `c_d`\n## Two\n## Two\n```\n# no\n```\n"), {"a-b--c_d", "two", "two-1"})

    def test_a_link_that_leads_nowhere_has_a_fault(self):
        page = ROOT / "CONTRIBUTING.md"
        self.assertIsNone(fault_of(page, "#habits"))
        self.assertIsNone(fault_of(page, "src"))
        self.assertIn("has no heading", fault_of(page, "#nowhere"))
        self.assertIn("there is no", fault_of(page, "nowhere.md"))
        self.assertIn("outside", fault_of(page, ".."))


if __name__ == "__main__":
    unittest.main()
