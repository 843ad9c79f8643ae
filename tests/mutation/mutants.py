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


def blanked(source, string=" "):
    """The source with comments and preprocessor lines replaced by blanks, and strings by `string`,
    of the same length, so that positions stay."""
    pattern = re.compile(
        r'//[^\n]*|/\*.*?\*/|R"\((?:.|\n)*?\)"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'|^\s*#[^\n]*',
        re.S | re.M)
    return pattern.sub(lambda m: re.sub(r"[^\n]", string if m.group()[0] in "R\"'" else " ", m.group()),
                       source)


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
        if match.group(1) == match.group(2) or re.match(r"(f?max|f?min|hypot)\(", match.group()):
            continue
        old = match.group()
        head = old[:old.index("(") + 1]
        add("arguments swapped", match.start(), old, f"{head}{match.group(2)}, {match.group(1)})")
    for match in re.finditer(r" (&&|\|\|) ", code):
        add("and for or", match.start(1), match.group(1), "||" if match.group(1) == "&&" else "&&")
    for match in re.finditer(r"\bstd::(min|max)\(", code):
        add("min for max", match.start(1), match.group(1), "max" if match.group(1) == "min" else "min")
    return sorted(found, key=lambda m: (m.start, m.kind))


# How the text changes, so that the fault is there only where its switch is on (switch.hpp).

PRECEDENCE = {",": 0, ";": 0, "return": 0, "throw": 0, "case": 0, "else": 0, "?": 1, ":": 1, "||": 2,
              "&&": 3, "|": 4, "^": 5, "&": 6, "==": 7, "!=": 7, "<": 8, ">": 8, "<=": 8, ">=": 8,
              "<=>": 9, "<<": 10, ">>": 10, "+": 11, "-": 11}
ASSIGNMENT = re.compile(r"[-+*/%&|^]?=|<<=|>>=")
TOKEN = re.compile(r"->|::|<=>|<<=|>>=|[-+*/%&|^=!<>]=|&&|\|\||<<|>>|\w+|\S")
OPENING, CLOSING = "([{", ")]}"


def tokens(code):
    """(start, text, precedence) of each token; precedence is None within operands. An operator with
    blanks on both sides is binary (clang-format); other '<' and '>' are brackets of templates."""
    found = []
    for match in TOKEN.finditer(code):
        text = match.group()
        blanks = code[match.start() - 1].isspace() and code[match.end():match.end() + 1].isspace()
        precedence = PRECEDENCE.get(text)
        if precedence is not None and precedence >= 2 and not blanks:
            precedence = None
            if text in ("<", ">", ">>"):
                text = "{" * (text == "<") + "}" * text.count(">")
        elif ASSIGNMENT.fullmatch(text) and text not in PRECEDENCE:
            precedence = 1
        found.append((match.start(), text, precedence))
    return found


def operand_end(code, at, lowest):
    """The end of the expression that holds the position `at`: a bracket that closes outside it or an
    operator that binds weaker than `lowest`."""
    depth = 0
    for start, text, precedence in tokens(code[at:at + 4000]):
        if text[0] in CLOSING:
            depth -= len(text)
            if depth < 0:
                break
        elif text[0] in OPENING:
            depth += 1
        elif depth == 0 and precedence is not None and precedence < lowest:
            break
    return at + len(code[at:at + start].rstrip())


def operand_start(code, at, lowest):
    """The start of that expression."""
    begin = max(0, at - 4000)
    depth = 0
    after = at
    for start, text, precedence in reversed(tokens(code[begin:at])):
        if text[0] in OPENING:
            depth -= 1
            if depth < 0:
                break
        elif text[0] in CLOSING:
            depth += len(text)
        elif depth == 0 and precedence is not None and precedence < lowest:
            break
        after = begin + start
    return after


def switched(source, mutant, number):
    """(start, end, text): source[start:end] becomes text, which has the fault where switch `number`
    is on. Each part of the source keeps its line. ValueError if the text cannot be changed so."""
    code = blanked(source, "_")
    on = f"::mutation::on({number})"
    start, end = mutant.start, mutant.start + len(mutant.old)
    if mutant.kind == "guard dropped":
        return start, end, f"if (!{on}) {{ {mutant.old} }}"
    if mutant.kind == "sign":
        last = operand_end(code, end, 12)
        return end, last, f" ({on} ? -1 : 1) * ({source[end:last].lstrip()})"
    if mutant.kind == "arguments swapped":
        head = mutant.old[:mutant.old.index("(") + 1]
        first, second = mutant.old[len(head):-1].split(", ")
        return start, end, f"{head}{on} ? {second} : {first}, {on} ? {first} : {second})"
    if mutant.kind == "constant x 1.2":
        return constant_switched(source, mutant, f"({on} ? {mutant.new} : {mutant.old})")
    if mutant.kind == "min for max":
        first = start - len("std::")
        last = closing(code, end) + 1
        old, new = source[first:last], f"std::{mutant.new}{source[end:last]}"
    else:
        lowest = 2 if mutant.kind == "and for or" else PRECEDENCE[mutant.old]
        first, last = operand_start(code, start, lowest), operand_end(code, end, lowest)
        old = source[first:last]
        new = f"{source[first:start]}{mutant.new}{source[end:last]}"
    if "//" in old:
        raise ValueError("a comment within the expression")
    return first, last, f"({on} ? ({' '.join(new.split())}) : ({old}))"


def closing(code, opening):
    depth = 0
    for i in range(opening, len(code)):
        depth += (code[i] in OPENING) - (code[i] in CLOSING)
        if depth == 0:
            return i
    raise ValueError("a bracket without its end")


def constant_switched(source, mutant, text):
    """A constexpr of one line becomes an object that asks its switch at each use."""
    start, end = mutant.start, mutant.start + len(mutant.old)
    first = source.rfind("\n", 0, start) + 1
    last = source.find("\n", end)
    declared = re.fullmatch(r"(\s*)(?:inline |static )*constexpr (double|float) (\w+) = (.*);(.*)",
                            source[first:last])
    if not declared:
        return start, end, text
    blank, kind, name, _, rest = declared.groups()
    value = source[first + declared.start(4):start] + text + source[end:first + declared.end(4)]
    return first, last, (f"{blank}const struct {{ operator {kind}() const {{ return {value}; }} }} "
                         f"{name}{{}};{rest}")
