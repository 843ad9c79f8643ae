"""Tests bench/compare.py with a program that only pretends to map: compare_test.py SOURCE_FOLDER"""

import json
import os
import shutil
import stat
import subprocess
import sys
import tempfile
import unittest

SOURCE = sys.argv.pop()

PROGRAM = """#!/usr/bin/env python3
import json, os, sys
if "--version" in sys.argv:
    print("roadbook test")
elif sys.argv[1] == "simulate":
    folder = sys.argv[sys.argv.index("-o") + 1]
    os.makedirs(folder)
    open(os.path.join(folder, "vehicle.yaml"), "w").close()
else:
    assert sys.argv[1] == "map" and os.path.isdir(sys.argv[2])
    sum(range({work}))
    print(json.dumps({{"stages": [{{"name": "loops", "seconds": {seconds}}}], "digest": "{digest}",
                      "keyframes": 7, "landmarks": {landmarks}}}))
"""


class Compare(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        self.script = os.path.join(self.folder, "compare.py")
        shutil.copy(os.path.join(SOURCE, "bench", "compare.py"), self.script)

    def program(self, name, **figures):
        path = os.path.join(self.folder, name)
        with open(path, "w", encoding="utf-8") as text:
            text.write(PROGRAM.format(**{"work": 1000, "seconds": 1.0, "digest": "a",
                                         "landmarks": 5, **figures}))
        os.chmod(path, os.stat(path).st_mode | stat.S_IXUSR)
        return path

    def compare(self, *arguments):
        return subprocess.run([sys.executable, "-B", self.script, *arguments], text=True,
                              capture_output=True, check=False)

    def test_two_programs_have_ratios_of_all_stages(self):
        old = self.program("old", seconds=4.0)
        new = self.program("new", digest="b", landmarks=6)
        result = self.compare(new, "--with", old, "--repeat", "1")
        self.assertEqual(result.returncode, 0, result.stderr)
        loops = [line.split() for line in result.stdout.splitlines() if "loops [s]" in line]
        self.assertEqual(len(loops), 3)
        for line in loops:
            self.assertEqual(line[-3:], ["1.00", "4.00", "0.25"])
        self.assertEqual(result.stdout.count("the map is another one: 6 landmarks (before: 5)"), 3)

    def test_a_program_that_does_more_work_takes_a_larger_ratio(self):
        result = self.compare(self.program("slow", work=10000000), "--with", self.program("quick"),
                              "--repeat", "1")
        lines = [line for line in result.stdout.splitlines() if "processor time" in line]
        self.assertTrue(all(float(line.split()[-1]) > 2.0 for line in lines), result.stdout)

    def test_a_record_is_compared_with_on_its_own_machine_only(self):
        new = self.program("new")
        self.assertIn("no record to compare with", self.compare(new, "--repeat", "1").stdout)
        saved = self.compare(new, "--repeat", "1", "--save", "0.1.0")
        self.assertEqual(saved.returncode, 0, saved.stderr)
        file = os.path.join(self.folder, "history", "0.1.0.json")
        with open(file, encoding="utf-8") as text:
            record = json.load(text)
        self.assertEqual(record["program"], "roadbook test")
        self.assertEqual(len(record["drives"]), 3)
        faster = self.program("faster", seconds=0.5)
        here = self.compare(faster, "--repeat", "1").stdout
        self.assertIn("0.50       1.00    0.50", here)
        record["machine"]["processor"] = "another"
        with open(file, "w", encoding="utf-8") as text:
            json.dump(record, text)
        elsewhere = self.compare(faster, "--repeat", "1").stdout
        self.assertIn("0.1.0 was measured on another machine: no ratios", elsewhere)
        rows = [line.split() for line in elsewhere.splitlines() if "loops [s]" in line]
        self.assertEqual([row[-1] for row in rows], ["-"] * 3)

    def test_wrong_input_is_named(self):
        record = self.compare(self.program("any"), "--against", "none.json")
        self.assertEqual(record.returncode, 2)
        self.assertIn("none.json: got no such file", record.stderr)
        missing = self.compare(os.path.join(self.folder, "none"))
        self.assertEqual(missing.returncode, 2)
        self.assertIn("got no such program", missing.stderr)
        broken = self.program("broken", work="oops")
        self.assertIn("got exit status", self.compare(broken, "--repeat", "1").stderr)


if __name__ == "__main__":
    unittest.main()
