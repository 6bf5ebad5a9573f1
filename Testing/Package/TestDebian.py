"""Makes the Debian packages, installs them, uses them as a person would who has set nothing up, and removes them:

    TestDebian.py BUILD WORK VERSION

Needs root; exits with 77, which ctest takes as skipped, where it may not install or the packages are there already.
"""
import contextlib
import os
import pathlib
import shutil
import subprocess
import sys
import unittest

BUILD, WORK, VERSION = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3]
NAMES = ["sonovdb", "libsonovdb-dev"]
EXAMPLES = pathlib.Path("/usr/share/sonovdb/examples")
PLUGINS = """
import os.path
from paraview.modules.vtkRemotingCore import vtkPVPluginsInformation
plugins = vtkPVPluginsInformation()  # what Tools > Manage Plugins lists
plugins.CopyFromObject(None)
for i in range(plugins.GetNumberOfPlugins()):
    print(plugins.GetPluginName(i), plugins.GetPluginVersion(i), plugins.GetPluginLoaded(i),
          os.path.realpath(plugins.GetPluginFileName(i)), flush=True)
"""
# In the window, what is printed goes to its Python shell; whatever happens, it closes.
WINDOW = f"""
import os, sys
sys.stdout = open("window.txt", "w")
try:
    exec({PLUGINS!r})
finally:
    os._exit(0)
"""
CLIENT = """
import sys
from paraview.simple import *
Connect("127.0.0.1", int(sys.argv[1]))
image = SimulateUltrasound(Input=ThoraxPhantom(Spacingmm=4), LineCount=8, PathsPerLine=10)
image.UpdatePipeline()
print("points", image.GetDataInformation().GetNumberOfPoints())
"""


def output(*command, **more):
    return subprocess.run([str(word) for word in command], check=True, stdout=subprocess.PIPE, text=True, timeout=600,
                          **more).stdout


def plain(*command, **variables):
    """Runs a command with none of the test's variables, and with a home that nobody has used."""
    home = WORK / "home"
    home.mkdir(exist_ok=True)
    environment = {"PATH": "/usr/bin:/bin", "HOME": str(home), **variables}
    return output(*command, cwd=WORK, env=environment)


def script(name, text):
    path = WORK / name
    path.write_text(text)
    return path


def is_installed(name):
    state = subprocess.run(["dpkg-query", "--show", "--showformat=${db:Status-Status}", name], capture_output=True,
                           text=True, check=False)
    return state.stdout == "installed"


class Debian(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        output("cpack", "--config", BUILD / "CPackConfig.cmake", "-B", WORK / "packages")
        cls.architecture = output("dpkg", "--print-architecture").strip()
        cls.packages = {name: WORK / "packages" / f"{name}_{VERSION}_{cls.architecture}.deb" for name in NAMES}
        cls.addClassCleanup(output, "dpkg", "--purge", *reversed(NAMES))
        output("dpkg", "--install", *cls.packages.values())

    def fields(self, name):
        return dict(line.split(": ", 1) for line in output("dpkg-deb", "--field", self.packages[name]).splitlines()
                    if ": " in line and not line.startswith(" "))

    def assert_loaded(self, listing):
        file = f"/usr/lib/{os.uname().machine}-linux-gnu/paraview-5.11/plugins/SonoVDB/SonoVDB.so"
        self.assertIn(f"SonoVDB {VERSION} True {file}", listing.splitlines())

    def test_says_what_it_is_and_needs(self):
        fields = self.fields("sonovdb")
        self.assertEqual((fields["Version"], fields["Architecture"]), (VERSION, self.architecture))
        needed = {word.split()[0] for word in fields["Depends"].split(",")}
        self.assertLessEqual({"paraview", "python3-paraview", "python3", "libopenvdb10.0", "libembree3-3", "libtbb12",
                              "libqt5widgets5", "libc6"}, needed)
        self.assertNotIn("libsonovdb-dev", needed)
        self.assertIn(f"sonovdb (= {VERSION})", self.fields("libsonovdb-dev")["Depends"])

    def test_leaves_others_files_alone(self):
        ours = ("sono", "Sono", "paraview.conf")
        for name in NAMES:
            for path in map(pathlib.Path, output("dpkg", "--listfiles", name).split()):
                if not path.is_dir():
                    self.assertTrue(any(word in str(path) for word in ours), path)

    def test_paraview_loads_it_by_itself(self):
        for program in "pvpython", "pvbatch":
            with self.subTest(program):
                self.assert_loaded(plain(program, script("plugins.py", PLUGINS)))

    @unittest.skipUnless(shutil.which("Xvfb"), "Xvfb is not installed")
    def test_window_loads_it_by_itself(self):
        reading, writing = os.pipe()
        with subprocess.Popen(["Xvfb", "-displayfd", str(writing)], pass_fds=[writing],
                              stderr=subprocess.DEVNULL) as display:
            try:
                os.close(writing)
                with os.fdopen(reading) as number:
                    name = ":" + number.readline().strip()
                plain("paraview", "--script=" + str(script("window.py", WINDOW)), DISPLAY=name)
                self.assert_loaded((WORK / "window.txt").read_text())
            finally:
                display.terminate()

    def test_simulates(self):
        said = plain("pvpython", EXAMPLES / "simulate.py", "--spacing", "3", "--lines", "16", "--paths", "20",
                     "--output", "image.png")
        self.assertIn("Wrote", said)
        self.assertEqual((WORK / "image.png").read_bytes()[:4], b"\x89PNG")

    def test_simulates_with_plain_python(self):
        plain("/usr/bin/python3", EXAMPLES / "plain_vtk.py")
        self.assertEqual((WORK / "ultrasound.png").read_bytes()[:4], b"\x89PNG")

    def test_server_loads_it_by_itself(self):
        with contextlib.ExitStack() as stack:
            server = stack.enter_context(subprocess.Popen(
                ["pvserver", "--server-port=0"], cwd=WORK, env={"PATH": "/usr/bin:/bin", "HOME": str(WORK / "home")},
                stdout=subprocess.PIPE, text=True))
            stack.callback(server.terminate)
            port = next(line.rsplit(":", 1)[1].strip() for line in server.stdout if "Accepting connection" in line)
            said = plain("pvpython", script("client.py", CLIENT), port)
            self.assertGreater(int(said.split("points")[1]), 100)

    def test_programs_find_it(self):
        for consumer in "Consumer", "FiltersConsumer":
            with self.subTest(consumer):
                build = WORK / consumer
                plain("cmake", "-S", pathlib.Path(__file__).parent / consumer, "-B", build, "-G", "Ninja",
                      "-DCMAKE_BUILD_TYPE=Release")
                plain("cmake", "--build", build)
                plain(build / "consumer", VERSION)


if __name__ == "__main__":
    if os.geteuid() != 0 or any(map(is_installed, NAMES)):
        print("Skipped: it installs packages, for which it needs to be root and to find none of", *NAMES, "installed.")
        sys.exit(77)
    shutil.rmtree(WORK, ignore_errors=True)
    WORK.mkdir(parents=True)
    unittest.main(argv=sys.argv[:1], verbosity=2)
