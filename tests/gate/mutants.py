#!/usr/bin/env python3
"""Mutation test of the force gate: changes one operator, constant or statement at a time, compiles test_gate against the
changed header and expects it to fail.

  python3 tests/gate/mutants.py [--compiler clang++] [--eigen /usr/include/eigen3] [--header palpate/haptic/force_gate.ipp]

A mutant that survives is an error unless EQUIVALENT lists it with the reason why it changes nothing. Needs only Python
and a compiler; takes some minutes.
"""
import argparse, pathlib, re, subprocess, sys, tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SWAPS = [  # (pattern, replacements); operators have blanks around them in this code
    (r" < ", [" <= ", " > "]), (r" <= ", [" < ", " > "]), (r" > ", [" >= ", " < "]), (r" >= ", [" > ", " < "]),
    (r" == ", [" != "]), (r" != ", [" == "]), (r" && ", [" || "]), (r" \|\| ", [" && "]),
    (r" \+ ", [" - "]), (r" - ", [" + "]), (r" \* ", [" / "]), (r" / ", [" * "]),
    (r"!(?=[a-z(])", [""]), (r"std::min\(", ["std::max("]), (r"std::max\(", ["std::min("]),
    (r"(?<![\w.])\d+\.\d+(?:e-?\d+)?|(?<![\w.])\d+e-?\d+", ["NUMBER"]),
    (r"\btrue\b", ["false"]), (r"\bfalse\b", ["true"]),
    (r"StatusFlag::(\w+)", ["FLAG"]),
    (r" \? ([^:]+) : ([^;,)]+)", ["FIRST", "SECOND"]),
]
# (line of the file, mutated line), both stripped -> why nothing changes
EQUIVALENT = {
    ("bool shortened = false;", "bool shortened = true;"): "limit_length sets it in every case",
}


def mutants(text):
    for number, line in enumerate(text.split("\n")):
        code = line.split("//")[0]
        if code.lstrip().startswith("#") or not code.strip() or "template <" in code:
            continue
        code_no_strings = re.sub(r'"[^"]*"', lambda m: '"' + "_" * (len(m.group()) - 2) + '"', code)
        for pattern, replacements in SWAPS:
            for m in re.finditer(pattern, code_no_strings):
                for r in replacements:
                    if r == "NUMBER":
                        v = float(m.group())
                        news = ["1.0"] if v == 0.0 else [repr(v * 2.0), "0.0"] if v == 1.0 else [repr(v * 1.25)]
                    elif r == "FLAG":
                        news = ["StatusFlag::inverted"]
                    elif r == "FIRST":
                        news = [" ? " + m.group(1) + " : " + m.group(1)]
                    elif r == "SECOND":
                        news = [" ? " + m.group(2) + " : " + m.group(2)]
                    else:
                        news = [r]
                    for new in news:
                        yield number, line[:m.start()] + new + line[m.end():]
        s = code.strip()  # mutant: a whole statement with a side effect is removed
        if s.endswith(";") and re.match(r"^(if \(.*\) )?[\w.]+(_|\.\w+\(.*\)| =)", s) and not s.startswith(("return", "const ", "double ", "static ")):
            yield number, line[: len(line) - len(line.lstrip())] + ";"


def main():
    p = argparse.ArgumentParser()
    p.add_argument("--compiler", default="clang++")
    p.add_argument("--eigen", default="/usr/include/eigen3")
    gate = "palpate/haptic/force_gate"  # the file with its definitions, where they are separate from the declarations
    p.add_argument("--header", default=gate + (".ipp" if (ROOT / f"include/{gate}.ipp").exists() else ".hpp"))
    p.add_argument("--lines", default="1-1000000", help="only these, as 50-60")
    a = p.parse_args()
    original = (ROOT / "include" / a.header).read_text()
    lines = original.split("\n")
    killed, not_compiled, equivalent, survived = 0, 0, 0, []
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        target = folder / a.header
        target.parent.mkdir(parents=True)
        common = ["-std=c++20", "-O1", "-isystem", a.eigen]
        includes = [f"-I{folder}", f"-I{ROOT / 'include'}"]
        warm = folder / "warm.hpp"  # headers that no mutant changes are compiled once
        warm.write_text("#include <palpate/concepts/haptic_device.hpp>\n#include <palpate/core/setup_error.hpp>\n"
                        "#include <algorithm>\n#include <cmath>\n#include <cstdio>\n")
        subprocess.run([a.compiler, *common, *includes, "-x", "c++-header", str(warm), "-o", str(folder / "warm.hpp.pch")], check=True)
        warmed = ["-include-pch", str(folder / "warm.hpp.pch")] if "clang" in a.compiler else []

        def passes(text):
            target.write_text(text)
            program = folder / "test_gate"
            program.unlink(missing_ok=True)
            r = subprocess.run([a.compiler, *common, *warmed, *includes, str(ROOT / "tests/gate/main.cpp"), "-o", str(program)],
                               capture_output=True, text=True)
            if r.returncode != 0:
                return None
            try:
                return subprocess.run([str(program)], capture_output=True, timeout=200).returncode == 0
            except subprocess.TimeoutExpired:
                return False

        if passes(original) is not True:
            sys.exit("the unchanged gate does not pass")
        seen = set()
        first, last = (int(n) for n in a.lines.split("-"))
        for number, new in mutants(original):
            if (number, new) in seen or new == lines[number] or not first <= number + 1 <= last:
                continue
            seen.add((number, new))
            verdict = passes("\n".join(lines[:number] + [new] + lines[number + 1:]))
            key = (lines[number].strip(), new.strip())
            if verdict is None:
                not_compiled += 1
            elif not verdict:
                killed += 1
            elif key in EQUIVALENT:
                equivalent += 1
            else:
                survived.append((number + 1, *key))
                print(f"SURVIVED line {number + 1}: {key[0]}\n                  -> {key[1]}", flush=True)
    print(f"{a.header}: {killed} mutants killed, {equivalent} equivalent (each with its reason), {not_compiled} do not compile, "
          f"{len(survived)} survived")
    return 1 if survived else 0


if __name__ == "__main__":
    sys.exit(main())
