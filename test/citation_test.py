#!/usr/bin/env python3
"""CITATION.cff: what the Citation File Format 1.2.0 requires of a file and of each of its references, the version of
package.xml, the date of CHANGELOG.rst, and the works that the models come from."""
import datetime
import os
import re
import unittest
from xml.etree import ElementTree

import yaml

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
TYPES_OF_REFERENCES = {"article", "book", "conference-paper", "thesis"}  # of those of the format, what we have
CITED = [("Paris", 2019), ("Taylor", 2023), ("Nilles", 2024), ("Nilles", 2025), ("Jackson", 1975), ("Sauermann", 2001),
         ("Kroy", 2002), ("Werner", 1995), ("Momiji", 2000), ("Bishop", 2002), ("Nield", 2008), ("Wang", 2012), ("Mei", 2007)]


class Citation(unittest.TestCase):
    def setUp(self):
        with open(os.path.join(ROOT, "CITATION.cff"), encoding="utf-8") as file:
            self.cff = yaml.safe_load(file)
        self.package = ElementTree.parse(os.path.join(ROOT, "package.xml")).getroot()

    def test_has_what_the_format_requires(self):
        self.assertEqual(self.cff["cff-version"], "1.2.0")
        self.assertEqual(self.cff["type"], "software")
        for key in ("title", "message"):
            self.assertTrue(self.cff[key])
        self.expect_authors(self.cff["authors"])

    def test_is_of_this_release(self):
        version = self.package.findtext("version")
        self.assertEqual(self.cff["version"], version)
        self.assertEqual(self.cff["license"], self.package.findtext("license"))
        self.assertIsInstance(self.cff["date-released"], datetime.date)
        with open(os.path.join(ROOT, "CHANGELOG.rst"), encoding="utf-8") as file:
            self.assertIn("\n%s (%s)\n" % (version, self.cff["date-released"]), file.read())
        with open(os.path.join(ROOT, "CMakeLists.txt"), encoding="utf-8") as file:
            self.assertIn("project(desert_sim VERSION %s " % version, file.read())

    def test_each_reference_can_be_found(self):
        for reference in self.cff["references"]:
            with self.subTest(reference["title"]):
                self.assertIn(reference["type"], TYPES_OF_REFERENCES)
                self.expect_authors(reference["authors"])
                self.assertIsInstance(reference["year"], int)
                self.assertTrue(reference.get("journal") or reference["conference"]["name"])
                if "doi" in reference:
                    self.assertTrue(re.fullmatch(r"10\.\d{4,9}(\.\d+)?/[A-Za-z0-9:/_;\-.()\[\]]+", reference["doi"]))

    def test_names_the_works_of_the_models(self):
        found = [(reference["authors"][0]["family-names"], reference["year"]) for reference in self.cff["references"]]
        for work in CITED:
            self.assertIn(work, found)

    def expect_authors(self, authors):
        self.assertTrue(authors)
        for author in authors:
            self.assertTrue(author.get("name") or (author["family-names"] and author["given-names"]))


if __name__ == "__main__":
    unittest.main()
