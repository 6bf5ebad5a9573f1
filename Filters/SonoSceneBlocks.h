#pragma once

#include "Core/Progress.h"

class vtkMultiBlockDataSet;

namespace sono {

class Scene;

/// One block a label, named after it: its surface with its colour as cell data "Color". The background, label 0, has
/// none. Builds the labels' distance fields on the way.
void addLabelSurfaces(const Scene& scene, vtkMultiBlockDataSet* blocks, const Progress& progress);

/// One block "Outline": the edges of the label map's box.
void addOutline(const Scene& scene, vtkMultiBlockDataSet* blocks);

} // namespace sono
