"""Arrays are the run's own memory or values of the program, to the last bit."""
import csv
import gc
import unittest

import numpy
import osculate
from support import COARSE, HALF_TUBE, PRESS, InFolder, frame


class Views(unittest.TestCase):
    def test_displacements_are_one_memory_that_follows_the_run(self):
        run = osculate.Run(PRESS)
        first = run.displacement("cap")
        self.assertEqual(first.shape, run.nodes("cap").shape)
        self.assertFalse(first.any(), "nothing has moved before the first step")
        at = first.ctypes.data
        tops = []
        for _ in run:
            now = run.displacement("cap")
            self.assertEqual(now.ctypes.data, at)
            self.assertTrue(numpy.shares_memory(now, first))
            tops.append(first.min())
        self.assertEqual(len(set(tops)), len(tops), "every step moves it on")
        force = run.pair("joint").contact_force
        self.assertTrue(numpy.shares_memory(force, run.pair("joint").contact_force))

    def test_nobody_writes_to_them(self):
        run = osculate.Run(PRESS)
        next(run)
        pair = run.pair("joint")
        for array in (run.displacement("cap"), run.nodes("cap"), run.cells("cap")[0][1], run.stress("cap"), pair.gap,
                      pair.area, pair.contact_force, pair.force):
            with self.assertRaises(ValueError):
                array[0] = 1

    def test_they_keep_the_run_they_look_at(self):
        run = osculate.Run(PRESS)
        next(run)
        moved, force = run.displacement("cap"), run.pair("joint").contact_force
        self.assertIs(moved.base, run)
        self.assertIs(force.base, run)
        before = moved.copy()
        del run
        gc.collect()
        numpy.testing.assert_array_equal(moved, before)

    def test_meshes_are_as_the_scene_says(self):
        run = osculate.Run(PRESS)
        (kind, cells), = run.cells("cap")
        self.assertEqual((kind, cells.shape), ("hexahedron", (3 * 3 * 2, 8)))
        nodes = run.nodes("cap")
        numpy.testing.assert_allclose(nodes.min(axis=0), [0.3, 0.45, 1])
        numpy.testing.assert_allclose(nodes.max(axis=0), [1.3, 1.45, 1.5])
        body, top = run.set("top")
        self.assertEqual(body, "cap")
        self.assertTrue((nodes[top, 2] == 1.5).all())
        body, slaves = run.pair("joint").nodes
        self.assertEqual((body, len(slaves)), ("cap", 16))
        self.assertTrue((nodes[slaves, 2] == 1).all())

    def test_motion_is_there_in_dynamics_only(self):
        run = osculate.Run(PRESS)
        next(run)
        with self.assertRaisesRegex(RuntimeError, "dynamics"):
            run.velocity("cap")

    def test_unknown_names_are_answered_with_those_there_are(self):
        run = osculate.Run(PRESS)
        with self.assertRaisesRegex(KeyError, "no body is called 'cup', perhaps 'cap'; there are base, cap"):
            run.displacement("cup")
        with self.assertRaisesRegex(KeyError, "no pair is called 'bond'; there are joint"):
            run.pair("bond")
        next(run)
        with self.assertRaisesRegex(KeyError, "no field is called 'gup', perhaps 'gap'"):
            run.pair("joint").field("gup")


class Values(InFolder):
    fields = {"output.body_fields": ["displacement", "stress", "von_mises", "reaction"],
              "output.slave_fields": ["gap", "contact_force", "normal_stress", "slip", "status", "normal", "area"],
              "output.frame_every": 1}

    def settings(self):
        words = []
        for key, value in {**COARSE, "stages.slide.steps": 3, **self.fields}.items():
            words += ["--set", f"{key}={value}".replace("'", "")]
        return words

    def test_fields_and_history_have_the_bits_of_the_programs_files(self):
        self.program("run", HALF_TUBE, "-o", "run", "--quiet", *self.settings())
        run = osculate.Run(HALF_TUBE, {**COARSE, "stages.slide.steps": 3, **self.fields})
        run.write(self.folder / "written")
        for step in run:
            pair = run.pair("sliding")
            written = frame(self.folder / f"run/frames/contactor_{step.number:05}.vtu")
            ours = {"displacement": run.displacement("contactor"), "stress": run.stress("contactor"),
                    "von_mises": run.von_mises("contactor"), "reaction": run.reaction("contactor")}
            written.update(frame(self.folder / f"run/frames/sliding.slave_{step.number:05}.vtp"))
            del ours["displacement"], written["displacement"]  # of the slave surface by now
            numpy.testing.assert_array_equal(
                run.displacement("tube"), frame(self.folder / f"run/frames/tube_{step.number:05}.vtu")["displacement"])
            for name in ("gap", "contact_force", "normal_stress", "slip", "status", "normal", "area"):
                ours[name] = getattr(pair, name)
            for name, values in ours.items():
                numpy.testing.assert_array_equal(values, written[name], name)
            numpy.testing.assert_array_equal(pair.field("gap"), pair.gap)
        with open(self.folder / "run/history.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(list(run.history), list(rows[0]))
        for name, values in run.history.items():
            self.assertEqual(values.tolist(), [float(row[name]) for row in rows], name)
        self.assertTrue(run.completed)
        numpy.testing.assert_array_equal(run.pair("sliding").force,
                                         [float(rows[-1][f"pair.sliding.force_{axis}"]) for axis in "xyz"])
        # what it writes is what the program writes
        files = sorted(p.relative_to(self.folder / "run") for p in (self.folder / "run").rglob("*.*"))
        self.assertEqual(files, sorted(p.relative_to(self.folder / "written")
                                       for p in (self.folder / "written").rglob("*.*")))
        for file in files:
            if file.name not in ("summary.json", "osculate_manifest.txt"):  # which have times and processes
                self.assertEqual((self.folder / "run" / file).read_bytes(),
                                 (self.folder / "written" / file).read_bytes(), file)


if __name__ == "__main__":
    unittest.main()
