#ifndef vtkSonoLineWriter_h
#define vtkSonoLineWriter_h

#include "vtkSonoFiltersModule.h" // for export macro
#include "vtkSonoFrameWriter.h"

#include <memory>
#include <string>

namespace sono {
class ChannelCine;
class LineCine;
}

/**
 * @class vtkSonoLineWriter
 * @brief Writes RF lines or channel data to an HDF5 file for beamforming and learning: zea or UFF
 *
 * Takes the lines of vtkSonoImageFormation, or those of vtkSonoUltrasound. "IQ" of each time step becomes a frame, of
 * which the writer holds one at a time, with the place of each sample, the probe, its elements and pose, sampling and
 * speed of sound. The name's ending chooses the format: .hdf5 or .h5 zea's, .uff USTB's. What is in them:
 * sono::zeaFile, sono::uffFile. Or takes the channels of vtkSonoChannelData: "RF" with elements, delays and sampling,
 * see sono::zeaChannels and sono::uffChannels.
 */
class VTKSONOFILTERS_EXPORT vtkSonoLineWriter : public vtkSonoFrameWriter
{
public:
  static vtkSonoLineWriter* New();
  vtkTypeMacro(vtkSonoLineWriter, vtkSonoFrameWriter);

protected:
  vtkSonoLineWriter();
  ~vtkSonoLineWriter() override;

  std::string NamelessRefusal() const override;
  void Open(vtkImageData* image) override;
  void AddStep(vtkImageData* image) override;
  void Finish() override;
  void Close() override;

private:
  vtkSonoLineWriter(const vtkSonoLineWriter&) = delete;
  void operator=(const vtkSonoLineWriter&) = delete;

  void OpenLines(vtkImageData* lines);
  void OpenChannels(vtkImageData* channels);

  // One of them while it is being written.
  std::unique_ptr<sono::LineCine> Cine;
  std::unique_ptr<sono::ChannelCine> Channels;
};

#endif
