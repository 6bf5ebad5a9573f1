#ifndef vtkSonoDicomWriter_h
#define vtkSonoDicomWriter_h

#include "vtkSonoFiltersModule.h" // for export macro
#include "vtkWriter.h"

#include <memory>
#include <string>

class vtkImageData;

namespace sono {
class DicomCine;
class TimeSteps;
}

/**
 * @class vtkSonoDicomWriter
 * @brief Writes ultrasound images to a DICOM file, an Ultrasound Multi-frame Image
 *
 * Takes an image that carries its probe: that of vtkSonoScanConverter or vtkSonoUltrasound, flat or in the world, or
 * the pictures of vtkSonoSweep. The point array "BMode" becomes the frames, the transducer on top: each slice of each
 * time step, one after the other, of which the writer holds one at a time. What else is in the file: sono::DicomCine.
 * Interrupted or refused, no file is left.
 */
class VTKSONOFILTERS_EXPORT vtkSonoDicomWriter : public vtkWriter
{
public:
  static vtkSonoDicomWriter* New();
  vtkTypeMacro(vtkSonoDicomWriter, vtkWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkTypeBool ProcessRequest(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  ///@{
  /**
   * Path of the file, ending in .dcm.
   */
  vtkSetStdStringFromCharMacro(FileName);
  vtkGetCharFromStdStringMacro(FileName);
  ///@}

  ///@{
  /**
   * Time between two frames in ms, 0 to 100,000. 0: the time steps say it, in seconds; without any it is 40. Default 0.
   */
  vtkSetMacro(FrameTimeMs, double);
  vtkGetMacro(FrameTimeMs, double);
  ///@}

  ///@{
  /**
   * What the file says of the patient, in UTF-8: the name as family^given. Default "Simulated^Patient" and empty.
   */
  vtkSetStdStringFromCharMacro(PatientName);
  vtkGetCharFromStdStringMacro(PatientName);
  vtkSetStdStringFromCharMacro(PatientId);
  vtkGetCharFromStdStringMacro(PatientId);
  ///@}

protected:
  vtkSonoDicomWriter();
  ~vtkSonoDicomWriter() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  void WriteData() override {} // ProcessRequest does

private:
  vtkSonoDicomWriter(const vtkSonoDicomWriter&) = delete;
  void operator=(const vtkSonoDicomWriter&) = delete;

  void Begin(vtkImageData* image);
  void AddFrames(vtkImageData* image);

  std::string FileName;
  double FrameTimeMs = 0.0;
  std::string PatientName = "Simulated^Patient";
  std::string PatientId;
  std::unique_ptr<sono::TimeSteps> Steps;
  std::unique_ptr<sono::DicomCine> Cine; // while it is being written
};

#endif
