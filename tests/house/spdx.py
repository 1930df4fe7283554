#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""spdx.py ROOT: every source file under ROOT says in its first lines under which license it is."""
import pathlib
import sys

DIRECTORIES = ("views", "physics", "kernels", "apps", "bench", "tests", "third_party")
SUFFIXES = (".hpp", ".cpp", ".h", ".c", ".py", ".sh", ".cmake")
LINE = "SPDX-License-Identifier: BSD-3-Clause"

root = pathlib.Path(sys.argv[1])
files = [root / "CMakeLists.txt"]
for directory in DIRECTORIES:
    files += [path for path in sorted((root / directory).rglob("*")) if path.is_file()
              and (path.suffix in SUFFIXES or path.name == "CMakeLists.txt" or not path.suffix)
              and not {"__pycache__", "build"} & set(path.parts)]
missing = [path for path in files if LINE not in "".join(path.read_text(errors="replace").splitlines(True)[:2])]
for path in missing:
    print(f"{path.relative_to(root)}: no '{LINE}' in its first two lines")
print(f"spdx: {len(files)} files, {len(missing)} without the line")
sys.exit(1 if missing or len(files) < 30 else 0)
