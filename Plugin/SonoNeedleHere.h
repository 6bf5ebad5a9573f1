#pragma once

class pqPipelineSource;
class pqView;
class vtkSMProxy;

/// Whether there is one, and it is a Needle.
bool sonoIsNeedle(vtkSMProxy* source);
/// Whether a Simulate Ultrasound has a Needle as its targets, or room for one: it takes one input of them.
bool sonoTakesNeedle(const pqPipelineSource* ultrasound);

struct SonoShownNeedle
{
  pqPipelineSource* needle = nullptr;
  pqView* body = nullptr; ///< in which it can be dragged; the active one or one on top of several; null: none
};
/// The Needle of a Simulate Ultrasound that takes one, shown in the bodies: the one that it has, else a new one across
/// its picture.
SonoShownNeedle sonoShowNeedle(const pqPipelineSource* ultrasound);
