#!/usr/bin/python3
"""scripts/include_graph on this package, which has no cycle between its modules, and on small ones made up here.

Usage: test_include_graph.py PACKAGE
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(sys.argv.pop(1)) / "scripts" / "include_graph"


def run(script):
    done = subprocess.run([str(script)], stdout=subprocess.PIPE, text=True, timeout=600, check=False)
    return done.returncode, done.stdout


def run_on(files):
    """On a package of these files: path below it, and what the file includes."""
    with tempfile.TemporaryDirectory() as folder:
        package = pathlib.Path(folder)
        for path, included in files.items():
            (package / path).parent.mkdir(parents=True, exist_ok=True)
            (package / path).write_text("".join(f'#include "{name}"\n' for name in included))
        (package / "scripts").mkdir()
        shutil.copy(SCRIPT, package / "scripts")
        return run(package / "scripts" / SCRIPT.name)


class IncludeGraph(unittest.TestCase):
    def test_this_package_has_no_cycle(self):
        code, text = run(SCRIPT)
        self.assertEqual(code, 0, text)
        self.assertIn(" 0 cycles", text)
        self.assertGreaterEqual(len(text.splitlines()), 15, "so many modules there are at least")

    def test_arrows_in_one_direction_are_none(self):
        code, text = run_on({"src/core/a/a.h": ["core/b/b.h", "donex/p.h"], "src/core/b/b.h": ["donex/p.h"],
                             "include/donex/p.h": []})
        self.assertEqual(code, 0, text)
        self.assertIn("core/a: core/b, include/donex\n", text)
        self.assertIn("3 modules, 3 arrows, 0 cycles", text)

    def test_two_modules_that_include_one_another_are_one(self):
        code, text = run_on({"src/core/a/a.h": ["core/b/b.h"], "src/core/b/b.h": [], "src/core/b/b.cpp": ["core/a/a.h"]})
        self.assertEqual(code, 1, text)
        self.assertIn("cycle: core/a, core/b", text)

    def test_so_is_the_way_round_over_public_headers(self):
        code, text = run_on({"include/donex/p.h": ["io/i.h"], "src/io/i.h": ["core/a/a.h"],
                             "src/core/a/a.h": ["donex/p.h"], "src/ros/r.h": ["io/i.h"]})
        self.assertEqual(code, 1, text)
        self.assertIn("cycle: core/a, include/donex, io", text)


if __name__ == "__main__":
    unittest.main()
