#pragma once

#include "vtkSmartPointer.h"

#include <memory>

class vtkSMProxy;
class vtkSonoPhasesAhead;

/// Of a Simulate Ultrasound: has the phases of its label map made ready in the background.
class SonoPhases
{
public:
  /// Null where they are made when they are shown: on a server, or of a label map that comes out of a filter or from
  /// elsewhere, which may not run on a thread of its own.
  static std::unique_ptr<SonoPhases> begin(vtkSMProxy* ultrasound);
  ~SonoPhases();

  vtkSonoPhasesAhead* work() const { return work_; }

private:
  SonoPhases();

  vtkSmartPointer<vtkSMProxy> source_; // the second ones
  vtkSmartPointer<vtkSMProxy> ultrasound_;
  vtkSmartPointer<vtkSonoPhasesAhead> work_; // ends before they go
};
