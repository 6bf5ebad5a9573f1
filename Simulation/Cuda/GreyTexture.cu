#include "Cuda/GreyTexture.h"

#include "Cuda/DeviceImager.h"
#include "Cuda/DeviceMemory.cuh"

#include <cuda_gl_interop.h>

namespace sono {

namespace {

constexpr int threads = 256;

__global__ void paint(const std::uint8_t* grey, int width, const GreyColours colours, cudaSurfaceObject_t texels)
{
  // Greys of neighbouring pixels differ; parameters of a kernel are read quickly where all threads read the same.
  __shared__ uchar4 table[threads];
  const std::uint8_t* mine = &colours[4 * threadIdx.x];
  table[threadIdx.x] = make_uchar4(mine[0], mine[1], mine[2], mine[3]);
  __syncthreads();
  const int x = int(blockIdx.x) * threads + int(threadIdx.x);
  const int y = int(blockIdx.y);
  if (x < width)
  {
    surf2Dwrite(table[grey[std::size_t(y) * std::size_t(width) + std::size_t(x)]], texels, x * int(sizeof(uchar4)), y);
  }
}

/// While it lives, the thread works with a device.
class OnDevice
{
public:
  explicit OnDevice(int device)
  {
    cudaGetDevice(&before_);
    cudaSetDevice(device);
  }
  ~OnDevice() { cudaSetDevice(before_); }
  OnDevice(const OnDevice&) = delete;
  OnDevice& operator=(const OnDevice&) = delete;

private:
  int before_ = 0;
};

} // namespace

struct GreyTexture::Registered
{
  int device = 0;
  int width = 0;
  int height = 0;
  cudaGraphicsResource_t resource = nullptr;
  cudaStream_t stream = nullptr;

  ~Registered()
  {
    const OnDevice on(device);
    if (stream)
    {
      cudaStreamDestroy(stream);
    }
    if (resource)
    {
      cudaGraphicsUnregisterResource(resource);
    }
    cudaGetLastError(); // a context that has gone took it along
  }

  bool paintInto(cudaArray_t texels, const std::uint8_t* grey, const GreyColours& colours) const
  {
    cudaResourceDesc what{};
    what.resType = cudaResourceTypeArray;
    what.res.array.array = texels;
    cudaSurfaceObject_t surface = 0;
    if (cudaCreateSurfaceObject(&surface, &what) != cudaSuccess)
    {
      return false;
    }
    paint<<<dim3(unsigned((width + threads - 1) / threads), unsigned(height)), threads, 0, stream>>>(grey, width,
                                                                                                     colours, surface);
    const bool isPainted = cudaGetLastError() == cudaSuccess && cudaStreamSynchronize(stream) == cudaSuccess;
    cudaDestroySurfaceObject(surface);
    return isPainted;
  }
};

std::unique_ptr<GreyTexture> GreyTexture::of(unsigned name, int width, int height)
{
  unsigned count = 0;
  auto made = std::make_unique<Registered>();
  made->width = width;
  made->height = height;
  const bool isDrawn =
    cudaStatus().usable && cudaGLGetDevices(&count, &made->device, 1, cudaGLDeviceListAll) == cudaSuccess && count > 0;
  const OnDevice on(made->device);
  if (!isDrawn || cudaStreamCreateWithFlags(&made->stream, cudaStreamNonBlocking) != cudaSuccess ||
      cudaGraphicsGLRegisterImage(&made->resource, name, GL_TEXTURE_2D, cudaGraphicsRegisterFlagsSurfaceLoadStore) !=
        cudaSuccess)
  {
    cudaGetLastError();
    return nullptr;
  }
  std::unique_ptr<GreyTexture> texture(new GreyTexture);
  texture->registered_ = std::move(made);
  return texture;
}

GreyTexture::~GreyTexture() = default;

bool GreyTexture::fill(const std::uint8_t* grey, const GreyColours& colours)
{
  if (!isOnGpu(grey))
  {
    return false;
  }
  Registered& r = *registered_;
  const OnDevice on(r.device);
  bool isFilled = false;
  if (cudaGraphicsMapResources(1, &r.resource, r.stream) == cudaSuccess)
  {
    cudaArray_t texels = nullptr;
    isFilled = cudaGraphicsSubResourceGetMappedArray(&texels, r.resource, 0, 0) == cudaSuccess &&
               r.paintInto(texels, grey, colours);
    cudaGraphicsUnmapResources(1, &r.resource, r.stream);
  }
  cudaGetLastError();
  return isFilled;
}

bool isOnGpu(const void* memory)
{
  cudaPointerAttributes of{};
  const bool isKnown = cudaStatus().usable && cudaPointerGetAttributes(&of, memory) == cudaSuccess;
  cudaGetLastError();
  return isKnown && of.type == cudaMemoryTypeManaged;
}

} // namespace sono
