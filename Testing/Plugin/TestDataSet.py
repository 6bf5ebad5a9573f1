"""pvbatch writes a data set: two processes, and one that is killed again and again, leave the same files as one alone."""
import json
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCRIPT = str(ROOT / "Plugin" / "examples" / "dataset.py")


def content(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in pathlib.Path(folder).rglob("*")
            if path.is_file()}


class TestDataSet(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        declared = json.loads((ROOT / "Data" / "datasets" / "apical.json").read_text(encoding="utf-8"))
        declared["patients"][0].update(spacingMm=4, copies=3)
        declared["probe"].update(lineCount=24, depthMm=140)
        declared["tracing"]["pathsPerLine"] = 10
        declared.update(exams=5, imagesPerExam=4, pixelMm=1)
        self.file = self.folder / "small.json"
        self.file.write_text(json.dumps(declared), encoding="utf-8")

    def command(self, name, *before):
        return [*before, shutil.which("pvbatch"), SCRIPT, str(self.file), str(self.folder / name)]

    def run_whole(self, name, *before):
        done = subprocess.run(self.command(name, *before), capture_output=True, text=True, timeout=600)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout

    def test_two_processes_and_kills_leave_the_same_files(self):
        self.assertRegex(self.run_whole("alone"), r"Wrote 20 images to .* in this process, [0-9.]+ a second")
        alone = content(self.folder / "alone")
        self.assertEqual(len(alone), 63)
        said = self.run_whole("two", shutil.which("mpirun"), "--oversubscribe", "-np", "2")
        self.assertRegex(said, r"Wrote 8 images")  # of the first process, which speaks
        self.assertEqual(content(self.folder / "two"), alone)

        chance = random.Random(7)
        for _ in range(3):
            there = len(list(self.folder.glob("killed/info/*.json")))
            process = subprocess.Popen(self.command("killed"), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            until = time.monotonic() + 120  # at least one image more, or nothing is tested
            while len(list(self.folder.glob("killed/info/*.json"))) <= there and time.monotonic() < until:
                time.sleep(0.005)
            time.sleep(chance.uniform(0.0, 0.3))
            process.kill()
            process.wait()
        self.assertLess(len(content(self.folder / "killed")), 63)
        self.run_whole("killed")
        self.assertEqual(content(self.folder / "killed"), alone)

    def test_a_mistake_ends_the_script(self):
        self.file.write_text('{"seed": "one"}', encoding="utf-8")
        done = subprocess.run(self.command("wrong"), capture_output=True, text=True, timeout=120)
        self.assertIn("lacks 'name'", done.stdout + done.stderr)
        self.assertIn("was not written", done.stdout + done.stderr)
        self.assertFalse((self.folder / "wrong").exists())


if __name__ == "__main__":
    sys.exit(not unittest.main(argv=sys.argv[:1], exit=False).result.wasSuccessful())
