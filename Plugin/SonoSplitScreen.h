#pragma once

class pqPipelineSource;

/// Makes a second Simulate Ultrasound of the same input, with the settings of the first, and shows the flat images of
/// both side by side. Where the probe stands, how deep it looks and whether it is being moved are linked, in Tools >
/// Manage Links; all else is each one's own. The second.
pqPipelineSource* sonoSplitScreen(pqPipelineSource* first);
