#pragma once

class pqPipelineSource;
class pqView;

struct SonoSplit
{
  pqPipelineSource* second = nullptr;
  pqView* body = nullptr; ///< in which the probe stands
};

/// Makes a second Simulate Ultrasound of the same input, with the settings of the first, and shows the flat images of
/// both side by side. Where the probe stands, how deep it looks and whether it is being moved are linked, in Tools >
/// Manage Links; all else is each one's own.
SonoSplit sonoSplitScreen(pqPipelineSource* first);
