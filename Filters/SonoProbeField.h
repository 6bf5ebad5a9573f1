#pragma once

#include "Probe/ScanGeometry.h"

class vtkFieldData;
class vtkInformation;

namespace sono {

/// What a probe source hands to the stages after it, in the field data of every output on the way.
struct ProbeField : ProbeSettings
{
  ProbePose pose;
  bool preview = false;  ///< the probe is being moved
  bool coarse = false;   ///< and it is too slow for all that: coarse and quick is better than fine and late
  int linesApart = 1;    ///< of the resting probe's lines, from each that a moving one scans to the next
  bool prepares = false; ///< somebody may move the probe: the anatomy is made ready for that in the background
};

/// One array a number or vector, units in the names (DepthMm, ProbePositionMm, CentreFrequencyMHz, ...), and what the
/// kind of scan lines means for who draws the probe (IsVolume, IsCatheter: 0 or 1). Arrays of `before` that say the
/// same are taken from there.
void writeProbe(const ProbeField& probe, vtkFieldData* field, vtkFieldData* before = nullptr);

/// Throws Error when an array is missing, naming it.
ProbeField readProbe(vtkFieldData* field);

/// One number in field data; `readNumber` throws Error when it is missing.
void writeNumber(const char* name, double value, vtkFieldData* field, vtkFieldData* before = nullptr);
void writeVector(const char* name, const Vec3d& value, vtkFieldData* field, vtkFieldData* before = nullptr);
double readNumber(const char* name, vtkFieldData* field);

/// The same numbers travel ahead of the data, as meta-data of the pipeline's information pass, because an image's
/// size has to be announced before any input has been computed. `announcedFields` throws Error when there are none.
void announceFields(vtkFieldData* field, vtkInformation* outInfo);
vtkFieldData* announcedFields(vtkInformation* inInfo);
/// Announces what another does.
void announceSameFields(vtkInformation* inInfo, vtkInformation* outInfo);

} // namespace sono
