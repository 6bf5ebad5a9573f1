#pragma once

#include <string>

class vtkImageData;

namespace sono {

/// Reads a .vti file into `image`. Throws Error naming the file when it is missing or no VTK image that can be read.
void readVtkImage(const std::string& fileName, vtkImageData* image);

} // namespace sono
