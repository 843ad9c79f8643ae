"""The drawn mutants, and what is known of them and of the ctest entries: one JSON file."""

import dataclasses
import json
import pathlib
import random
import re
import sys
import tempfile
import time

import mutants
from tested_copy import run_entry

HERE = pathlib.Path(__file__).resolve().parent


def read_equivalent():
    lines = (HERE / "equivalent.txt").read_text().splitlines()
    # Not stripped: the key of a dropped guard ends with a blank, as nothing takes its place.
    return {line.rsplit(" | ", 1)[0] for line in lines if line and line[0] != "#"}


class Study:
    """The drawn mutants and what is known of them and of the entries: the JSON file."""

    def __init__(self, copy, options):
        self.copy, self.options = copy, options
        self.path = pathlib.Path(options.out or copy.folder / "build" / "mutation.json")
        self.end = time.monotonic() + 60.0 * options.minutes
        self.sources = copy.sources()
        draw = {"commit": copy.git("rev-parse", "HEAD").decode().strip(), "seed": options.seed,
                "count": options.count, "modules": options.modules}
        if self.path.exists():
            self.state = json.loads(self.path.read_text())
            if self.state["draw"] != draw:
                sys.exit(f"error: {self.path}: got results of {self.state['draw']}, want {draw}")
        else:
            if copy.git("status", "--porcelain", "-uno"):
                sys.exit(f"error: {copy.folder}: got changed files, want a clean copy")
            self.state = {"draw": draw, "mutants": [], "not_writable": [], "entries": {}}
        self.draw()

    def save(self):
        place = self.path.with_suffix(".part")
        place.write_text(json.dumps(self.state | {"shares": self.shares()}, indent=1))
        place.rename(self.path)

    def draw(self):
        """Draws until every module has its mutants. Kinds alike, then places by chance."""
        gone = {m["key"] for m in self.state["not_writable"]} | read_equivalent()
        for module in self.options.modules.split(","):
            drawn = [m for m in self.state["mutants"] if m["module"] == module]
            if len(drawn) == self.options.count:
                continue
            by_kind = {}
            for file, text in sorted(self.sources.items()):
                if file.startswith(module + "/"):
                    for mutant in mutants.candidates(module, file, text):
                        by_kind.setdefault(mutant.kind, []).append(mutant)
            chance = random.Random(f"{self.options.seed} {module}")
            for places in by_kind.values():
                chance.shuffle(places)
            known = gone | {m["key"] for m in drawn}
            while len(drawn) < self.options.count and any(by_kind.values()):
                kinds = [kind for kind in sorted(by_kind) if by_kind[kind]]
                chance.shuffle(kinds)
                for kind in kinds:
                    mutant = by_kind[kind].pop()
                    if mutant.key() in known or len(drawn) == self.options.count:
                        continue
                    known.add(mutant.key())
                    self.add(mutant, drawn)

    def add(self, mutant, drawn):
        """Numbers a mutant, unless its text cannot be changed or belongs to another mutant."""
        record = dataclasses.asdict(mutant) | {"key": mutant.key()}
        number = 1 + len(self.state["mutants"]) + len(self.state["not_writable"])
        source = self.sources[mutant.file]
        try:
            change = mutants.switched(source, mutant, number)
        except ValueError:
            self.state["not_writable"].append(record)
            return
        if any(m["file"] == mutant.file and m["change"][0] < change[1] and change[0] < m["change"][1]
               for m in drawn):
            self.state["not_writable"].append(record)
            return
        record |= {"number": number, "change": change, "tried": []}
        drawn.append(record)
        self.state["mutants"].append(record)

    def write_sources(self):
        """Writes all faults into the copy."""
        changes = {m["file"]: [] for m in self.state["not_writable"] + self.state["mutants"]}
        for mutant in self.state["mutants"]:
            changes[mutant["file"]].append(mutant["change"])
        for file, places in changes.items():
            text = self.sources[file]
            for start, end, new in sorted(places, reverse=True):
                text = text[:start] + new + text[end:]
            if places:
                text = '#include "tests/mutation/switch.hpp"\n#line 1\n' + text
            path = self.copy.folder / file
            if path.read_text() != text:
                path.write_text(text)

    def build(self, targets):
        """Builds; takes mutants back that do not compile, and draws others."""
        while True:
            self.write_sources()
            self.save()
            good, said = self.copy.make(targets)
            if good:
                return
            places = set(re.findall(r"([\w/.]+\.cpp):(\d+):", said))
            bad = [m for m in self.state["mutants"] if any(
                path.endswith("/" + m["file"]) and self.lines(m)[0] <= int(line) <= self.lines(m)[1]
                for path, line in places)]
            if not bad:  # a default value that is refused where a constant takes it
                files = re.findall(r"([\w/.]+\.cpp):\d+:\d+: error", said)
                bad = [m for m in self.state["mutants"]
                       if any(path.endswith("/" + m["file"]) for path in files)]
            if not bad:
                sys.exit(f"{said}\nerror: the copy does not build")
            self.state["mutants"] = [m for m in self.state["mutants"] if m not in bad]
            self.state["not_writable"] += bad
            self.draw()
            print(f"{len(bad)} mutants do not compile behind a switch; others are drawn", flush=True)

    def lines(self, mutant):
        start, end, _ = mutant["change"]
        source = self.sources[mutant["file"]]
        return 1 + source.count("\n", 0, start), 1 + source.count("\n", 0, end)

    def trace(self, entries):
        """Learns what each entry costs and reaches."""
        known = self.state["entries"]
        for name in [n for n in known if re.search(self.options.again or "(?!)", n)]:
            del known[name]
            for mutant in self.state["mutants"]:
                mutant["tried"] = [n for n in mutant["tried"] if n != name]
        most = self.options.entry_seconds
        for count, (name, entry) in enumerate(n for n in entries.items() if n[0] not in known):
            if time.monotonic() > self.end:
                break
            with tempfile.NamedTemporaryFile() as file:
                good, seconds = run_entry(entry, {"ROADBOOK_MUTANT_TRACE": file.name}, most, 10.0 * most)
                reached = sorted({int(line) for line in pathlib.Path(file.name).read_text().split()})
            known[name] = {"seconds": round(seconds, 2), "reaches": reached}
            if not good:
                known[name]["left_out"] = ("costs too much" if seconds > 0.9 * most
                                           else "fails without a fault")
                print(f"{name}: {known[name]['left_out']}", flush=True)
            if count % 20 == 0:
                self.save()
        self.save()

    def to_try(self, mutant, entries):
        """Entries for a mutant, cheapest first, and how many more reach it at a higher cost."""
        known = self.state["entries"]
        names = [n for n in entries if n in known and "left_out" not in known[n]
                 and mutant["number"] in known[n]["reaches"] and n not in mutant["tried"]]
        left = self.options.test_seconds - sum(known[n]["seconds"] for n in mutant["tried"] if n in known)
        chosen = []
        for name in sorted(names, key=lambda n: (known[n]["seconds"], n)):
            left -= known[name]["seconds"]
            if left < 0.0:
                break
            chosen.append(name)
        return chosen, len(names) - len(chosen)

    def judge(self, mutant, entries):
        known = self.state["entries"]
        names, mutant["not_tried"] = self.to_try(mutant, entries)
        for name in names:
            seconds = known[name]["seconds"]
            limits = 3.0 * seconds + 10.0, 30.0 * seconds + 100.0
            good, _ = run_entry(entries[name], {"ROADBOOK_MUTANT": str(mutant["number"])}, *limits)
            if not good and not run_entry(entries[name], {}, *limits)[0]:
                known[name]["left_out"] = "fails at times without a fault"
                continue
            if not good:
                mutant["noticed_by"] = name
                break
            mutant["tried"].append(name)
        print(outcome(mutant), flush=True)

    def judge_all(self, entries):
        """Those with the cheapest tests first."""
        def cost(mutant):
            names, _ = self.to_try(mutant, entries)
            return sum(self.state["entries"][n]["seconds"] for n in names)

        for mutant in sorted(self.state["mutants"], key=lambda m: (cost(m), m["number"])):
            if time.monotonic() > self.end:
                break
            new = "not_tried" not in mutant or self.to_try(mutant, entries)[0]
            if "noticed_by" not in mutant and new:
                self.judge(mutant, entries)
                self.save()

    def shares(self):
        """By module: judged, noticed, reached by no entry, equivalent."""
        equivalent = read_equivalent()
        result = {}
        for module in [*self.options.modules.split(","), "all"]:
            drawn = [m for m in self.state["mutants"] if module in (m["module"], "all")]
            real = [m for m in drawn if m["key"] not in equivalent]
            judged = [m for m in real if "noticed_by" in m or "not_tried" in m]
            result[module] = {
                "drawn": len(drawn), "judged": len(judged),
                "noticed": sum("noticed_by" in m for m in judged),
                "not_reached": sum("noticed_by" not in m and not m["tried"] and not m["not_tried"]
                                   for m in judged),
                "equivalent": len(drawn) - len(real)}
        return result


def outcome(mutant):
    said = (f"noticed by {mutant['noticed_by']}" if "noticed_by" in mutant else
            f"survived {len(mutant['tried'])} entries, {mutant['not_tried']} not tried")
    change = f"{' '.join(mutant['old'].split())} -> {mutant['new']}"
    return (f"{mutant['file']}:{mutant['line']}: {mutant['kind']}: {mutant['text']}   [{change}] "
            f"number {mutant['number']}: {said}")
