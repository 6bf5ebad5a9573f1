// Makes the bundled thorax with a filter.
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkSonoThoraxSource.h>

int main()
{
  vtkNew<vtkSonoThoraxSource> thorax;
  thorax->SetSpacingMm(5.0);
  thorax->Update();
  return thorax->GetOutput()->GetNumberOfPoints() > 0 ? 0 : 1;
}
