#include "vtkSonoScanReader.h"

#include "Labels/ReadIntensities.h"
#include "SonoLabelImage.h"
#include "SonoSharedArray.h"
#include "SonoStage.h"

#include "vtkDataObject.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkStringArray.h"

vtkStandardNewMacro(vtkSonoScanReader);

vtkSonoScanReader::vtkSonoScanReader()
{
  this->SetNumberOfInputPorts(0);
  this->SetProgressText("Reading the scan");
}

vtkSonoScanReader::~vtkSonoScanReader() = default;

void vtkSonoScanReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << this->FileName << endl;
}

int vtkSonoScanReader::RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  return sono::announceStage(this, [&] {
    if (this->FileName.empty())
    {
      throw sono::Error("No scan is named; set FileName to a NIfTI, NRRD or MetaImage file or a DICOM series.");
    }
    this->Volume =
      std::make_shared<const sono::IntensityVolume>(sono::readIntensities(this->FileName, sono::progressOf(this)));
    vtkInformation* outInfo = output->GetInformationObject(0);
    sono::announceLabelImage(this->Volume->placement, outInfo);
    vtkDataObject::SetPointDataActiveScalarInfo(outInfo, VTK_FLOAT, 1);
  });
}

int vtkSonoScanReader::RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    if (!this->Volume)
    {
      throw sono::Error("The scan '" + this->FileName + "' was not read; see the error before.");
    }
    vtkImageData* image = vtkImageData::GetData(output);
    sono::placeImage(this->Volume->placement, image);
    const sono::SharedSpan<float> kept{ std::shared_ptr<const float>(this->Volume, this->Volume->values.data()),
                                        this->Volume->values.size() };
    const auto values = sono::sharedArray<vtkFloatArray>("Intensities", kept);
    const sono::IntensityRange range = sono::rangeOf(kept.begin(), kept.size);
    sono::tellRange(range.low, range.high, values);
    image->GetPointData()->SetScalars(values);
    if (!this->Volume->modality.empty())
    {
      vtkNew<vtkStringArray> modality;
      modality->SetName("Modality");
      modality->InsertNextValue(this->Volume->modality);
      image->GetFieldData()->AddArray(modality);
    }
  });
}
