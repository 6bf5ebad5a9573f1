#pragma once

#include "vtkSmartPointer.h"

class vtkSMSourceProxy;

/// The filter of this kind that an output of a source has already, or null. A kind without a Line is the same on all
/// outputs.
vtkSMSourceProxy* sonoFindFilterOf(vtkSMSourceProxy* source, unsigned int port, const char* kind);

/// The same, or a new one.
vtkSmartPointer<vtkSMSourceProxy> sonoFilterOf(vtkSMSourceProxy* source, unsigned int port, const char* kind);
