"""ParaView with the plugin on a display of its own, for tests that play what a person does. Needs Xvfb."""
import os
import pathlib
import struct
import subprocess
import tempfile
import unittest

PLAYBACKS = pathlib.Path(__file__).resolve().parent / "gui"
PLUGIN = pathlib.Path(os.environ["SONOVDB_PLUGIN"])
VIEW = "720x520+300+205"  # the inside of the 3-D view on the screen


def read_screen(xwd):
    """The frame buffer, which Xvfb keeps as an X window dump: width, height and three bytes a pixel."""
    dump = pathlib.Path(xwd).read_bytes()
    header = struct.unpack(">25I", dump[:100])
    width, height, bytes_per_line, colours = header[4], header[5], header[12], header[19]
    start = header[0] + 12 * colours
    pixels = bytearray(3 * width * height)
    for row in range(height):
        line = dump[start + row * bytes_per_line:start + row * bytes_per_line + 4 * width]  # blue, green, red, nothing
        for channel in range(3):
            pixels[3 * width * row + channel:3 * width * (row + 1):3] = line[2 - channel::4]
    return width, height, pixels


def save_screen(path, xwd, cut=VIEW, size="50%"):
    """The 3-D view at half the size, or what else is asked for."""
    width, height, pixels = read_screen(xwd)
    with tempfile.NamedTemporaryFile(suffix=".ppm") as whole:
        whole.write(b"P6 %d %d 255\n" % (width, height) + pixels)
        whole.flush()
        subprocess.run(["oiiotool", "--nosoftwareattrib", whole.name, "--cut", cut, "--resize", size, "-o", path],
                       check=True)


def bytes_of(picture, count):
    """The last so many of a picture's bytes, three a pixel: all of its pixels, where that is how many there are."""
    raw = picture.with_suffix(".ppm")
    subprocess.run(["oiiotool", str(picture), "--ch", "R,G,B", "-o", str(raw)], check=True)
    return raw.read_bytes()[-count:]


def write_label_maps(folder):
    """Small ones, and damaged ones."""
    folder.mkdir()
    size = 24

    def label(x, y, z):
        r = sum(((each - size / 2) / (size / 2)) ** 2 for each in (x, y, z))
        return 0 if r > 0.95 else 3 if r > 0.8 else 2 if r < 0.15 else 1

    voxels = bytes(label(x, y, z) for z in range(size) for y in range(size) for x in range(size))
    header = (f"NRRD0004\ntype: uint8\ndimension: 3\nspace: left-posterior-superior\nsizes: {size} {size} {size}\n"
              "space directions: (5,0,0) (0,5,0) (0,0,5)\nspace origin: (-60,-60,-60)\nencoding: raw\n"
              "Segment0_ID:=a\nSegment0_LabelValue:=1\nSegment0_Name:=liver\nSegment1_ID:=b\nSegment1_LabelValue:=2\n"
              "Segment1_Name:=heart\nSegment2_ID:=c\nSegment2_LabelValue:=3\nSegment2_Name:=skin\n\n").encode()
    nifti = struct.pack("<i36x8h12x4h8f3f", 348, 3, size, size, size, 1, 1, 1, 1, 0, 2, 8, 0, 1, 5, 5, 5, 0, 0, 0, 0, 352, 1, 0)
    nifti = nifti.ljust(252, b"\0") + struct.pack("<2h6f12f", 0, 1, 0, 0, 0, 0, 0, 0, 5, 0, 0, -60, 0, 5, 0, -60, 0, 0, 5, -60)
    nifti = nifti.ljust(344, b"\0") + b"n+1\0" + bytes(4)
    whole = {"map.seg.nrrd": header + voxels, "map.nii": nifti + voxels}
    for name, content in whole.items():
        (folder / name).write_bytes(content)
        (folder / ("cut_" + name)).write_bytes(content[:len(content) // 2])
        bent = bytearray(content)
        for i in range(0, 200, 13):
            bent[i] ^= 0x55
        (folder / ("bent_" + name)).write_bytes(bent)
    (folder / "huge.seg.nrrd").write_bytes(header.replace(f"sizes: {size} {size}".encode(), b"sizes: 900000 900000") + voxels)
    (folder / "empty.nii").write_bytes(b"")


class GuiCase(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        reading, writing = os.pipe()
        cls.screen = tempfile.TemporaryDirectory()
        # It stays as it is when its last client leaves: it would start anew, and drop who comes meanwhile.
        cls.server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(writing), "-noreset", "-screen", "0", "1400x900x24", "-fbdir", cls.screen.name,
             "+extension", "GLX"],
            pass_fds=[writing], stderr=subprocess.DEVNULL)
        os.close(writing)
        with os.fdopen(reading) as number:
            cls.display = ":" + number.readline().strip()

    @classmethod
    def tearDownClass(cls):
        cls.server.terminate()
        cls.server.wait()
        cls.screen.cleanup()

    @property
    def frame_buffer(self):
        return pathlib.Path(self.screen.name, "Xvfb_screen0")

    def run_script(self, text, folder, *arguments):
        """Runs Python with ParaView on the display."""
        script = pathlib.Path(folder, "script.py")
        script.write_text("from paraview.simple import *\nimport os, sys\n"
                          "LoadPlugin(os.environ['SONOVDB_PLUGIN'], remote=False, ns=globals())\n" + text)
        subprocess.run(["pvpython", str(script), *map(str, arguments)], check=True, timeout=200,
                       env=dict(os.environ, DISPLAY=self.display))

    def label_map(self, folder):
        """A thorax that is quick to show, as a file that ParaView opens itself."""
        path = str(pathlib.Path(folder, "thorax.vti"))
        self.run_script("SaveData(sys.argv[1], proxy=ThoraxPhantom(Spacingmm=4))", folder, path)
        return path

    def play(self, name, folder, *arguments):
        """Plays one script; the lines that ParaView calls errors."""
        done = self.paraview(folder, f"--test-script={PLAYBACKS / name}", *arguments, "--exit")
        self.assertEqual(done.returncode, 0, done.stdout)
        return [line for line in done.stdout.splitlines() if "ERR|" in line]

    def paraview(self, folder, *arguments):
        """Runs ParaView with the plugin in a folder, which its dialogs begin with, until it ends by itself."""
        scripts = os.pathsep.join(filter(None, (str(PLAYBACKS), os.environ.get("PYTHONPATH"))))
        environment = dict(os.environ, DISPLAY=self.display, HOME=folder, XDG_RUNTIME_DIR=folder, PYTHONPATH=scripts)
        return subprocess.run(
            ["paraview", "--dr", f"--plugin-search-paths={PLUGIN.parent}", "--plugins=SonoVDB",
             f"--test-directory={folder}", *arguments],
            env=environment, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=400)
