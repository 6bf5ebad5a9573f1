#pragma once

#include <array>
#include <cstdint>
#include <memory>

namespace sono {

/// Colours of the 256 greys: red, green, blue and opacity of each, one after the other.
using GreyColours = std::array<std::uint8_t, 4 * 256>;

/// A texture of OpenGL that a GPU fills from bytes where it has them (CUDA's graphics interoperability): they do not
/// come to the host. Made, filled and destroyed where the texture's context is current.
class GreyTexture
{
public:
  /// Of a two-dimensional texture of OpenGL by its name, with memory for width x height texels of four bytes, which it
  /// must keep while this lives. Null where what draws it is no GPU that CUDA can use, and in a program without CUDA.
  static std::unique_ptr<GreyTexture> of(unsigned name, int width, int height);
  ~GreyTexture();
  GreyTexture(const GreyTexture&) = delete;
  GreyTexture& operator=(const GreyTexture&) = delete;

  /// The colours of width x height greys, row by row. Returns when it has read them; false: the GPU cannot read them
  /// where they are, or failed.
  bool fill(const std::uint8_t* grey, const GreyColours& colours);

private:
  GreyTexture() = default;
  struct Registered;
  std::unique_ptr<Registered> registered_;
};

/// Whether a GPU reads this memory at its own speed: that of pictures since keepPicturesOnGpu().
bool isOnGpu(const void* memory);

/// From now on single pictures made on a GPU stay there until somebody on the host reads them, page by page; for a
/// process that draws them by GreyTexture. Without effect where the system cannot do that.
void keepPicturesOnGpu();

} // namespace sono
