#ifndef vtkSonoTrackedWriter_h
#define vtkSonoTrackedWriter_h

#include "vtkSonoFiltersModule.h" // for export macro
#include "vtkSonoFrameWriter.h"

#include <memory>
#include <string>

namespace sono {
class TrackedCine;
}

/**
 * @class vtkSonoTrackedWriter
 * @brief Writes ultrasound images with their poses to a tracked sequence of PLUS and 3D Slicer
 *
 * Takes an image that carries its probe, as vtkSonoDicomWriter does. "BMode" becomes the frames, each with the pose of
 * the sweep, or else that of the probe, and its time: sono::TrackedCine. The file's name
 * ends in .mha or .nrrd; PLUS has .igs.mha and .igs.nrrd.
 */
class VTKSONOFILTERS_EXPORT vtkSonoTrackedWriter : public vtkSonoFrameWriter
{
public:
  static vtkSonoTrackedWriter* New();
  vtkTypeMacro(vtkSonoTrackedWriter, vtkSonoFrameWriter);

protected:
  vtkSonoTrackedWriter();
  ~vtkSonoTrackedWriter() override;

  std::string NamelessRefusal() const override;
  void Open(vtkImageData* image) override;
  void AddStep(vtkImageData* image) override;
  void Finish() override;
  void Close() override;

private:
  vtkSonoTrackedWriter(const vtkSonoTrackedWriter&) = delete;
  void operator=(const vtkSonoTrackedWriter&) = delete;

  std::unique_ptr<sono::TrackedCine> Cine; // while it is being written
};

#endif
