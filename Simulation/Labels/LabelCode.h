#pragma once

#include "Labels/LabelVolume.h"

#include <string>

namespace sono {

/// A concept of a terminology, as DICOM and 3D Slicer write it.
struct CodedConcept
{
  std::string scheme;  ///< "SCT" (SNOMED CT), "SRT" (SNOMED of older files), "FMA", ...
  std::string value;   ///< "64033007"
  std::string meaning; ///< "Kidney"
};

/// Sets the label's code to that of `type` (the property type of a segment) and, where its name says nothing (see
/// saysNothing), the name to what modifier and type mean: "left kidney". The designators SNM3 and 99SDM of old files
/// become SRT. Leaves the label as it is where `type` has no value.
void describeByCode(const CodedConcept& type, const CodedConcept& modifier, LabelInfo& label);

/// Whether a name is empty or only counts: "Segment_1", "label 3", "7".
bool saysNothing(const std::string& name);

/// The same from a terminology entry of 3D Slicer, as it stands in a segment's tags:
/// CONTEXT~CATEGORY~TYPE~MODIFIER~..., each concept SCHEME^VALUE^MEANING. Leaves the label as it is where the tags hold
/// none.
void describeBySlicerTags(const std::string& tags, LabelInfo& label);

} // namespace sono
