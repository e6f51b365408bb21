#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""Static analysers on the library and the reader of packings: gcc -fanalyzer, clang-tidy (.clang-tidy), cppcheck.

    analyse.py [--tools gcc,clang-tidy,cppcheck] [--jobs N]

Every finding fails but those of tests/analyse.known, each of which names one line of source and a reason; and so does a line of that
list that no tool finds any more.  A tool that is missing is named and left out."""
import argparse
import concurrent.futures
import os
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
FLAGS = ["-std=c11", "-Iinclude", "-iquote", "lib", "-Ibench", "-D_GNU_SOURCE"]
COMMANDS = {
    "gcc": lambda f: ["gcc", *FLAGS, "-O2", "-Wall", "-Wextra", "-fanalyzer", "-c", f, "-o", "/dev/null"],
    "clang-tidy": lambda f: ["clang-tidy", "--quiet", "--config-file=.clang-tidy", f, "--", *FLAGS],
    "cppcheck": lambda f: ["cppcheck", "-q", "--std=c11", "--enable=warning,performance,portability", "-Iinclude", "-Ilib", "-Ibench",
                           "--template={file}:{line}:{column}: {severity}: {message} [{id}]", f],
}
FINDING = re.compile(r"^(\S+?):(\d+):\d+: (?:warning|error|portability|performance|style): (.*) \[(?:-W)?([\w.,=-]+)\]$")
CWE = re.compile(r" \[CWE-\d+\]")


def files(tool):
    found = sorted(ROOT.glob("lib/*.c")) + sorted(ROOT.glob("lib/x86/*.c")) + [ROOT / "bench/packing_io.c"]
    return [str(f.relative_to(ROOT)) for f in found]


def analyse(tool, file):
    run = subprocess.run(COMMANDS[tool](file), cwd=ROOT, capture_output=True, text=True)
    text = run.stdout + run.stderr
    findings = set()
    for line in text.splitlines():
        match = FINDING.match(CWE.sub("", line))
        if not match:
            continue
        path = os.path.relpath(os.path.join(ROOT, match[1]), ROOT)
        source = (ROOT / path).read_text().splitlines()[int(match[2]) - 1].strip()
        findings.add((tool, path, match[4], source, match[3], int(match[2])))
    if run.returncode != 0 and not findings:
        sys.exit(f"analyse: {tool} {file} fails:\n{text}")
    return findings


def read_known():
    known = {}
    for line in (ROOT / "tests/analyse.known").read_text().splitlines():
        if line and not line.startswith("#"):
            tool, path, check, source, reason = line.split("\t")
            known[tool, path, check, source] = reason
    return known


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--tools", default="gcc,clang-tidy,cppcheck")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    options = parser.parse_args()
    known, seen, new, tools = read_known(), set(), set(), []
    for tool in options.tools.split(","):
        if shutil.which(tool):
            tools.append(tool)
        else:
            print(f"analyse: no {tool} here: left out")
    if not tools:
        sys.exit("analyse: none of these tools is here")
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for findings in pool.map(lambda work: analyse(*work), [(t, f) for t in tools for f in files(t)]):
            for finding in findings:
                (seen if finding[:4] in known else new).add(finding)
    for tool, path, check, source, message, line in sorted(new):
        print(f"{path}:{line}: {tool}: {message} [{check}]\n    {source}")
    stale = [k for k in known if k[0] in tools and k not in {s[:4] for s in seen}]
    for tool, path, check, source in stale:
        print(f"tests/analyse.known: {tool} no longer finds {check} in {path}: {source}")
    print(f"analyse: {', '.join(tools)}: {len(new)} findings, {len({s[:4] for s in seen})} false alarms known by line"
          + (f", {len(stale)} of those are gone" if stale else ""))
    sys.exit(1 if new or stale else 0)


main()
