#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""docs.py ROOT: the API reference is built without warnings, and no header is missing in it.

Every public symbol has a comment then: what it is, its shape and unit, what it throws, its equation. Exits with 77 where
doxygen is missing."""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

root = pathlib.Path(sys.argv[1])
if not shutil.which("doxygen"):
    print("docs: skipped: doxygen is not installed")
    sys.exit(77)
with tempfile.TemporaryDirectory() as folder:
    done = subprocess.run(["doxygen", "kernels/Doxyfile"], cwd=root, env={**os.environ, "VSB_DOCS": folder},
                          capture_output=True, text=True)
    pages = len(list(pathlib.Path(folder).glob("*_8hpp.html")))
warnings = [line.removeprefix(f"{root.resolve()}/") for line in done.stderr.splitlines() if line.strip()]
for line in warnings:
    print(line)
headers = sum(1 for directory in ("kernels", "physics", "views") for _ in (root / directory).rglob("*.hpp"))
print(f"docs: {len(warnings)} lines of warnings; {pages} of {headers} headers have a page"
      + ("" if pages == headers else ": the others lack a comment that begins with \\file"))
sys.exit(1 if warnings or done.returncode != 0 or pages != headers else 0)
