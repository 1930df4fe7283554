# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of studies share: running one, and reading its table."""
import csv

from vsb_program import SCENES, ProgramTest, vsb

COLUMNS = ["study", "series", "case", "figure", "value", "rate", "difference", "extrapolated", "expected", "lowest", "highest", "deviation", "source",
           "published", "verdict", "particles", "steps", "seconds", "particle_steps", "ns_per_particle_step", "directory",
           "state_hash", "note"]


class StudyTest(ProgramTest):
    def file(self, text, name="mine.toml"):
        return self.write(text.replace("SCENES", str(SCENES)), name)

    def study(self, text, *arguments, code=0, out="out"):
        """Runs a study; returns the process and its table, with the columns checked."""
        done = vsb("study", self.file(text), "--out", self.folder / out, *arguments)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done, self.table(out)

    def table(self, out="out", name="mine"):
        with (self.folder / out / f"{name}.csv").open(newline="") as file:
            rows = list(csv.reader(file))
        self.assertEqual(rows[0], COLUMNS)
        self.assertEqual({len(row) for row in rows}, {len(COLUMNS)})
        return [dict(zip(COLUMNS, row)) for row in rows[1:]]

    def line(self, table, case, figure):
        found = [row for row in table if row["case"] == case and row["figure"] == figure]
        self.assertEqual(len(found), 1, (case, figure, table))
        return found[0]

    def refuse(self, text, *words, line=None):
        done = vsb("study", self.file(text), "--out", self.folder / "out")
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        for word in words:
            self.assertIn(word, done.stderr)
        if line is not None:
            self.assertRegex(done.stderr, rf"mine\.toml:{line}:\d+: ")
        self.assertFalse((self.folder / "out").exists())
