"""Programs of others from PyPI that read what is written, in the folder that `install-dependencies.sh tests --peers`
makes. They run by themselves, since their libraries would be loaded beside ParaView's; a test without them is skipped."""
import os
import pathlib
import subprocess
import unittest

FOLDER = pathlib.Path(os.environ.get("SONOVDB_PEERS", pathlib.Path(__file__).parents[2] / "build/peers"))


def needs(*modules):
    """Skips a test where one of these modules is not there."""
    missing = [name for name in modules if not any(FOLDER.glob(f"lib/python3*/site-packages/{name}*"))]
    return unittest.skipIf(missing, f"{', '.join(missing)} is not installed; see install-dependencies.sh tests --peers")


def start(program, *arguments, **settings):
    """A Python program with the peers' modules, as a process."""
    environment = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "PYTHONHOME")}
    environment["KERAS_BACKEND"] = "jax"  # for zea
    environment["XDG_CACHE_HOME"] = str(FOLDER / "cache")
    return subprocess.Popen([str(FOLDER / "bin/python"), "-c", program, *map(str, arguments)], env=environment,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **settings)


def run(program, *arguments):
    """The same to its end; what it printed. Fails where it does."""
    process = start(program, *arguments)
    output, errors = process.communicate()
    if process.returncode != 0:
        raise AssertionError(errors)
    return output
