"""Deliberate faults in C++ sources: where they can be put, and how the text changes."""

import dataclasses
import re

MODULES = ("base", "sensors", "drive", "vo", "mapping", "semantics", "roadnet", "speedmap",
           "diagnosis", "exchange", "sim", "workflows", "apps")

TURNED = {"<": ">=", ">=": "<", ">": "<=", "<=": ">", "==": "!=", "!=": "=="}
OFF_BY_ONE = {"<": "<=", "<=": "<", ">": ">=", ">=": ">"}


@dataclasses.dataclass(frozen=True)
class Mutant:
    """One fault: `old` at `start` of the file's text becomes `new`."""
    module: str
    file: str  # relative to the source tree
    line: int
    kind: str
    start: int
    old: str
    new: str
    text: str  # the whole line, blanks trimmed

    def key(self):
        return f"{self.file} | {self.kind} | {self.text} | {self.old.strip()} -> {self.new.strip()}"


def blanked(source):
    """The source with comments, strings and preprocessor lines replaced by blanks of the same
    length, so that positions stay."""
    pattern = re.compile(
        r'//[^\n]*|/\*.*?\*/|R"\((?:.|\n)*?\)"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'|^\s*#[^\n]*',
        re.S | re.M)
    return pattern.sub(lambda m: re.sub(r"[^\n]", " ", m.group()), source)


def candidates(module, file, source):
    """All mutants of one file, in the order of their places."""
    code = blanked(source)
    lines = source.split("\n")
    starts = [0]
    for line in lines:
        starts.append(starts[-1] + len(line) + 1)
    found = []

    def add(kind, start, old, new):
        number = code.count("\n", 0, start)
        text = lines[number].strip()
        # Assertions of our own, static checks and constants of the documentation are no behaviour.
        if "ROADBOOK_ASSERT" in text or "static_assert" in text:
            return
        found.append(Mutant(module, file, number + 1, kind, start, old, new, text))

    # clang-format puts blanks around binary operators, and none around template brackets.
    for match in re.finditer(r" (<=|>=|==|!=|<|>) ", code):
        operator = match.group(1)
        add("comparison turned", match.start(1), operator, TURNED[operator])
        # Of real numbers, a bound that is or is not included changes nothing that can be seen.
        right = code[match.end():match.end() + 60]
        of_whole = re.match(r"(-?\d+(?![.\d])|[\w.>\[\]-]*(?:size|count|rows|cols)\w*\b)", right)
        in_loop = lines[code.count("\n", 0, match.start())].lstrip().startswith("for (")
        if operator in OFF_BY_ONE and (of_whole or in_loop):
            add("bound off by one", match.start(1), operator, OFF_BY_ONE[operator])
    for match in re.finditer(r" ([+-]) |( [+-]=) ", code):
        old = (match.group(1) or match.group(2)).strip()
        start = match.start() + 1
        # Strings are joined by '+', which has no opposite.
        line = lines[code.count("\n", 0, start)]
        if '"' in line or "string" in line or "text" in line:
            continue
        add("sign", start, old, old.replace("+", "?").replace("-", "+").replace("?", "-"))
    for match in re.finditer(r"(?<![\w.])(\d+\.\d+(?:e[+-]?\d+)?|\d+e[+-]?\d+)(?![\w.])", code):
        value = float(match.group(1))
        if value == 0.0:
            continue
        add("constant x 1.2", match.start(1), match.group(1), repr(1.2 * value))
    for match in re.finditer(r"(?<=\n)[ ]+if \([^;{}\n]*\)\s+(?:return|continue|break|throw)\b[^;{}]*;",
                             code):
        if match.group().count("(") != match.group().count(")"):
            continue
        start = match.start() + len(match.group()) - len(match.group().lstrip())
        old = source[start:match.end()]
        if code[match.end():].lstrip().startswith("else"):
            continue
        add("guard dropped", start, old, "")
    for match in re.finditer(r"\b[a-z]\w*\((\w[\w.]*), (\w[\w.]*)\)", code):
        if match.group(1) == match.group(2):
            continue
        old = match.group()
        head = old[:old.index("(") + 1]
        add("arguments swapped", match.start(), old, f"{head}{match.group(2)}, {match.group(1)})")
    for match in re.finditer(r" (&&|\|\|) ", code):
        add("and for or", match.start(1), match.group(1), "||" if match.group(1) == "&&" else "&&")
    for match in re.finditer(r"\bstd::(min|max)\(", code):
        add("min for max", match.start(1), match.group(1), "max" if match.group(1) == "min" else "min")
    return sorted(found, key=lambda m: (m.start, m.kind))
