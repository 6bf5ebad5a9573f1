#ifndef vtkSonoLineWriter_h
#define vtkSonoLineWriter_h

#include "vtkSonoFiltersModule.h" // for export macro
#include "vtkWriter.h"

#include <memory>
#include <string>

class vtkImageData;

namespace sono {
class LineCine;
class TimeSteps;
}

/**
 * @class vtkSonoLineWriter
 * @brief Writes RF lines to an HDF5 file for beamforming and learning: zea or UFF
 *
 * Takes the lines of vtkSonoImageFormation, or those of vtkSonoUltrasound. "IQ" of each time step becomes a frame, of
 * which the writer holds one at a time, with the place of each sample, the probe, its elements and pose, sampling and
 * speed of sound. The name's ending chooses the format: .hdf5 zea's, .uff USTB's. What is in them: sono::zeaFile,
 * sono::uffFile. Interrupted or refused, no file is left.
 */
class VTKSONOFILTERS_EXPORT vtkSonoLineWriter : public vtkWriter
{
public:
  static vtkSonoLineWriter* New();
  vtkTypeMacro(vtkSonoLineWriter, vtkWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkTypeBool ProcessRequest(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  ///@{
  /**
   * Path of the file, ending in .hdf5, .h5 (zea) or .uff (USTB).
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
  vtkSonoLineWriter();
  ~vtkSonoLineWriter() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  void WriteData() override {} // ProcessRequest does

private:
  vtkSonoLineWriter(const vtkSonoLineWriter&) = delete;
  void operator=(const vtkSonoLineWriter&) = delete;

  void Begin(vtkImageData* image);
  void AddFrame(vtkImageData* image);

  std::string FileName;
  double FrameTimeMs = 0.0;
  std::unique_ptr<sono::TimeSteps> Steps;
  std::unique_ptr<sono::LineCine> Cine; // while it is being written
};

#endif
