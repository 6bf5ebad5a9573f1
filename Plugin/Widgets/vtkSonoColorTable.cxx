#include "vtkSonoColorTable.h"

#include "vtkObjectFactory.h"

#include <array>
#include <cstddef>
#include <cstring>
#include <numeric>

vtkStandardNewMacro(vtkSonoColorTable);

namespace {

constexpr int byteCount = 256;

template<int components>
void lookUp(const unsigned char* bytes, int increment, int count, const unsigned char* colors, unsigned char* output)
{
  for (int i = 0; i < count; ++i)
  {
    std::memcpy(output + std::ptrdiff_t(components) * i, colors + components * bytes[std::ptrdiff_t(increment) * i],
                components);
  }
}

} // namespace

void vtkSonoColorTable::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}

void vtkSonoColorTable::MapScalarsThroughTable2(void* input, unsigned char* output, int inputDataType,
                                                int numberOfValues, int inputIncrement, int outputFormat)
{
  if (inputDataType != VTK_UNSIGNED_CHAR || numberOfValues <= byteCount)
  {
    this->Superclass::MapScalarsThroughTable2(input, output, inputDataType, numberOfValues, inputIncrement,
                                              outputFormat);
    return;
  }
  std::array<unsigned char, byteCount> all;
  std::iota(all.begin(), all.end(), static_cast<unsigned char>(0));
  std::array<unsigned char, byteCount * VTK_RGBA> colors;
  this->Superclass::MapScalarsThroughTable2(all.data(), colors.data(), VTK_UNSIGNED_CHAR, byteCount, 1, outputFormat);
  const auto* bytes = static_cast<const unsigned char*>(input);
  switch (outputFormat)
  {
    case VTK_LUMINANCE:
      return lookUp<1>(bytes, inputIncrement, numberOfValues, colors.data(), output);
    case VTK_LUMINANCE_ALPHA:
      return lookUp<2>(bytes, inputIncrement, numberOfValues, colors.data(), output);
    case VTK_RGB:
      return lookUp<3>(bytes, inputIncrement, numberOfValues, colors.data(), output);
    default:
      return lookUp<4>(bytes, inputIncrement, numberOfValues, colors.data(), output);
  }
}
