#ifndef vtkSonoTrackedWriter_h
#define vtkSonoTrackedWriter_h

#include "vtkSonoFiltersModule.h" // for export macro
#include "vtkWriter.h"

#include <memory>
#include <string>

class vtkImageData;

namespace sono {
class TrackedCine;
class TimeSteps;
}

/**
 * @class vtkSonoTrackedWriter
 * @brief Writes ultrasound images with their poses to a tracked sequence of PLUS and 3D Slicer
 *
 * Takes an image that carries its probe, as vtkSonoDicomWriter does. "BMode" becomes the frames, each with the pose of
 * the sweep, or else that of the probe, and its time: sono::TrackedCine. Interrupted or refused, no file is left.
 */
class VTKSONOFILTERS_EXPORT vtkSonoTrackedWriter : public vtkWriter
{
public:
  static vtkSonoTrackedWriter* New();
  vtkTypeMacro(vtkSonoTrackedWriter, vtkWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkTypeBool ProcessRequest(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  ///@{
  /**
   * Path of the file, ending in .mha or .nrrd; PLUS has .igs.mha and .igs.nrrd.
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

protected:
  vtkSonoTrackedWriter();
  ~vtkSonoTrackedWriter() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  void WriteData() override {} // ProcessRequest does

private:
  vtkSonoTrackedWriter(const vtkSonoTrackedWriter&) = delete;
  void operator=(const vtkSonoTrackedWriter&) = delete;

  void Begin(vtkImageData* image);
  void AddFrames(vtkImageData* image);

  std::string FileName;
  double FrameTimeMs = 0.0;
  std::unique_ptr<sono::TimeSteps> Steps;
  std::unique_ptr<sono::TrackedCine> Cine; // while it is being written
};

#endif
