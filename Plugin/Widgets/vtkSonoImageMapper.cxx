#include "vtkSonoImageMapper.h"

#include "vtkActor.h"
#include "vtkCellArray.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkImageSliceRepresentation.h"
#include "vtkObjectFactory.h"
#include "vtkOpenGLPolyDataMapper.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLTexture.h"
#include "vtkPVLODActor.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkRenderer.h"
#include "vtkScalarsToColors.h"
#include "vtkSonoGpuTexture.h"
#include "vtkTextureObject.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <numeric>
#include <string>

vtkStandardNewMacro(vtkSonoImageMapper);

namespace {

constexpr int greyCount = 256;
constexpr int texelBytes = 4;

/// A representation makes its mapper itself and asks no factory for it.
struct OpenRepresentation : vtkImageSliceRepresentation
{
  static vtkPVImageSliceMapper*& mapperOf(vtkImageSliceRepresentation* representation)
  {
    return representation->*(&OpenRepresentation::SliceMapper);
  }
};

/// CUDA is not to be asked about a context of another driver's.
bool isNvidia(vtkOpenGLRenderWindow* window)
{
  const std::string all = window->ReportCapabilities();
  const std::size_t vendor = all.find("OpenGL vendor string:");
  return vendor < all.find("NVIDIA", vendor) && all.find("NVIDIA", vendor) < all.find('\n', vendor);
}

vtkSmartPointer<vtkUnsignedCharArray> colorsOf(vtkScalarsToColors* table, int mode)
{
  vtkNew<vtkUnsignedCharArray> greys;
  greys->SetNumberOfValues(greyCount);
  std::iota(greys->GetPointer(0), greys->GetPointer(0) + greyCount, static_cast<unsigned char>(0));
  return vtkSmartPointer<vtkUnsignedCharArray>::Take(table->MapScalars(greys, mode, -1));
}

} // namespace

vtkSonoImageMapper::vtkSonoImageMapper()
{
  constexpr int cornerCount = 4;
  this->Corners->SetNumberOfPoints(cornerCount);
  vtkNew<vtkCellArray> face;
  face->InsertNextCell({ 0, 1, 2, 3 });
  vtkNew<vtkFloatArray> places;
  places->SetNumberOfComponents(2);
  for (const auto& [s, t] : { std::pair{ 0, 0 }, std::pair{ 1, 0 }, std::pair{ 1, 1 }, std::pair{ 0, 1 } })
  {
    places->InsertNextTuple2(s, t);
  }
  vtkNew<vtkPolyData> quad;
  quad->SetPoints(this->Corners);
  quad->SetPolys(face);
  quad->GetPointData()->SetTCoords(places);
  vtkNew<vtkOpenGLPolyDataMapper> mapper;
  mapper->SetInputData(quad);
  this->Quad->SetMapper(mapper);
  this->Shown->RepeatOff();
  this->Shown->SetTextureObject(this->Texels);
  this->Quad->SetTexture(this->Shown);
}

vtkSonoImageMapper::~vtkSonoImageMapper()
{
  this->Close(); // before the texels go
}

void vtkSonoImageMapper::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "PicturesOnGpu: " << this->PicturesOnGpu << endl;
}

void vtkSonoImageMapper::UseIn(vtkImageSliceRepresentation* representation)
{
  vtkPVImageSliceMapper*& mapper = OpenRepresentation::mapperOf(representation);
  if (!vtkSonoGpuTexture::CanBe() || vtkSonoImageMapper::SafeDownCast(mapper))
  {
    return;
  }
  vtkSonoImageMapper* mine = vtkSonoImageMapper::New();
  mine->ShallowCopy(mapper); // which leaves out where it lies
  mine->SetUseXYPlane(mapper->GetUseXYPlane());
  mine->SetSlice(mapper->GetSlice());
  mine->SetSliceMode(mapper->GetSliceMode());
  if (mapper->GetNumberOfInputConnections(0) > 0)
  {
    mine->SetInputConnection(mapper->GetInputConnection(0, 0));
  }
  representation->GetActor()->SetMapper(mine);
  mapper->Delete();
  mapper = mine;
}

/// Those that are coloured by a table, of an image in a plane; null for all else.
vtkUnsignedCharArray* vtkSonoImageMapper::Greys(vtkImageData* image)
{
  int size[3];
  image->GetDimensions(size);
  if (size[2] != 1 || !this->LookupTable || this->ColorMode != VTK_COLOR_MODE_MAP_SCALARS)
  {
    return nullptr;
  }
  int isOfCells = 0;
  const int access = *this->ArrayName ? VTK_GET_ARRAY_BY_NAME : VTK_GET_ARRAY_BY_ID;
  auto* greys = vtkUnsignedCharArray::SafeDownCast(
    vtkAbstractMapper::GetScalars(image, this->ScalarMode, access, this->ArrayId, this->ArrayName, isOfCells));
  return isOfCells || !greys || greys->GetNumberOfComponents() != 1 ? nullptr : greys;
}

/// Whether the window is drawn by a GPU that fills textures of this size; asked once of each.
bool vtkSonoImageMapper::Open(vtkOpenGLRenderWindow* window, int width, int height)
{
  if (window == this->Window && width == this->Width && height == this->Height)
  {
    return this->Gpu->IsOpen();
  }
  this->Close();
  this->Window = window;
  this->Width = width;
  this->Height = height;
  if (!isNvidia(window))
  {
    return false;
  }
  this->Texels->SetContext(window);
  this->Texels->Allocate2D(static_cast<unsigned int>(width), static_cast<unsigned int>(height), texelBytes,
                           VTK_UNSIGNED_CHAR);
  const int filter = this->Texture->GetInterpolate() ? vtkTextureObject::Linear : vtkTextureObject::Nearest;
  this->Texels->SetMinificationFilter(filter);
  this->Texels->SetMagnificationFilter(filter);
  this->Texels->SetWrapS(vtkTextureObject::ClampToEdge);
  this->Texels->SetWrapT(vtkTextureObject::ClampToEdge);
  this->Texels->Activate(); // so that OpenGL has all this before CUDA shares it; then it is not to change
  this->Texels->Deactivate();
  if (!this->Gpu->Open(this->Texels->GetHandle(), width, height))
  {
    return false;
  }
  vtkSonoGpuTexture::KeepPictures();
  this->FillTime = vtkTimeStamp();
  return true;
}

bool vtkSonoImageMapper::Fill(vtkImageData* image, vtkUnsignedCharArray* greys)
{
  const vtkMTimeType changed = std::max({ this->GetMTime(), image->GetMTime(), this->LookupTable->GetMTime() });
  if (changed < this->FillTime)
  {
    return true;
  }
  if (!this->Gpu->Fill(greys, colorsOf(this->LookupTable, this->ColorMode)))
  {
    return false;
  }
  this->FillTime.Modified();
  ++this->PicturesOnGpu;
  return true;
}

void vtkSonoImageMapper::Place(vtkImageData* image)
{
  int extent[6];
  image->GetExtent(extent);
  const int corners[4][2] = { { 0, 2 }, { 1, 2 }, { 1, 3 }, { 0, 3 } };
  for (int corner = 0; corner < 4; ++corner)
  {
    double place[3] = { double(extent[corners[corner][0]]), double(extent[corners[corner][1]]), double(extent[4]) };
    image->TransformContinuousIndexToPhysicalPoint(place, place);
    place[2] = this->UseXYPlane ? 0.0 : place[2];
    this->Corners->SetPoint(corner, place);
  }
  this->Corners->Modified();
}

bool vtkSonoImageMapper::RenderOnGpu(vtkRenderer* renderer, vtkActor* actor)
{
  this->Update();
  vtkImageData* image = this->GetInput();
  auto* window = vtkOpenGLRenderWindow::SafeDownCast(renderer->GetRenderWindow());
  vtkUnsignedCharArray* greys = image && window ? this->Greys(image) : nullptr;
  if (!greys || !this->Open(window, image->GetDimensions()[0], image->GetDimensions()[1]) ||
      !vtkSonoGpuTexture::Holds(greys) || !this->Fill(image, greys))
  {
    return false;
  }
  this->Place(image);
  this->Quad->vtkProp3D::ShallowCopy(actor);
  this->Quad->SetPropertyKeys(actor->GetPropertyKeys());
  this->Quad->SetProperty(actor->GetProperty());
  this->Shown->Render(renderer);
  this->Quad->GetMapper()->Render(renderer, this->Quad);
  this->Shown->PostRender(renderer);
  return true;
}

void vtkSonoImageMapper::Render(vtkRenderer* renderer, vtkActor* actor)
{
  if (!this->RenderOnGpu(renderer, actor))
  {
    this->Superclass::Render(renderer, actor);
  }
}

void vtkSonoImageMapper::Close()
{
  if (this->Gpu->IsOpen() && this->Window)
  {
    this->Window->PushContext();
    this->Gpu->Close();
    this->Window->PopContext();
  }
  this->Gpu->Close();
}

void vtkSonoImageMapper::ReleaseGraphicsResources(vtkWindow* window)
{
  this->Close();
  this->Window = nullptr;
  this->Shown->ReleaseGraphicsResources(window);
  this->Quad->ReleaseGraphicsResources(window);
  this->Superclass::ReleaseGraphicsResources(window);
}
