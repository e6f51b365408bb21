#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""Lines and branches of lib/ that the tests do not reach.

    coverage.py BUILD       the folder of a build with --coverage whose tests have been run; needs gcovr

Every line fails but those of tests/coverage.known: kind (line or branch), file, the line of source and a reason, tabs between; where
the same text stands in several places, as many of them as it has lines there.
A branch is a line that was run with one of its branches never taken."""
import json
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent


def read_known():
    known = {}
    for line in (ROOT / "tests/coverage.known").read_text().splitlines():
        if line and not line.startswith("#"):
            kind, path, source, _ = line.split("\t")
            known[kind, path, source] = known.get((kind, path, source), 0) + 1
    return known


def measure(build):
    """What is missing, as (kind, file, source): numbers of lines; and counts of lines and branches."""
    run = subprocess.run(["gcovr", "--root", str(ROOT), "--filter", str(ROOT / "lib") + "/", "--gcov-ignore-parse-errors", "--json", "-", build], capture_output=True,
                         text=True, check=True)
    missing, counts = {}, {"line": [0, 0], "branch": [0, 0]}
    for file in json.loads(run.stdout)["files"]:
        text = (ROOT / file["file"]).read_text().splitlines()
        merged = {}  # of a header: all files that include it
        for line in file["lines"]:
            if line.get("gcovr/noncode"):
                continue
            count, branches = merged.setdefault(line["line_number"], [0, []])
            merged[line["line_number"]][0] = count + line["count"]
            for k, b in enumerate(line.get("branches", [])):
                if k < len(branches):
                    branches[k] += b["count"]
                else:
                    branches.append(b["count"])
        for number, (count, branches) in sorted(merged.items()):
            source = text[number - 1].strip()
            counts["line"][0] += count > 0
            counts["line"][1] += 1
            counts["branch"][0] += sum(b > 0 for b in branches)
            counts["branch"][1] += len(branches)
            if count == 0:
                missing.setdefault(("line", file["file"], source), []).append(number)
            elif not all(branches):
                missing.setdefault(("branch", file["file"], source), []).append(number)
    return missing, counts


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    known = read_known()
    missing, counts = measure(sys.argv[1])
    if "avx512f" not in pathlib.Path("/proc/cpuinfo").read_text():
        print("coverage: lib/x86/avx512.c is left out: this processor has no AVX-512")
        missing = {k: v for k, v in missing.items() if k[1] != "lib/x86/avx512.c"}
        known = {k: v for k, v in known.items() if k[1] != "lib/x86/avx512.c"}
    new = [k for k in missing if len(missing[k]) > known.get(k, 0)]
    gone = [k for k in known if k not in missing]
    for kind, path, source in sorted(new):  # branches first, so that lines are not lost above them
        print(f"{path}:{','.join(map(str, missing[kind, path, source]))}: {kind} never reached: {source}")
    for kind, path, source in gone:
        print(f"tests/coverage.known: reached by now: {kind} {path}: {source}")
    for kind, (reached, all_of_them) in counts.items():
        print(f"coverage: {reached} of {all_of_them} {'lines' if kind == 'line' else 'branches'}, "
              f"{100 * reached / all_of_them:.1f} %; {sum(k[0] == kind for k in known) - sum(k[0] == kind for k in gone)} not reached with a reason, "
              f"{sum(k[0] == kind for k in new)} without one")
    sys.exit(1 if new else 0)


main()
