"""The lines that docs/python.md begins with do what they say."""
import contextlib
import importlib.util
import io
import os
import re
import sys
import types
import unittest

from support import SOURCE, InFolder


class Example(InFolder):
    def test_runs_line_by_line_as_printed(self):
        os.environ["MPLBACKEND"] = "Agg"
        plots = importlib.util.find_spec("matplotlib") is not None
        if not plots:  # what is plotted is called all the same
            pyplot = types.ModuleType("matplotlib.pyplot")
            pyplot.__getattr__ = lambda name: lambda *_: None
            matplotlib = types.ModuleType("matplotlib")
            matplotlib.pyplot = pyplot
            sys.modules.update({"matplotlib": matplotlib, "matplotlib.pyplot": pyplot})
        lines = re.search(r"```python\n(.*?)```", (SOURCE / "docs/python.md").read_text(), re.S)[1]
        self.assertLessEqual(len([line for line in lines.splitlines() if line]), 10)
        here = os.getcwd()
        self.addCleanup(os.chdir, here)
        os.symlink(SOURCE / "configs", self.folder / "configs")
        os.chdir(self.folder)
        names = {}
        with contextlib.redirect_stdout(io.StringIO()) as said:
            exec(lines, names)
        self.assertIn("stage 'slide'", said.getvalue())
        self.assertTrue(names["run"].completed)
        self.assertGreater(names["drag"][-1], 0)
        if plots:
            self.assertGreater((self.folder / "drag.png").stat().st_size, 1000)


if __name__ == "__main__":
    unittest.main()
