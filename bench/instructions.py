#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""instructions.py PROGRAM [--update]: counts the instructions of every kernel of PROGRAM (vsb_instructions) under
callgrind and compares them with instructions.json: counts do not depend on how busy the machine is.

Fails where a kernel needs GATE percent more than stored, or fewer: an improvement is to be stored, with --update, so
that it cannot be lost unnoticed. Exit status: 0 as stored, 1 not as stored, 77 skipped: no valgrind, or a compiler,
flags or Kokkos other than those of the stored counts.
"""
import argparse
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

GATE = 3  # percent
SMALLEST = 5000  # instructions; smaller kernels are not compared: launching one takes about a thousand
SKIPPED = 77
BASELINE = pathlib.Path(__file__).with_name("instructions.json")


def skip(reason):
    print(f"instructions: skipped: {reason}")
    sys.exit(SKIPPED)


def count(program):
    """What the counts depend on, and the counts by scene and kernel."""
    valgrind = shutil.which("valgrind")
    if not valgrind:
        skip("no valgrind here; third_party/setup installs it")
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder, "callgrind.out")
        run = subprocess.run([valgrind, "--tool=callgrind", "--combine-dumps=yes", f"--callgrind-out-file={out}", program],
                             env={**os.environ, "OMP_NUM_THREADS": "1", "OMP_PROC_BIND": "false"}, capture_output=True, text=True)
        if run.returncode == SKIPPED:
            skip(run.stderr.strip().splitlines()[-1])
        if run.returncode != 0:
            sys.exit(f"instructions: {program} under valgrind ended with {run.returncode}\n{run.stderr}")
        text = out.read_text()
    facts = dict(line.split(": ", 1) for line in run.stdout.splitlines())
    counts = {}
    for scene, kernel, number in re.findall(
            r"^desc: Trigger: Client Request: (\S+) vsb::(\S+)\n(?:.*\n){1,8}?summary: (\d+)$", text, re.MULTILINE):
        name = f"{scene} {kernel}"
        counts[name] = counts.get(name, 0) + int(number)
    if len(counts) < 10:
        sys.exit(f"instructions: only {len(counts)} kernels were counted")
    return facts, counts


def compare(stored, counts):
    """A row per kernel that differs by more than the gate."""
    rows = []
    for name in sorted(stored | counts):
        before, now = stored.get(name), counts.get(name)
        if max(before or 0, now or 0) < SMALLEST:
            continue
        percent = 100 * (now / before - 1) if before and now else None
        if percent is None or abs(percent) > GATE:
            rows.append((name, before, now, percent))
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--update", action="store_true", help="store the counts")
    options = parser.parse_args()
    facts, counts = count(options.program)
    if options.update:
        BASELINE.write_text(json.dumps({"facts": facts, "instructions": counts}, indent=1) + "\n")
        print(f"instructions: {len(counts)} counts stored in {BASELINE}")
        return
    stored = json.loads(BASELINE.read_text())
    for fact, value in stored["facts"].items():
        if facts.get(fact) != value:
            skip(f"{fact} is {facts.get(fact)}, that of the stored counts {value}")
    rows = compare(stored["instructions"], counts)
    print(f"instructions: {len(counts)} kernels counted, {len(rows)} differ from what is stored by more than {GATE} %")
    if not rows:
        return
    print(f"{'scene and kernel':50} {'stored':>10} {'now':>10} {'change':>9}")
    for name, before, now, percent in rows:
        change = "new" if before is None else "gone" if now is None else f"{percent:+.1f} %"
        print(f"{name:50} {before if before is not None else '-':>10} {now if now is not None else '-':>10} {change:>9}")
    print(f"Where this is meant, store it: {sys.executable} {' '.join(sys.argv)} --update")
    sys.exit(1)


main()
