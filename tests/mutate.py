#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""Mutation test: breaks the library in one place after the other, and looks whether the tests notice.

    mutate.py [--only WORD] [--every N] [--first-only] [--trust] [--work FOLDER] [--done FILE] [--list]

tests/mutants has a line for each mutant: file, tests most likely to notice, text, what it becomes and, where no test can be expected
to notice, why; tabs between.  The text must be in the file just once.  Each mutant is built in a copy of the sources; its tests
run first, then, unless there is such a reason, the others.  What fails, hangs or does not compile is killed.  Fails if fewer than
95 % are killed, or if a survivor has no reason.

It takes hours: what is killed is noted in FILE, and not tried again as long as the file that it changes is the same."""
import argparse
import hashlib
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
COPIED = ["Makefile", "include", "lib", "tests", "bench"]
ENOUGH = 0.95
FUZZ = "test_fuzz"  # the fuzzing programs on their corpus
LONGEST = 60  # seconds of processor time: a test that takes longer hangs


def read_mutants():
    mutants = []
    for number, line in enumerate((ROOT / "tests/mutants").read_text().splitlines(), 1):
        if not line or line.startswith("#"):
            continue
        fields = line.split("\t")
        if len(fields) not in (4, 5):
            sys.exit(f"tests/mutants:{number}: {len(fields)} fields")
        file, tests, old, new = fields[:4]
        count = (ROOT / file).read_text().count(old)
        if count != 1:
            sys.exit(f"tests/mutants:{number}: {file} has {count} times '{old}'")
        mutants.append((number, file, ["test_" + t for t in tests.split(",")], old, new, fields[4] if len(fields) == 5 else ""))
    return mutants


def make(work, *targets):
    environment = {k: v for k, v in os.environ.items() if k not in ("MAKEFLAGS", "MFLAGS", "MAKELEVEL", "B")}
    # tests/platforms/check.h in the place of Check: the first failure ends the program
    return subprocess.run(["make", "-s", "-C", str(work), "B=" + str(work / "build"), "CFLAGS=-O1", "CHECK_LIBS=",
                           "CHECK_CFLAGS=-I" + str(work / "tests/platforms"), *targets], capture_output=True, text=True, env=environment)


def run(work, test):
    """Whether it passes."""
    if test != FUZZ:
        return wait([str(work / "build/tests" / test)], work)
    return all(wait([str(work / "build/tests/fuzz" / ("fuzz_" + name)), "--random", "300", "1", str(work / "tests/fuzz/corpus" / name)], work)
               for name in sorted(p.name for p in (work / "tests/fuzz/corpus").iterdir()))


def limit_time():
    resource.setrlimit(resource.RLIMIT_CPU, (LONGEST, LONGEST))


def wait(command, work):
    # threads that wait for each other use no processor time; a session of its own, so that all of it is ended
    program = subprocess.Popen(command, cwd=work, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True,
                               preexec_fn=limit_time)
    try:
        return program.wait(15 * LONGEST) == 0
    except subprocess.TimeoutExpired:
        os.killpg(program.pid, signal.SIGKILL)
        program.wait()
        return False


def target(work, test):
    return "fuzz-programs" if test == FUZZ else str(work / "build/tests" / test)


def try_mutant(work, mutant, others):
    """The name of what kills it, or None."""
    number, file, first, old, new, reason = mutant
    path = work / file
    text = path.read_text()
    path.write_text(text.replace(old, new))
    try:
        for test in first + [t for t in others if t not in first]:
            if make(work, target(work, test)).returncode != 0:
                return "the compiler"
            if not run(work, test):
                return test
        return None
    finally:
        path.write_text(text)


def read_done(path):
    """Mutants killed before: a digest of the file as they leave it, and who did it."""
    return dict(line.split(" ", 1) for line in path.read_text().splitlines()) if path.exists() else {}


def digest_of(mutant):
    number, file, first, old, new, reason = mutant
    return hashlib.sha256((file + "\n" + (ROOT / file).read_text().replace(old, new)).encode()).hexdigest()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--only", default="", help="mutants of files whose name holds this")
    parser.add_argument("--every", type=int, default=1, help="every Nth of those")
    parser.add_argument("--first-only", action="store_true", help="only the tests named, not the others")
    parser.add_argument("--trust", action="store_true", help="do not look whether the tests pass with the library as it is")
    parser.add_argument("--work", type=pathlib.Path, default=ROOT / "build/mutants")
    parser.add_argument("--done", type=pathlib.Path, help="what is killed is noted here, and not tried again; default: FOLDER.killed")
    parser.add_argument("--list", action="store_true", help="only look whether every text is where it should be")
    options = parser.parse_args()
    mutants = [m for m in read_mutants() if options.only in m[1]][::options.every]
    if options.list:
        print(f"mutate: {len(mutants)} mutants, each text found once")
        return
    every_test = sorted(p.stem for p in (ROOT / "tests").glob("test_*.c")) + [FUZZ]
    work = options.work.resolve()
    done_file = (options.done or work.with_name(work.name + ".killed")).resolve()
    done = read_done(done_file)
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    for name in COPIED:
        source = ROOT / name
        if source.is_dir():
            shutil.copytree(source, work / name)
        else:
            shutil.copy2(source, work / name)
    for test in [] if options.trust else sorted({t for m in mutants for t in m[2]} if options.first_only else set(every_test)):
        built = make(work, target(work, test))
        if built.returncode != 0:
            sys.exit(f"mutate: the library as it is does not build:\n{built.stderr}")
        if not run(work, test):
            sys.exit(f"mutate: {test} fails with the library as it is")
    killed, survivors = 0, []
    for mutant in mutants:
        number, file, first, old, new, reason = mutant
        digest = digest_of(mutant)
        killer = done.get(digest) or try_mutant(work, mutant, [] if options.first_only or reason else every_test)
        if killer:
            if digest not in done:
                with done_file.open("a") as notes:
                    notes.write(f"{digest} {killer}\n")
            killed += 1
            print(f"{number}: {file}: killed by {killer}: {old} -> {new}" + (" although it should survive" if reason else ""), flush=True)
        else:
            survivors.append(mutant)
            print(f"{number}: {file}: SURVIVES: {old} -> {new}: {reason or 'no reason known'}", flush=True)
    share = killed / len(mutants)
    unexplained = [m for m in survivors if not m[5]]
    print(f"mutate: {len(mutants)} mutants, {killed} killed ({100 * share:.1f} %), {len(survivors)} survive, "
          f"{len(unexplained)} of them without a reason")
    shutil.rmtree(work, ignore_errors=True)
    sys.exit(1 if share < ENOUGH or unexplained else 0)


main()
