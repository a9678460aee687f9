"""How runs go, stop and fail."""
import gc
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
import unittest

import osculate
from support import COARSE, HALF_TUBE, PRESS, SOURCE, InFolder


class Steps(unittest.TestCase):
    def test_come_one_after_another_with_either_way_to_ask(self):
        run = osculate.Run(PRESS)
        steps = [(s.number, s.time, s.dt, s.iterations, s.stage) for s in run]
        self.assertEqual([s[0] for s in steps], [1, 2, 3, 4])
        self.assertEqual([s[1] for s in steps], [1, 2, 3, 4])
        self.assertEqual([s[4] for s in steps], ["press"] + 3 * ["pull"])
        self.assertTrue(all(s[3] > 0 for s in steps))
        called = []
        again = osculate.Run(osculate.Scene(PRESS), threads=2)
        again.run(lambda s: called.append((s.number, s.time, s.dt, s.iterations, s.stage)))
        self.assertEqual(called, steps)
        self.assertEqual(list(again), [], "there are no more")

    def test_wait_while_they_are_looked_at(self):
        run = osculate.Run(PRESS)

        def look(step):
            self.assertEqual(run.time, step.time)
            self.assertEqual(len(run.history["time"]), step.number)
            time.sleep(0.02)
            self.assertEqual(run.history["time"][-1], step.time)

        run.run(look)
        self.assertTrue(run.completed)

    def test_go_on_after_a_loop_that_was_left(self):
        run = osculate.Run(PRESS)
        for step in run:
            break
        self.assertEqual([s.number for s in run], [2, 3, 4])

    def test_have_fields_when_taken_only(self):
        run = osculate.Run(PRESS)
        with self.assertRaisesRegex(RuntimeError, "no step has been taken yet"):
            run.stress("cap")
        run.run()
        self.assertEqual(run.stress("cap").shape[1], 6)
        self.assertTrue(run.reaction("cap").any())

    def test_let_other_threads_of_python_go_on(self):
        run, counted = osculate.Run(HALF_TUBE, {**COARSE, "stages.slide.steps": 2}), []
        ended = threading.Event()

        def count():
            while not ended.is_set():
                counted.append(0)
                time.sleep(0.001)

        other = threading.Thread(target=count)
        other.start()
        next(run)
        ended.set()
        other.join()
        self.assertGreater(len(counted), 3)


class Ends(InFolder):
    def test_an_exception_of_a_callback_ends_the_run_and_comes_out(self):
        run = osculate.Run(PRESS)
        run.write(self.folder / "run")

        def stop(step):
            if step.number == 2:
                raise LookupError("seen enough")

        with self.assertRaisesRegex(LookupError, "seen enough"):
            run.run(stop)
        self.assertEqual(list(run), [])
        self.assertFalse(run.completed)
        self.assertEqual(len(run.history["time"]), 2)
        self.assertIn('"interrupted"', (self.folder / "run/summary.json").read_text())

    def test_a_run_nobody_wants_any_more_goes(self):
        run = osculate.Run(PRESS)
        next(run)
        del run
        gc.collect()
        with osculate.Run(PRESS) as run:
            next(run)
        self.assertEqual(list(run), [])

    def test_ctrl_c_ends_a_run(self):
        run = osculate.Run(HALF_TUBE, {**COARSE, "stages.slide.steps": 20000})
        threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
        with self.assertRaises(KeyboardInterrupt):
            run.run()
        self.assertEqual(list(run), [])

    def test_ctrl_c_leaves_a_loop_where_it_can_go_on(self):
        run = osculate.Run(HALF_TUBE, {**COARSE, "stages.slide.steps": 20000})
        threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
        seen = []
        with self.assertRaises(KeyboardInterrupt):
            for step in run:
                seen.append(step.number)
        seen += [next(run).number, next(run).number]
        self.assertEqual(seen, list(range(1, len(seen) + 1)), "no step is missing")

    def test_files_are_written_from_the_start_or_not_at_all(self):
        run = osculate.Run(PRESS)
        next(run)
        with self.assertRaisesRegex(RuntimeError, "before the first step"):
            run.write(self.folder)


class Failures(InFolder):
    def test_a_run_that_gives_up_says_what_the_program_says(self):
        scene = SOURCE / "tests/scenes/failures/no_support.yaml"
        said = self.program("run", scene, "-o", "run", "--quiet", code=3).stderr
        for folder in (None, self.folder / "written"):
            run = osculate.Run(scene)
            if folder:
                run.write(folder)
            with self.assertRaises(osculate.RunFailure) as caught:
                run.run()
            self.assertIsInstance(caught.exception, RuntimeError)
            self.assertTrue(caught.exception.post_mortem)
            self.assertIn(f"the run gave up: {caught.exception}\n{caught.exception.post_mortem}", said)
            self.assertEqual(list(run), [])
            with self.assertRaises(RuntimeError):
                run.stress(run.bodies[0])

    def test_a_scene_is_refused_with_everything_that_is_wrong(self):
        text = PRESS.read_text().replace("friction: 0.3", "frction: 0.3").replace("nu: 0.2", "nu: 0.7")
        path = self.folder / "scene.yaml"
        path.write_text(text)
        with self.assertRaises(osculate.SceneError) as caught:
            osculate.Scene(path)
        self.assertIsInstance(caught.exception, ValueError)
        faults = {fault.key: fault for fault in caught.exception.faults}
        self.assertEqual(len(faults), 2, caught.exception)
        unknown = faults["contact.joint.frction"]
        line = next(i for i, row in enumerate(text.splitlines(), 1) if "frction" in row)
        self.assertEqual((unknown.file, unknown.line, unknown.nearest), (str(path), line, "friction"))
        ratio = faults["bodies.base.material.linear_elastic.nu"]
        self.assertIn("0.7", ratio.found)
        self.assertTrue(ratio.expected)
        self.assertIn(str(ratio), str(caught.exception))

    def test_faults_of_compiling_come_out_as_well(self):
        with self.assertRaises(osculate.SceneError) as caught:
            osculate.Run(PRESS, {"bodies.cap.mesh.block.origin": ["0.3 m", "0.45 m", "0.5 m"]})
        self.assertTrue(caught.exception.faults)


class Scenes(unittest.TestCase):
    def test_take_values_of_python(self):
        scene = osculate.Scene(PRESS, {"contact.joint.friction": 0.25, "contact.joint.surface": "rpim",
                                       "bodies.cap.mesh.block.divisions": (2, 2, 1), "output.iterations": True,
                                       "stages.press.pressure": {"top": "0.2 MPa"}})
        self.assertEqual((scene.name, scene.bodies, scene.pairs, scene.stages),
                         ("press", ["base", "cap"], ["joint"], ["press", "pull"]))
        for words in ("rpim", "friction: 0.25", "iterations: true", "top: 2.0e+05"):
            self.assertIn(words, scene.yaml)

    def test_may_be_texts(self):
        run = osculate.Run(osculate.Scene.parse(PRESS.read_text(), {"stages.pull.steps": 1}))
        self.assertEqual(len(list(run)), 2)
        with self.assertRaises(osculate.SceneError):
            osculate.Scene.parse("bodies: 3")

    def test_name_overrides_that_are_wrong(self):
        with self.assertRaisesRegex(TypeError, "such as 'solver.tolerance', found 5"):
            osculate.Scene(PRESS, {5: 1})
        with self.assertRaisesRegex(osculate.SceneError, "contact.joint.friction: expected a number >= 0, found a list of 2"):
            osculate.Scene(PRESS, {"contact.joint.friction": [1, 2]})

    def test_go_to_other_processes(self):
        settings = {"contact.joint.friction": 0.25}
        for scene in (osculate.Scene(PRESS, settings), osculate.Scene.parse(PRESS.read_text(), settings)):
            there = pickle.loads(pickle.dumps(scene))
            self.assertEqual((there.name, there.yaml), (scene.name, scene.yaml))
            self.assertEqual(len(list(osculate.Run(there))), 4)


class Module(unittest.TestCase):
    def test_needs_numpy_for_arrays_only(self):
        code = "import sys, osculate; osculate.keys('solver'); sys.exit('numpy' in sys.modules)"
        self.assertEqual(subprocess.run([sys.executable, "-c", code]).returncode, 0)

    def test_knows_the_keys_of_scenes(self):
        self.assertIn("solver.tolerance", osculate.keys("solver"))


if __name__ == "__main__":
    unittest.main()
