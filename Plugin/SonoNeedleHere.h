#pragma once

class pqPipelineSource;
class pqView;

/// Whether a Simulate Ultrasound has a Needle among its targets, or room for one: it takes one input of targets.
bool sonoTakesNeedle(const pqPipelineSource* ultrasound);
/// The Needle that a Simulate Ultrasound has; else a new one across its picture, below the middle of the probe's face.
pqPipelineSource* sonoNeedleOf(const pqPipelineSource* ultrasound);
/// The first view of a Simulate Ultrasound in its body; null: none.
pqView* sonoBodyOf(const pqPipelineSource* ultrasound);
