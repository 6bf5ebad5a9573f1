#pragma once

class pqPipelineSource;
class pqView;

/// Whether a Simulate Ultrasound has a Needle as its targets, or room for one: it takes one input of them.
bool sonoTakesNeedle(const pqPipelineSource* ultrasound);
/// The Needle of a Simulate Ultrasound that takes one, shown in the bodies: the one that it has, else a new one across
/// its picture.
pqPipelineSource* sonoShowNeedle(const pqPipelineSource* ultrasound);
/// A body in which a Simulate Ultrasound can be seen, the active one or one on top where there are several; null: none.
pqView* sonoBodyOf(const pqPipelineSource* ultrasound);
