"""pvbatch writes a data set: two processes, and one that is killed ten times, leave the same files as one alone."""
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


def infos(folder):
    """Numbers of the images that are there."""
    return {path.stem for path in folder.glob("info/*.json")}


def as_they_are(_folder, _there):
    return True


def while_writing(folder, _there):
    return any(True for _ in folder.glob("*/*.part"))


def between_files(folder, there):
    return any(path.stem not in there for path in folder.glob("channels/*.exr"))


def is_reached(folder, wanted, moment):
    there = infos(folder)
    return len(there) >= wanted and (moment(folder, there) or len(there) >= wanted + 2)


class TestDataSet(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        declared = json.loads((ROOT / "Data" / "datasets" / "apical.json").read_text(encoding="utf-8"))
        declared["patients"][0].update(spacingMm=4, copies=3)
        declared["probe"].update(lineCount=24, depthMm=140)
        declared["tracing"]["pathsPerLine"] = 10
        declared.update(exams=10, imagesPerExam=4, pixelMm=1, channels=["label", "error", "beam"])
        self.file = self.folder / "small.json"
        self.file.write_text(json.dumps(declared), encoding="utf-8")

    def command(self, name, *before):
        return [*before, shutil.which("pvbatch"), SCRIPT, str(self.file), str(self.folder / name), "--every", "0"]

    def expect_same(self, folder, whole):
        there = content(folder)
        self.assertEqual(sorted(there), sorted(whole))
        self.assertEqual([name for name in whole if there[name] != whole[name]], [])

    def run_whole(self, name, *before):
        done = subprocess.run(self.command(name, *before), capture_output=True, text=True, timeout=600)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout

    def test_two_processes_and_kills_leave_the_same_files(self):
        said = self.run_whole("alone")
        self.assertRegex(said, r"(?m)^Data set: image 17 of 40, [0-9.]+ images/s$")
        self.assertRegex(said, r"Wrote 40 images to .* in this process, [0-9.]+ a second")
        alone = content(self.folder / "alone")
        self.assertEqual(len(alone), 5 * 40 + 3)
        said = self.run_whole("two", shutil.which("mpirun"), "--oversubscribe", "-np", "2")
        self.assertRegex(said, r"Wrote 20 images")  # of the first process, which speaks
        self.expect_same(self.folder / "two", alone)

        # Killed at the first image, or once some more are there: at once, while a file is written, or between an
        # image's files. The numbers are drawn; where a moment is too short to be met, two images later.
        chance = random.Random(7)
        killed = self.folder / "killed"
        for moment in chance.sample([as_they_are, while_writing, between_files] * 3 + [as_they_are], 10):
            wanted = len(infos(killed)) + chance.randint(0, 2)
            process = subprocess.Popen(self.command("killed"), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            while process.poll() is None and not is_reached(killed, wanted, moment):
                time.sleep(0.001)
            self.assertIsNone(process.poll(), "it ended before it was killed")
            process.kill()
            process.wait()
        self.assertLess(len(infos(killed)), 40)
        self.run_whole("killed")
        self.expect_same(killed, alone)

    def test_a_mistake_ends_the_script(self):
        self.file.write_text('{"seed": "one"}', encoding="utf-8")
        done = subprocess.run(self.command("wrong"), capture_output=True, text=True, timeout=120)
        self.assertIn("lacks 'name'", done.stdout + done.stderr)
        self.assertIn("was not written", done.stdout + done.stderr)
        self.assertFalse((self.folder / "wrong").exists())


if __name__ == "__main__":
    sys.exit(not unittest.main(argv=sys.argv[:1], exit=False).result.wasSuccessful())
