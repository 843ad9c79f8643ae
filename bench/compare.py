#!/usr/bin/env python3
"""Times `roadbook map` on three standard drives, and compares it with another build or an older record.

    bench/compare.py build/release/apps/roadbook                       # against the newest record
    bench/compare.py build/release/apps/roadbook --with OTHER/roadbook # both in turn, in one run
    bench/compare.py build/release/apps/roadbook --save 0.2.0          # writes bench/history/0.2.0.json

Absolute times change with the machine and its load: a ratio of two programs that ran in turn is
sound, a ratio to a record of another machine is none and is not printed. Standard library only.
"""

import argparse
import json
import os
import platform
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
HISTORY = os.path.join(HERE, "history")

# Name of the standard drive: arguments of `roadbook simulate`.
STANDARD_DRIVES = {
    "zurich_small": ["zurich", "--size", "small", "--seed", "1"],
    "stuttgart_small_half": ["stuttgart", "--size", "small", "--image-scale", "0.5", "--seed", "1"],
    "zurich_second_visit_half": ["zurich", "--size", "small", "--image-scale", "0.5", "--visit", "1",
                                 "--seed", "1"],
}


def machine():
    """Processor, cores, memory and kernel: what a time depends on."""
    model = platform.machine()
    memory_mb = None
    try:
        with open("/proc/cpuinfo", encoding="ascii", errors="replace") as lines:
            for line in lines:
                if line.startswith("model name"):
                    model = line.split(":", 1)[1].strip()
                    break
        with open("/proc/meminfo", encoding="ascii") as lines:
            memory_mb = int(next(lines).split()[1]) // 1024
    except OSError:
        pass
    return {"processor": model, "cores": os.cpu_count(), "memory_mb": memory_mb,
            "system": platform.system() + " " + platform.release()}


def run(command):
    """Standard output of a command, its processor seconds and its peak memory [MB]."""
    with tempfile.TemporaryFile() as out:
        child = subprocess.Popen(command, stdout=out)
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        if child.returncode != 0:
            sys.exit("error: %s: got exit status %d, want 0" % (" ".join(command), child.returncode))
        out.seek(0)
        text = out.read().decode("utf-8")
    return text, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024.0


def simulate_drives(program, folder):
    """The folders of the standard drives, simulated where they are missing."""
    drives = {}
    for name, arguments in STANDARD_DRIVES.items():
        drives[name] = os.path.join(folder, name)
        if not os.path.exists(os.path.join(drives[name], "vehicle.yaml")):
            run([program, "simulate", *arguments, "-o", drives[name], "--overwrite", "--quiet"])
    return drives


def map_drive(program, drive):
    """Figures of one `map`: processor time, memory, stages, digest."""
    with tempfile.TemporaryDirectory() as folder:
        text, cpu_s, peak_mb = run([program, "map", drive, "-m", os.path.join(folder, "map.gpkg"),
                                    "--json", "--quiet"])
    summary = json.loads(text)
    return {"cpu_s": round(cpu_s, 3), "peak_mb": round(peak_mb, 1),
            "stages": {stage["name"]: stage["seconds"] for stage in summary["stages"]},
            "digest": summary["digest"], "keyframes": summary["keyframes"],
            "landmarks": summary["landmarks"], "truth": summary.get("truth")}


def middle(runs):
    """Of several runs of one program on one drive, the one with the middle processor time."""
    return sorted(runs, key=lambda one: one["cpu_s"])[len(runs) // 2]


def newest_record(file=None):
    """The record to compare with: that file, or the one with the latest date; None without any."""
    if file is not None:
        with open(file, encoding="utf-8") as text:
            return json.load(text)
    records = []
    if os.path.isdir(HISTORY):
        for name in sorted(os.listdir(HISTORY)):
            if name.endswith(".json"):
                path = os.path.join(HISTORY, name)
                with open(path, encoding="utf-8") as text:
                    record = json.load(text)
                records.append((record["date"], os.path.getmtime(path), name, record))
    return max(records, key=lambda one: one[:3])[3] if records else None


def compare(new, old, comparable, say):
    """A table: each drive's processor time, memory and stages, and their ratio to the old ones."""
    say("%-28s %-22s %10s %10s %7s" % ("drive", "", "now", "before", "ratio"))

    def row(drive, what, now, before):
        ratio = "%.2f" % (now / before) if comparable and before else "-"
        say("%-28s %-22s %10.2f %10s %7s" %
            (drive, what, now, "-" if before is None else "%.2f" % before, ratio))

    for drive, now in new.items():
        before = old.get(drive, {})
        row(drive, "processor time [s]", now["cpu_s"], before.get("cpu_s"))
        row(drive, "peak memory [MB]", now["peak_mb"], before.get("peak_mb"))
        for stage, seconds in now["stages"].items():
            row(drive, stage + " [s]", seconds, before.get("stages", {}).get(stage))
        if before and before["digest"] != now["digest"]:
            say("%-28s the map is another one: %d landmarks (before: %d)" %
                (drive, now["landmarks"], before["landmarks"]))


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program", help="the roadbook to measure")
    parser.add_argument("--with", dest="other", help="another roadbook, run in turn with the first")
    parser.add_argument("--against", help="a record to compare with; else the newest in bench/history")
    parser.add_argument("--drives", help="folder that keeps the simulated drives; else a temporary one")
    parser.add_argument("--repeat", type=int, default=3, help="runs of each program on each drive")
    parser.add_argument("--save", metavar="VERSION", help="writes bench/history/VERSION.json")
    given = parser.parse_args(arguments)
    if given.repeat < 1:
        parser.error("--repeat: got %d, want 1 or more" % given.repeat)
    if given.against and not os.path.isfile(given.against):
        parser.error("--against: %s: got no such file, want a record" % given.against)
    programs = [given.program] + ([given.other] if given.other else [])
    for program in programs:
        if not os.access(program, os.X_OK):
            parser.error("%s: got no such program, want a built roadbook" % program)

    with tempfile.TemporaryDirectory() as kept:
        drives = simulate_drives(given.program, given.drives or kept)
        figures = [{name: [] for name in drives} for _ in programs]
        for name, drive in drives.items():
            for _ in range(given.repeat):
                for program, of_program in zip(programs, figures):
                    of_program[name].append(map_drive(program, drive))
    results = [{name: middle(runs) for name, runs in of_program.items()} for of_program in figures]

    here = machine()
    if given.other:
        compare(results[0], results[1], True, print)
    else:
        record = newest_record(given.against)
        if record is None:
            print("no record to compare with: --save VERSION writes one")
        elif record["machine"] != here:
            print("%s was measured on another machine: no ratios" % record["version"])
        compare(results[0], record["drives"] if record else {},
                record is not None and record["machine"] == here, print)
    if given.save:
        os.makedirs(HISTORY, exist_ok=True)
        version, _, _ = run([given.program, "--version"])
        date = subprocess.run(["git", "-C", HERE, "log", "-1", "--format=%cs"], text=True,
                              capture_output=True, check=False).stdout.strip()
        file = os.path.join(HISTORY, given.save + ".json")
        with open(file, "w", encoding="utf-8") as text:
            json.dump({"version": given.save, "program": version.strip(), "date": date,
                       "machine": here, "repeat": given.repeat, "drives": results[0]},
                      text, indent=2)
            text.write("\n")
        print("written: " + os.path.relpath(file))


if __name__ == "__main__":
    main(sys.argv[1:])
