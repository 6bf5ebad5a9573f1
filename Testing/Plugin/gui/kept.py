"""A label map, as ParaView's --script. When an A-line is made for it, which takes the whole simulation, this writes
down which outputs there are already and holds on until somebody has looked at the screen."""
import json
import os
import time

os.environ["XDG_CACHE_HOME"] = os.getcwd()  # where pictures are kept

from paraview.modules.vtkRemotingServerManager import vtkSMProxyIterator, vtkSMProxyManager
from paraview.simple import *

OUTPUTS = {"anatomy": 4, "RF": 2, "flat image": 7}
manager = vtkSMProxyManager.GetProxyManager()


def source(kind):
    sources = vtkSMProxyIterator()
    sources.SetSessionProxyManager(manager.GetActiveSessionProxyManager())
    sources.SetModeToOneGroup()
    sources.Begin("sources")
    while not sources.IsAtEnd():
        if sources.GetProxy().GetXMLName() == kind:
            return sources.GetProxy().GetClientSideObject()
        sources.Next()
    return None


def look(*_):
    if source("SonoALine") and not os.path.exists("outputs.json"):
        ultrasound = source("SonoUltrasound")
        made = [name for name, port in OUTPUTS.items() if ultrasound.GetOutputDataObject(port).GetNumberOfElements(0)]
        with open("outputs.tmp", "w", encoding="utf-8") as file:
            json.dump(made, file)
        os.rename("outputs.tmp", "outputs.json")
        for _ in range(300):
            if os.path.exists("looked"):
                break
            time.sleep(0.1)


labels = LabelMapReader(registrationName="labels", FileName=["thorax.vti"])
labels.UpdatePipeline()
SetActiveSource(labels)
manager.AddObserver("RegisterEvent", look)
