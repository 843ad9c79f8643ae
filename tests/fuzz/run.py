#!/usr/bin/env python3
"""Runs the fuzz targets of build/fuzz, each for some seconds.

    cmake --preset fuzz && cmake --build --preset fuzz --target fuzz_targets
    python3 tests/fuzz/run.py [--seconds 60] [--map MAP] [TARGET ...]

Findings and what the targets learned stay in build/fuzz/corpus and build/fuzz/findings. Exit status:
0 without a finding, 1 with one, 2 without targets.
"""
import argparse
import os
import pathlib
import subprocess
import sys

sys.dont_write_bytecode = True
import seeds  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]


def run(target, args):
    name = target.name.removeprefix("fuzz_")
    corpus = args.build / "corpus" / name
    findings = args.build / "findings" / name
    corpus.mkdir(parents=True, exist_ok=True)
    findings.mkdir(parents=True, exist_ok=True)
    starts = args.build / "seeds" / name
    seeds.write(name, starts, args.map)
    words = args.build / "seeds" / f"{name}.dict"
    words.write_text(seeds.dictionary(name))
    environment = dict(os.environ, ASAN_OPTIONS="detect_leaks=1:allocator_may_return_null=1")
    if args.map:
        environment["ROADBOOK_FUZZ_MAP"] = str(args.map.resolve())
    command = [target, f"-max_total_time={args.seconds}", "-timeout=10", "-rss_limit_mb=3000",
               "-print_final_stats=1", f"-max_len={seeds.longest(name)}", f"-dict={words}",
               f"-artifact_prefix={findings}/", corpus, starts]
    log = args.build / "findings" / f"{name}.log"
    with open(log, "wb") as output:
        status = subprocess.run(command, stdout=output, stderr=subprocess.STDOUT, env=environment).returncode
    text = log.read_text(errors="replace")
    runs = [line.split()[-1] for line in text.splitlines() if line.startswith("stat::number_of_executed_units")]
    edges = [line for line in text.splitlines() if " cov: " in line]
    coverage = edges[-1].split(" cov: ")[1].split()[0] if edges else "?"
    print(f"{name}: {runs[0] if runs else '?'} runs, {coverage} edges, {'no finding' if status == 0 else 'FINDING, see ' + str(log)}",
          flush=True)
    return status == 0


def main():
    parser = argparse.ArgumentParser(description="runs the fuzz targets")
    parser.add_argument("--seconds", type=int, default=60, help="of each target")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build" / "fuzz")
    parser.add_argument("--map", type=pathlib.Path, help="a map with an overhead image, for labels and map files")
    parser.add_argument("targets", nargs="*", help="names without fuzz_; all by default")
    args = parser.parse_args()
    found = sorted(path for path in (args.build / "tests" / "fuzz").glob("fuzz_*") if os.access(path, os.X_OK) and path.is_file())
    chosen = [path for path in found if not args.targets or path.name.removeprefix("fuzz_") in args.targets]
    if not chosen:
        print(f"error: {args.build}: got no fuzz target, want those of cmake --preset fuzz", file=sys.stderr)
        return 2
    return 0 if all([run(path, args) for path in chosen]) else 1


if __name__ == "__main__":
    sys.exit(main())
