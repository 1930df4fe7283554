# SPDX-License-Identifier: BSD-3-Clause
"""README and guides are true: commands run, the scene is a scene, the C++ is that of programs that are built and run."""
import json
import re
import subprocess
import unittest

from vsb_program import PROGRAM, ROOT, ProgramTest

README = (ROOT / "README.md").read_text()
SCENES_GUIDE = (ROOT / "apps" / "scenes" / "README.md").read_text()
EXAMPLES = ROOT / "apps" / "examples"
DOCUMENTS = [path for path in sorted(ROOT.glob("*.md")) + sorted(ROOT.glob("apps/*/*.md")) + sorted(ROOT.glob("*/*.md"))
             if path.parent.name not in ("build", "results") and path.name != "CHANGELOG.md"]
# What this test runs inside of, and what configures the build that it is a part of.
RUN_ELSEWHERE = ("./demo", "./check", "cmake --preset", "cmake --build", "cmake --install", "cmake -B")


def blocks(language, text=README):
    return re.findall(rf"^ *```{language}\n(.*?)^ *```", text, re.MULTILINE | re.DOTALL)


class Readme(ProgramTest):
    def test_commands_run_in_order(self):
        (self.folder / "apps").symlink_to(ROOT / "apps")
        (self.folder / "build" / "openmp" / "apps").mkdir(parents=True)
        (self.folder / "build" / "openmp" / "apps" / "vsb").symlink_to(PROGRAM)
        scene = blocks("toml")
        self.assertEqual(len(scene), 1)
        (self.folder / "tunnel.toml").write_text(scene[0])
        ran = 0
        for block in blocks("sh") + blocks("sh", SCENES_GUIDE):
            for line in block.splitlines():
                command = line.split("#")[0].strip()
                if not command or command.startswith(RUN_ELSEWHERE):
                    continue
                done = subprocess.run(command, shell=True, cwd=self.folder, capture_output=True, text=True, timeout=600)
                self.assertEqual(done.returncode, 0, f"{command}\n{done.stdout}{done.stderr}")
                ran += 1
        self.assertGreaterEqual(ran, 9)
        results = self.folder / "results" / "tunnel"
        self.assertTrue((results / "tunnel_fields.png").stat().st_size > 10_000)
        # Only the tunnel is loaded: 20 kPa on a quarter of a circle of 1.5 m, pressure times radius in x and in y.
        summary = json.loads((results / "summary.json").read_text())
        told = [1e3 * float(kilo) for kilo in re.search(r"here \(([\d.]+), ([\d.]+)\) kN", README).groups()]
        for component in (0, 1):
            self.assertAlmostEqual(summary["exact_force"][component], 30e3, delta=1)
            self.assertAlmostEqual(summary["net_force"][component], told[component], delta=50)

    def test_examples_of_the_help_run_as_printed(self):
        (self.folder / "apps").symlink_to(ROOT / "apps")
        (self.folder / "vsb").symlink_to(PROGRAM)
        text = subprocess.run([PROGRAM, "--help"], capture_output=True, text=True).stdout
        commands = re.findall(r"^  ((?:vsb|/usr/bin/python3) .*?)   ", text, re.MULTILINE)
        self.assertEqual(len(commands), 4)
        for command in commands:
            done = subprocess.run(f"PATH=.:$PATH {command}", shell=True, cwd=self.folder, capture_output=True, text=True, timeout=600)
            self.assertEqual(done.returncode, 0, f"{command}\n{done.stdout}{done.stderr}")

    def test_demo_and_check_are_what_runs_elsewhere(self):
        for script in ("demo", "check", ".ci/run", "third_party/setup"):
            self.assertTrue((ROOT / script).stat().st_mode & 0o100, script)
        for script in ("./demo", "./check"):
            self.assertIn(script, (ROOT / ".ci" / "run").read_text())
        self.assertIn("build_preset openmp", (ROOT / "demo").read_text())

    def test_cpp_is_that_of_the_examples(self):
        sources = list(EXAMPLES.glob("*.cpp")) + list(EXAMPLES.glob("*.hpp"))
        compiled = {line.strip() for path in sources for line in path.read_text().splitlines()}
        guide = (EXAMPLES / "README.md").read_text()
        code = [line.strip() for block in blocks("cpp", guide) for line in block.splitlines() if line.strip()]
        self.assertGreaterEqual(len(code), 30)
        for line in code:
            self.assertIn(line, compiled)
        for path in sources:
            if not path.stem.endswith("_main"):
                self.assertIn(f"`{path.name}`", guide)
        self.assertTrue(any("vsb::step(Exec(), state, rock, basis, load, options)" in line for line in compiled))

    def test_links_lead_somewhere(self):
        self.assertGreaterEqual(len(DOCUMENTS), 7)
        for document in DOCUMENTS:
            text = document.read_text()
            for target in re.findall(r"\]\(([^)#]+)\)", text):
                if "://" not in target:
                    self.assertTrue((document.parent / target).exists(), f"{document}: {target}")
            for path in re.findall(r"`((?:apps|tests|kernels|physics|views|bench|third_party)/[\w./-]+)`", text):
                self.assertTrue((ROOT / path).exists(), f"{document}: {path}")


if __name__ == "__main__":
    unittest.main()
