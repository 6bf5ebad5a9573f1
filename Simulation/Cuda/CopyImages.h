#pragma once

#include <cstddef>
#include <vector>

namespace sono {

/// Gives each of `images` images of `pixels` values, one after the other in `from`, a vector of its own. In parallel:
/// fresh memory costs more than what is copied into it.
void copyImages(const float* from, std::size_t pixels, std::vector<float>* to, int images);

} // namespace sono
