"""What is done for each picture while a probe moves, and what is not: the anatomy does not change with the pose. Needs Xvfb; run by
ctest -L gui."""
import json
import pathlib
import sys
import tempfile
import unittest

from guicase import PLAYBACKS, GuiCase


class TestGuiDrag(GuiCase):
    def test_the_anatomy_is_made_ready_once_and_again_when_it_is_another(self):
        with tempfile.TemporaryDirectory() as folder:
            errors = self.play("drag_ultrasound.xml", folder, f"--script={PLAYBACKS / 'drag_anatomy.py'}")
            drawn = [json.loads(line) for line in pathlib.Path(folder, "drawn.jsonl").read_text().splitlines()]
        self.assertEqual(errors, [])
        before, moving, rested, changed = (
            [line for line in drawn if line["phase"] == phase] for phase in ("before", "moving", "rested", "changed"))
        first, last = before[-1], moving[-1]
        self.assertGreater(len({tuple(line["place"]) for line in moving}), 2)

        # Of the anatomy nothing runs, on the way and at rest.
        for line in moving + rested:
            self.assertEqual((line["anatomy ran"], line["made"]), (first["anatomy ran"], first["made"]), line)
        self.assertEqual(len({line["light made"] for line in moving}), 1)
        # The image runs for each picture, and its proxy learns of it at rest.
        self.assertGreaterEqual(last["image ran"], first["image ran"] + len({tuple(line["place"]) for line in moving}) - 1)
        for name in ("image was told", "anatomy was told"):
            self.assertEqual(last[name], first[name], name)
        self.assertGreater(rested[-1]["image was told"], last["image was told"])
        # What is another anatomy is drawn.
        self.assertGreater(changed[-1]["anatomy ran"], rested[-1]["anatomy ran"])
        self.assertGreater(changed[-1]["made"], rested[-1]["made"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
