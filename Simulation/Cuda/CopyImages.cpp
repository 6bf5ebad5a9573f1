#include "Cuda/CopyImages.h"

#include <tbb/parallel_for.h>

namespace sono {

void copyImages(const float* from, std::size_t pixels, std::vector<float>* to, int images)
{
  tbb::parallel_for(0, images, [&](int i) {
    const float* first = from + std::size_t(i) * pixels;
    to[i].assign(first, first + pixels);
  });
}

} // namespace sono
