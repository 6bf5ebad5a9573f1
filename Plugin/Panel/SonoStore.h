#pragma once

#include <QString>

class vtkSMSourceProxy;

/// Writes the flat picture of a Simulate Ultrasound, the transducer on top, to a file where the filter runs. The
/// sentence why not; empty: it is written.
QString sonoStorePicture(vtkSMSourceProxy* ultrasound, const QString& file);
