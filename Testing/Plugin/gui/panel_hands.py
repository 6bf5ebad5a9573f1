"""Hands and eyes for the scenes of panel.py, and what they have found."""
import hashlib
import pathlib
import time

import numpy as np
from monkey_hands import Hands
from paraview.simple import *
from paraview.vtk.util.numpy_support import vtk_to_numpy
from PyQt5 import QtWidgets

FLAT_IMAGE = 7
PICTURE_SHOWN = 1532  # SonoMovingViews's event
LONGEST_S = 60
QUIET_MS = 900  # longer than what a probe or a setting waits for before it counts as resting
hands = Hands(pathlib.Path.cwd())
main = hands.main
found = {}


def child(kind, name, inside=main):
    return next(w for w in inside.findChildren(kind, name) if w.isVisible())


def press(name):
    hands.button(name).click()


def trigger(name):
    hands.act_named(name).trigger()


def knob(name):
    """Of the scanner's panel."""
    return child(QtWidgets.QWidget, name, child(QtWidgets.QWidget, "SonoScannerSettings"))


def ultrasounds():
    return [source for _, source in sorted(GetSources().items()) if source.GetXMLName() == "SonoUltrasound"]


def flat_of(ultrasound):
    """The flat picture as rows of greys; none: empty."""
    image = ultrasound.SMProxy.GetClientSideObject().GetOutputDataObject(FLAT_IMAGE)
    grey = image.GetPointData().GetArray("BMode") if image else None
    if not grey:
        return np.zeros((8, 8))
    columns, rows, _ = image.GetDimensions()
    return vtk_to_numpy(grey).reshape(rows, columns).astype(float)


def settle():
    """Until nothing has run and no picture has changed for a while."""
    began = quiet = time.monotonic()
    before = None
    while time.monotonic() - quiet < 1e-3 * QUIET_MS:
        yield 100
        state = [hashlib.md5(flat_of(each).tobytes()).hexdigest() for each in ultrasounds()]
        busy = servermanager.ActiveConnection.Session.GetPendingProgress() or any(each.Preview for each in ultrasounds())
        if busy or state != before:
            quiet, before = time.monotonic(), state
        if time.monotonic() - began > LONGEST_S:
            raise TimeoutError("the picture does not come to rest")


def note(name, ultrasound, **more):
    picture = flat_of(ultrasound)
    middle = picture[:, picture.shape[1] // 3:2 * picture.shape[1] // 3]
    found[name] = {"position": list(ultrasound.PositionMm), "axial": list(ultrasound.Axial), "lateral": list(ultrasound.Lateral),
                   "picture": hashlib.md5(picture.tobytes()).hexdigest(),
                   "bands": [float(band.mean()) for band in np.array_split(middle, 8)],
                   "waits": child(QtWidgets.QAbstractButton, "Accept").isEnabled(), **more}


def hands_at(steps):
    """What hands do, a step at a time."""
    for _ in steps:
        yield 100


def picture_with(ultrasound, **properties):
    """Sets these by a script, and waits for the picture."""
    for name, value in properties.items():
        setattr(ultrasound, name, value)
    ultrasound.SMProxy.UpdateVTKObjects()
    RenderAllViews()
    yield from settle()


def begin():
    """The layout of a small thorax."""
    SetActiveSource(ThoraxPhantom(registrationName="thorax", Spacingmm=4))
    yield 500
    trigger("actionSonoSimulate")
    yield from settle()
    (ultrasound,) = ultrasounds()
    yield from picture_with(ultrasound, LineCount=24, PathsPerLine=64)
    return ultrasound


def looks(widget):
    image = widget.grab().toImage()
    bits = image.bits()
    bits.setsize(image.byteCount())
    return bytes(bits)


def watch(ultrasound):
    """A list that grows with each picture on the way: the picture, the probe's lateral direction and the moment."""
    shown = []
    ultrasound.SMProxy.AddObserver(PICTURE_SHOWN, lambda *_: shown.append(
        (hashlib.md5(flat_of(ultrasound).tobytes()).hexdigest(), list(ultrasound.Lateral), GetActiveView().ViewTime)))
    return shown
