# SPDX-License-Identifier: BSD-3-Clause
"""The reference of the keys: what `vsb keys` prints is what lies beside the scenes and the studies, and it has every key that
they use and that the readers take."""
import re
import tomllib
import unittest

from vsb_program import ROOT, SCENES, ProgramTest, vsb

STUDIES = ROOT / "apps" / "studies"
SHAPES = ("shape", "surface", "layer")


def tables_of(page):
    """{"body.material": {"friction_angle": [cells of its line], ...}, ...}; the document itself is ""."""
    tables = {}
    for section in re.split(r"^## ", page, flags=re.MULTILINE)[1:]:
        title, rest = section.split("\n", 1)
        table = tables.setdefault("" if title == "Top of the file" else title, {})
        for line in rest.splitlines():
            if line.startswith("| `"):
                names, *cells = [cell.strip() for cell in line.strip("|").split(" | ")]
                for name in re.findall(r"`(\w+)`", names):
                    table[name] = cells
    return tables


def used_keys(value, table, tables):
    """(table, key) of everything that is written in a document; a shape, wherever it stands, is a table of that name."""
    for key, inner in value.items():
        yield table, key if "FIGURE" not in tables.get(table, ()) else "FIGURE"
        link = re.search(r"\(\[([\w.]+)\]", tables.get(table, {}).get(key, [""])[0])
        if "FIGURE" in tables.get(table, ()):
            link = re.search(r"\(\[([\w.]+)\]", tables[table]["FIGURE"][0])
        for item in inner if isinstance(inner, list) else [inner]:
            if isinstance(item, dict):
                yield from used_keys(item, link[1] if link else table, tables)


class Keys(ProgramTest):
    def page(self, *arguments):
        done = vsb("keys", *arguments)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return done.stdout

    def test_the_pages_are_what_is_printed(self):
        for arguments, path in (((), SCENES / "keys.md"), (("--study",), STUDIES / "keys.md")):
            printed = self.page(*arguments)
            self.assertEqual(printed, path.read_text(), f"write it anew: vsb keys {' '.join(arguments)} > {path.relative_to(ROOT)}")
            for table, keys in tables_of(printed).items():
                self.assertTrue(keys, table)
                for name, cells in keys.items():
                    self.assertEqual(len(cells), 4, f"{table}: {name}: {cells}")
                    self.assertTrue(cells[0] and cells[3].strip("| "), f"{table}: {name}: {cells}")

    def test_every_key_in_use_is_in_it(self):
        for arguments, folder in (((), SCENES), (("--study",), STUDIES)):
            tables = tables_of(self.page(*arguments))
            seen = set()
            for path in sorted(folder.glob("*.toml")):
                for table, key in used_keys(tomllib.loads(path.read_text()), "", tables):
                    self.assertIn(key, tables[table], f"{path.name}: {table}")
                    seen.add((table, key))
            self.assertGreater(len(seen), 40)
        self.assertIn(("shape.disc", "radius"), set(used_keys({"body": [{"shape": {"union": [{"disc": {"radius": 1.0}}]}}]}, "",
                                                              tables_of(self.page()))))

    def test_every_key_that_readers_take_is_in_it(self):
        tables = tables_of(self.page())
        tried = set()

        def allowed(scene, path, table):
            """The keys that the answer to an unknown one lists."""
            where = f"{path}.nonsense=1" if path else "nonsense=1"
            done = vsb("check", scene, "--set", where)
            self.assertEqual(done.returncode, 2, done.stdout)
            listed = re.search(r"\(allowed here: (.*)\)", done.stderr)[1].split(", ")
            self.assertLessEqual(set(listed), set(tables[table]), path)
            tried.add(table)

        def walk(scene, value, path):
            table = re.sub(r"\[\d+\]", "", path)
            if table in tables:
                allowed(scene, path, table)
            for key, inner in value.items():
                if isinstance(inner, dict) and key not in SHAPES:
                    walk(scene, inner, f"{path}.{key}" if path else key)
                elif isinstance(inner, list) and inner and isinstance(inner[0], dict):
                    walk(scene, inner[0], f"{path}.{key}[0]" if path else f"{key}[0]")

        for name in ("column", "cylinder-polar", "ellipse-exact", "wellbore-slice", "ring", "cylinder-concentric"):
            resolved = vsb("check", SCENES / f"{name}.toml")
            scene = self.write(resolved.stdout, f"{name}.toml")
            walk(scene, tomllib.loads(resolved.stdout), "")
        self.assertGreaterEqual(len(tried), 18, tried)

    def test_a_part_of_it(self):
        whole = self.page()
        material = self.page("body.material")
        self.assertEqual(material, self.page("material"))
        self.assertTrue(material.startswith("## body.material\n"))
        self.assertIn(material, whole)
        line = next(line for line in whole.splitlines() if line.startswith("| `friction_angle`"))
        self.assertIn("| degrees |", line)
        for name in ("friction_angle", "material.friction_angle", "body.material.friction_angle"):
            self.assertEqual([text for text in self.page(name).splitlines() if text.startswith("| `")], [line])
        tables = tables_of(self.page("pressure"))
        self.assertGreaterEqual(set(tables), {"traction", "compare", "traction.exact_ellipse"})
        self.assertTrue(all(set(keys) == {"pressure"} for keys in tables.values()))

    def test_a_name_that_is_not_there(self):
        for name, words in (("frction_angle", "friction_angle"), ("friction", "friction_angle"), ("radiuss", "radius"),
                            ("material.presure", "pressure"), ("qqqqqqqqq", "'vsb keys' prints them all")):
            done = vsb("keys", name)
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            self.assertIn(f"there is no key or table '{name}'", done.stderr)
            self.assertIn(words, done.stderr)


if __name__ == "__main__":
    unittest.main()
