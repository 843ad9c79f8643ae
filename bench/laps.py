#!/usr/bin/env python3
"""Times `roadbook map` on laps of one place: how time and memory grow with the number of passes.

    bench/laps.py build/release/apps/roadbook                       # 2, 4, 8 and 16 laps
    bench/laps.py build/release/apps/roadbook --laps 4 8 --with OTHER/roadbook
    bench/laps.py build/release/apps/roadbook --laps 60 --keep FOLDER

The place is the small car park of `simulate zurich`: a ring of 30 m, four cameras of 640x480. Drives
in FOLDER are used again. Standard library only.
"""

import argparse
import json
import os
import re
import sys
import tempfile

from compare import run

HERE = os.path.dirname(os.path.abspath(__file__))
SCENARIO = os.path.join(HERE, "..", "sim", "scenarios", "zurich.yaml")


def drive_of(program, laps, folder):
    """A drive of so many laps, simulated unless the folder has it."""
    drive = os.path.join(folder, "laps_%d" % laps)
    if os.path.exists(drive):
        return drive
    with open(SCENARIO, encoding="utf-8") as file:
        text, changed = re.subn(r"(?m)^laps: .*$", "laps: [%d]" % laps, file.read())
    if changed != 1:
        sys.exit("error: %s: got %d rows `laps:`, want one" % (SCENARIO, changed))
    scenario = drive + ".yaml"
    with open(scenario, "w", encoding="utf-8") as file:
        file.write(text)
    run([program, "simulate", scenario, "--size", "small", "--seed", "5", "-o", drive, "-q"])
    return drive


def row_of(name, program, drive, folder):
    out = os.path.join(folder, "laps.gpkg")
    text, seconds, memory_mb = run([program, "map", drive, "-m", out, "--replace", "-q", "--json"])
    result = json.loads(text)
    stages = {stage["name"]: stage["seconds"] for stage in result["stages"]}
    print("%-22s %9d %11.1f %12.1f %12.1f %11.0f %10.2f" % (
        name, result["keyframes"], seconds, stages["bundle adjustment"], stages["covariances"],
        memory_mb, 1e3 * result["truth"]["ate_median_m"]), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="a built roadbook")
    parser.add_argument("--with", dest="other", help="another build, run in turn")
    parser.add_argument("--laps", type=int, nargs="+", default=[2, 4, 8, 16])
    parser.add_argument("--keep", help="folder that keeps the drives")
    arguments = parser.parse_args()
    print("%-22s %9s %11s %12s %12s %11s %10s" % (
        "", "keyframes", "processor s", "adjustment s", "covariance s", "memory MB", "error mm"))
    with tempfile.TemporaryDirectory() as temporary:
        folder = arguments.keep or temporary
        os.makedirs(folder, exist_ok=True)
        for laps in arguments.laps:
            drive = drive_of(arguments.program, laps, folder)
            row_of("%d laps" % laps, arguments.program, drive, temporary)
            if arguments.other:
                row_of("%d laps, other" % laps, arguments.other, drive, temporary)


if __name__ == "__main__":
    main()
