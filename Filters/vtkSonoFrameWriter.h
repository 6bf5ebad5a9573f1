#ifndef vtkSonoFrameWriter_h
#define vtkSonoFrameWriter_h

#include "vtkSonoFiltersModule.h" // for export macro
#include "vtkWriter.h"

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

class vtkImageData;

namespace sono {
class TimeSteps;
}

/**
 * @class vtkSonoFrameWriter
 * @brief What writers of sequences have in common: a file of all time steps of an image
 *
 * The time steps are asked for one after the other, of which the writer holds one at a time. Interrupted or refused, no
 * file is left.
 */
class VTKSONOFILTERS_EXPORT vtkSonoFrameWriter : public vtkWriter
{
public:
  vtkAbstractTypeMacro(vtkSonoFrameWriter, vtkWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkTypeBool ProcessRequest(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  ///@{
  /**
   * Path of the file; its ending says what the subclass does.
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
  vtkSonoFrameWriter();
  ~vtkSonoFrameWriter() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  void WriteData() override {} // ProcessRequest does

  /// What to do where no file is named.
  virtual std::string NamelessRefusal() const = 0;
  /// The first time step: opens the file. Throws sono::Error, as those that follow.
  virtual void Open(vtkImageData* image) = 0;
  /// Each time step, the first among them.
  virtual void AddStep(vtkImageData* image) = 0;
  /// All time steps are there: the file is whole.
  virtual void Finish() = 0;
  /// After that, or where it failed or was stopped: what is not finished goes.
  virtual void Close() = 0;

  /// The times of the frames, `slices` of each time step, in s.
  std::vector<double> TimesS(std::size_t slices) const;
  /// Tells of the progress, `fraction` of this time step. Throws sono::Aborted when asked to stop.
  void Tell(double fraction);

private:
  vtkSonoFrameWriter(const vtkSonoFrameWriter&) = delete;
  void operator=(const vtkSonoFrameWriter&) = delete;

  std::string FileName;
  double FrameTimeMs = 0.0;
  std::unique_ptr<sono::TimeSteps> Steps;
};

#endif
