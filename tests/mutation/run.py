#!/usr/bin/env python3
"""Puts deliberate faults into copies of the sources and counts those that the tests notice.

    tests/mutation/run.py --copy FOLDER [--count 100] [--seed 1] [--modules vo,mapping] [-o FILE]

Draws mutants by seed, the same number for every module. Builds and tests them one at a time in
FOLDER: a clone of this repository with its own build, made if it does not exist, and used again
otherwise. For each mutant the tests of its module and those that include its header run first, then
the others from the shortest on, until one fails or until the tests would need more than --test-seconds. A build
that fails is no mutant; another one is drawn. A test program that takes five times as
long as usual (and two minutes) has noticed the mutant too.

Equivalent mutants, which change no behaviour, stand with their reasons in equivalent.txt beside
this script: one `FILE | KIND | LINE | OLD -> NEW | REASON` a line. They are not drawn.
"""

import argparse
import json
import os
import pathlib
import random
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
import mutants  # noqa: E402


def run(command, folder, seconds=None, log=None):
    """Exit status, or None if it took longer than `seconds`."""
    with open(log or os.devnull, "wb") as out:
        process = subprocess.Popen(command, cwd=folder, stdout=out, stderr=subprocess.STDOUT,
                                   start_new_session=True)
        try:
            return process.wait(seconds)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, 9)
            process.wait()
            return None


class Copy:
    """The clone that is mutated, and its build."""

    def __init__(self, folder, jobs):
        self.folder = pathlib.Path(folder).resolve()
        self.build = self.folder / "build" / "release"
        self.jobs = str(jobs)
        if not self.folder.exists():
            subprocess.run(["git", "clone", "-q", "--local", str(HERE.parent.parent),
                            str(self.folder)], check=True)
        changed = subprocess.run(["git", "status", "--porcelain", "-uno"], cwd=self.folder,
                                 capture_output=True, text=True, check=True).stdout
        if changed:
            sys.exit(f"error: {self.folder}: got changed files, want a clean copy to mutate")
        if not (self.build / "build.ninja").exists():
            subprocess.run(["cmake", "--preset", "release"], cwd=self.folder, check=True,
                           stdout=subprocess.DEVNULL)

    def make(self, targets, log=None):
        return run(["cmake", "--build", str(self.build), "-j", self.jobs, "--target", *targets],
                   self.folder, log=log) == 0

    def tests(self):
        """Name of each test program and its path, with the folder of tests it belongs to."""
        listed = subprocess.run(["ninja", "-t", "targets", "all"], cwd=self.build, text=True,
                                capture_output=True, check=True).stdout
        programs = {}
        for line in listed.splitlines():
            path, _, rule = line.partition(": ")
            # tests/layout reads the sources; what it says of a mutant says nothing of behaviour.
            if (path.startswith("tests/") and "/test_" in path
                    and not path.startswith("tests/layout/") and "CXX_EXECUTABLE_LINKER" in rule):
                programs[path.rsplit("/", 1)[1]] = path
        return programs

    def test(self, path, seconds, log=None):
        """True if it passes; False if it fails; None if it takes too long."""
        status = run([str(self.build / path), "--gtest_fail_fast", "--gtest_brief=1"],
                     (self.build / path).parent, seconds, log)
        return None if status is None else status == 0


def read_equivalent():
    keys = set()
    for line in (HERE / "equivalent.txt").read_text().splitlines():
        if line.strip() and not line.startswith("#"):
            keys.add(line.rsplit(" | ", 1)[0].strip())
    return keys


def draw_order(copy, modules, seed):
    """For each module an endless order of its mutants: kinds alike, then places by chance."""
    equivalent = read_equivalent()
    order = {}
    for module in modules:
        by_kind = {}
        for path in sorted((copy.folder / module).rglob("*.cpp")):
            file = str(path.relative_to(copy.folder))
            for mutant in mutants.candidates(module, file, path.read_text()):
                if mutant.key() not in equivalent:
                    by_kind.setdefault(mutant.kind, []).append(mutant)
        draw = random.Random(f"{seed} {module}")
        for list_of_kind in by_kind.values():
            draw.shuffle(list_of_kind)
        order[module] = []
        while any(by_kind.values()):
            kinds = [kind for kind in sorted(by_kind) if by_kind[kind]]
            draw.shuffle(kinds)
            for kind in kinds:
                order[module].append(by_kind[kind].pop())
    return order


def belongs_to(path, module):
    return path.split("/")[1] == module


def folders_that_include(copy, file):
    """Folders of tests/ with a source that includes the header of the mutated file."""
    header = '"' + file.rsplit(".", 1)[0] + '.hpp"'
    return {path.relative_to(copy.folder / "tests").parts[0]
            for path in (copy.folder / "tests").rglob("*.cpp") if header in path.read_text()}


def programs_for(copy, mutant, programs, seconds):
    """Test programs in the order in which they run."""
    folders = folders_that_include(copy, mutant.file)

    def order(name):
        path = programs[name]
        near = belongs_to(path, mutant.module) or path.split("/")[1] in folders
        return (not near, seconds[name], name)

    return sorted(programs, key=order)


def judge(copy, mutant, programs, seconds, limit, log):
    """(outcome, program that noticed it)"""
    path = copy.folder / mutant.file
    source = path.read_text()
    assert source[mutant.start:mutant.start + len(mutant.old)] == mutant.old
    changed = source[:mutant.start] + mutant.new + source[mutant.start + len(mutant.old):]
    path.write_text(changed)
    try:
        spent = 0.0
        for name in programs_for(copy, mutant, programs, seconds):
            if spent > 0.0 and spent + seconds[name] > limit:
                continue
            if not copy.make([name], log):
                return ("no build", name)
            passed = copy.test(programs[name], 5.0 * seconds[name] + 120.0, log)
            if passed is not True:
                return ("noticed" if passed is False else "noticed by time", name)
            spent += seconds[name]
        return ("survived", "")
    finally:
        path.write_text(source)


def share(results):
    noticed = sum(r["outcome"].startswith("noticed") for r in results)
    return noticed, len(results)


def print_table(results, modules):
    for module in modules:
        noticed, count = share([r for r in results if r["module"] == module])
        if count:
            print(f"{module:10} {noticed:3} of {count:3} noticed ({100.0 * noticed / count:.0f} %)")
    noticed, count = share(results)
    if count:
        print(f"{'all':10} {noticed:3} of {count:3} noticed ({100.0 * noticed / count:.0f} %)")


def measure(copy, programs):
    """Seconds of each test program without a fault. All must pass."""
    times = copy.build / "mutation_seconds.json"
    if times.exists():
        known = json.loads(times.read_text())
        if set(known) == set(programs):
            return known
    seconds = {}
    for name, path in sorted(programs.items()):
        start = time.monotonic()
        if copy.test(path, 3600.0, copy.build / "mutation.log") is not True:
            sys.exit(f"error: {name}: fails without a fault; see {copy.build}/mutation.log")
        seconds[name] = round(time.monotonic() - start, 2)
    times.write_text(json.dumps(seconds, indent=1))
    return seconds


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--copy", required=True, help="folder of the clone to mutate")
    parser.add_argument("--count", type=int, default=100, help="mutants, over all modules")
    parser.add_argument("--seed", default="1")
    parser.add_argument("--modules", default=",".join(mutants.MODULES))
    parser.add_argument("--test-seconds", type=float, default=300.0, help="of tests, per mutant")
    parser.add_argument("--without", default="", help="test programs not to run: a,b")
    parser.add_argument("--max-minutes", type=float, default=1e9, help="draws no more after this")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("-o", "--out", default="", help="JSON file with every mutant")
    options = parser.parse_args()
    modules = options.modules.split(",")
    copy = Copy(options.copy, options.jobs)
    programs = {name: path for name, path in copy.tests().items()
                if name not in options.without.split(",")}
    if not copy.make(list(programs), copy.build / "mutation.log"):
        sys.exit(f"error: the copy does not build; see {copy.build}/mutation.log")
    seconds = measure(copy, programs)
    order = draw_order(copy, modules, options.seed)
    results = []
    end = time.monotonic() + 60.0 * options.max_minutes
    while len(results) < options.count and time.monotonic() < end and any(order.values()):
        module = modules[len(results) % len(modules)]
        if not order[module]:
            modules = [m for m in modules if order[m]]
            continue
        mutant = order[module].pop(0)
        outcome, program = judge(copy, mutant, programs, seconds, options.test_seconds,
                                 copy.build / "mutation.log")
        if outcome == "no build":
            continue
        results.append({"module": module, "file": mutant.file, "line": mutant.line,
                        "kind": mutant.kind, "text": mutant.text, "old": mutant.old,
                        "new": mutant.new, "outcome": outcome, "by": program,
                        "key": mutant.key()})
        print(f"{outcome:15} {mutant.file}:{mutant.line}: {mutant.kind}: {mutant.text}"
              f"   [{mutant.old.strip()} -> {mutant.new.strip()}] {program}", flush=True)
        if options.out:
            pathlib.Path(options.out).write_text(json.dumps(results, indent=1))
    print_table(results, options.modules.split(","))


if __name__ == "__main__":
    main()
