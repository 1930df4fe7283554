#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""layers.py ROOT: the directories include only what they may, and nothing names the package hosts of one machine.

  views    the standard library, Kokkos, views, the compiler's intrinsics
  physics  the standard library, Kokkos_Complex, physics, and of views what describes a point (POINT_VIEWS)
  kernels  the standard library, Kokkos, kernels, physics, views; among the directories within, KERNELS
  apps     what they like of these and of other libraries; of each other, the directories before them in APPS
The programs' libraries (files, command line, formats) live in apps alone, so the above rules them out elsewhere.
"""
import os
import pathlib
import re
import sys

POINT_VIEWS = ("tensor", "kokkos_compat", "masks", "pack", "pack_native", "static_for")
STANDARD = r"[a-z_]+"  # <vector>; other libraries' headers have a folder, a suffix or a capital letter
ALLOWED = {
    "views": [STANDARD, r"Kokkos_\w+\.hpp", r"vsb/views/\w+\.hpp", r"immintrin\.h"],
    "physics": [STANDARD, r"Kokkos_Complex\.hpp", r"vsb/physics/\w+\.hpp",
                rf"vsb/views/({'|'.join(POINT_VIEWS)})\.hpp"],
    "kernels": [STANDARD, r"Kokkos_\w+\.hpp", r"vsb/(kernels(/\w+)?|physics|views)/\w+\.hpp"],
}
# The two engines know nothing of each other, but that lanes begin with the particle kernels' types and end in them.
KERNELS = {
    "particles": ("particles", "boundary"),
    "boundary": ("particles", "boundary"),
    "statics": ("particles", "boundary", "statics"),
    "mesh": ("mesh",),
    "readout": ("particles", "boundary", "readout"),
    "lanes": ("particles", "boundary", "readout", "lanes"),
}
APPS = ("scene", "setup", "engine", "report", "files", "run", "study")
INCLUDE = re.compile(r'^\s*#\s*include\s*(["<].*)$', re.MULTILINE)
TEXT = (".hpp", ".cpp", ".py", ".sh", ".cmake", ".txt", ".toml", ".json", ".md", ".yml", ".yaml", ".cff", ".in", "")
SKIPPED = {".git", "build", "results", "third_party", "__pycache__"}


def include_violations(root):
    found, files = [], 0
    for directory, patterns in ALLOWED.items():
        for path in sorted((root / directory).rglob("*")):
            if not path.is_file() or path.suffix == ".png":
                continue
            files += 1
            for what in INCLUDE.findall(path.read_text()):
                name = re.match(r'<([^>]+)>', what)
                if not name or not any(re.fullmatch(pattern, name.group(1)) for pattern in patterns):
                    found.append(f"{path.relative_to(root)}: '#include {what.strip()}' is not for {directory}")
    for path in sorted((root / "kernels").glob("*/*.hpp")):
        own = path.parent.name
        for directory in re.findall(r"<vsb/kernels/(\w+)/", path.read_text()):
            if directory not in KERNELS.get(own, ()):
                found.append(f"{path.relative_to(root)}: kernels/{own} includes nothing of kernels/{directory}")
    for path in sorted(path for own in APPS for path in (root / "apps" / own).glob("*.[hc]pp*")):
        own = path.parent.name
        for directory in re.findall(r'#include "(\w+)/', path.read_text()):
            if directory not in APPS[:APPS.index(own) + 1]:
                found.append(f"{path.relative_to(root)}: apps/{own} includes nothing of apps/{directory}")
    if files < 20:
        found.append(f"only {files} headers under {root}: is that the top of the tree?")
    return found


def without_kokkos(root):
    """Headers that use Kokkos and reach none of its headers: the precompiled one would hide that."""
    includes, known = {}, {}
    for path in (path for directory in ALLOWED for path in (root / directory).rglob("*.hpp")):
        includes[f"vsb/{path.relative_to(root)}"] = set(re.findall(r"#include <([^>]+)>", path.read_text()))

    def uses_kokkos(name):
        if name not in known:
            known[name] = name.startswith("Kokkos_")
            known[name] = known[name] or any([uses_kokkos(other) for other in includes.get(name, ())])
        return known[name]

    return [f"{name[4:]}: uses Kokkos and includes none of it" for name in sorted(includes)
            if re.search(r"\bKokkos::|\bKOKKOS_", (root / name[4:]).read_text()) and not uses_kokkos(name)]


def package_hosts():
    """Hosts that this machine is told to fetch packages from (apt, and the environment's registries)."""
    sources = pathlib.Path("/etc/apt")
    texts = [path.read_text(errors="replace") for path in sources.rglob("*")
             if path.suffix in (".list", ".sources") and os.access(path, os.R_OK)]
    texts += [value for name, value in os.environ.items() if re.search(r"INDEX_URL|REGISTRY|PROXY$", name.upper())]
    hosts = {host for text in texts for host in re.findall(r"://(?:[^/@\s]*@)?([\w.-]+\.[a-zA-Z]\w+)", text)}
    return hosts


def unnamed_files(root):
    """Headers of the kernels and of physics that the map of their directory leaves out."""
    found = []
    for directory in ("kernels", "physics"):
        text = (root / directory / "README.md").read_text()
        found += [f"{path.relative_to(root)}: {directory}/README.md has no line for it"
                  for path in sorted((root / directory).rglob("*.hpp"))
                  if f"`{path.stem}`" not in text and f"`{path.name}`" not in text]
    return found


def host_violations(root):
    hosts = package_hosts()
    found = []
    for directory, folders, names in os.walk(root):
        folders[:] = [folder for folder in folders if folder not in SKIPPED]
        for path in (pathlib.Path(directory, name) for name in names):
            if path.suffix not in TEXT:
                continue
            text = path.read_text(errors="replace")
            found += [f"{path.relative_to(root)}: names the package host {host}" for host in hosts if host in text]
    return found


root = pathlib.Path(sys.argv[1])
violations = include_violations(root) + without_kokkos(root) + unnamed_files(root) + host_violations(root)
for violation in violations:
    print(violation)
print(f"layers: {len(violations)} violations")
sys.exit(1 if violations else 0)
