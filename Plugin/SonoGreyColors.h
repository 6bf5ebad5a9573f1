#pragma once

class vtkSMProxy;
class vtkSMSessionProxyManager;

/// The colour map by which ParaView shows an array of grey levels: where there is none yet, a grey one that looks
/// colours up faster than ParaView's own (vtkSonoColorTable) and is like all others to whoever changes it.
vtkSMProxy* sonoGreyColors(const char* array, vtkSMSessionProxyManager* manager);
