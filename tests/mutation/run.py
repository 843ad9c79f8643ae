#!/usr/bin/env python3
"""Puts deliberate faults into a copy of the sources and counts those that the tests notice.

    tests/mutation/run.py --copy FOLDER [--seed 1] [--count 8] [--modules vo,mapping] [--minutes 60]

Draws --count mutants of every module by seed and writes all of them into FOLDER, a clone of this
repository with its own build, each behind a switch (switch.hpp). One build then serves all:

1. Every ctest entry runs once with no fault on. It must pass, and it records the switches that it
   asks: the mutants that it reaches.
2. Each mutant is switched on for the entries that reach it, cheapest first, until one fails. An
   entry that uses three times its usual processor time and 10 s has noticed the mutant too. The
   entry must pass directly afterwards without the fault. A mutant that no entry reaches survives.

A mutant that does not compile behind a switch (in a constant expression, for example) is replaced
by the next of the draw. Equivalent mutants stand with their reasons in equivalent.txt beside this
script, `FILE | KIND | LINE | OLD -> NEW | REASON` a line; they are not drawn and do not count.

All results stand in one JSON file. The script goes on from there when it runs again with the same
copy: it copies tests/ of this tree into the copy, builds, and tries survivors on entries that are
new to them. So write a test for a survivor, then run the script again.
"""

import argparse
import os
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
from study import Study  # noqa: E402
from tested_copy import Copy  # noqa: E402
import mutants  # noqa: E402

# Tests that read the sources say nothing of behaviour.
READ_SOURCES = r"layout\.|package\.TheHeaders"


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--copy", required=True, help="folder of the clone that holds the faults")
    parser.add_argument("--seed", default="1")
    parser.add_argument("--count", type=int, default=8, help="mutants of each module")
    parser.add_argument("--modules", default=",".join(mutants.MODULES))
    parser.add_argument("--tests", default="", help="test programs to build and run: test_base,test_vo")
    parser.add_argument("--without", default=READ_SOURCES, help="entries not to run, as an expression")
    parser.add_argument("--again", default="", help="entries to trace and try again, as an expression")
    parser.add_argument("--entry-seconds", type=float, default=60.0, help="dearer entries are left out")
    parser.add_argument("--test-seconds", type=float, default=120.0, help="of entries, per mutant")
    parser.add_argument("--minutes", type=float, default=1e9, help="starts no entry after this")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="of the build")
    parser.add_argument("--out", default="", help="results (default: FOLDER/build/mutation.json)")
    options = parser.parse_args()
    programs = options.tests.split(",") if options.tests else []
    copy = Copy(options.copy, options.jobs)
    study = Study(copy, options)
    copy.copy_tests()
    study.build(programs)
    entries = copy.entries(programs, options.without)
    study.trace(entries)
    study.judge_all(entries)
    study.save()
    for module, share in study.shares().items():
        percent = f"{100.0 * share['noticed'] / share['judged']:.0f} %" if share["judged"] else "none"
        print(f"{module:10} {share['noticed']:3} of {share['judged']:3} noticed ({percent}), "
              f"{share['not_reached']} not reached, {share['equivalent']} equivalent, "
              f"{share['drawn'] - share['equivalent'] - share['judged']} to judge")
    print(f"{len(study.state['not_writable'])} drawn mutants could not be put behind a switch")


if __name__ == "__main__":
    main()
