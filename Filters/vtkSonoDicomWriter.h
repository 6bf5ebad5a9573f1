#ifndef vtkSonoDicomWriter_h
#define vtkSonoDicomWriter_h

#include "vtkSonoFiltersModule.h" // for export macro
#include "vtkSonoFrameWriter.h"

#include <memory>
#include <string>

namespace sono {
class DicomCine;
class DicomMasks;
}

/**
 * @class vtkSonoDicomWriter
 * @brief Writes ultrasound images to a DICOM file, an Ultrasound Multi-frame Image
 *
 * Takes an image that carries its probe: that of vtkSonoScanConverter or vtkSonoUltrasound, flat or in the world, or
 * the pictures of vtkSonoSweep. The point array "BMode" becomes the frames, the transducer on top: each slice of each
 * time step, one after the other, of which the writer holds one at a time. What else is in the file: sono::DicomCine.
 * The file's name ends in .dcm. Beside it, if wanted, NAME.seg.dcm: the label that each pixel shows, of the point array
 * "Labels", as a DICOM Segmentation, see sono::DicomMasks.
 */
class VTKSONOFILTERS_EXPORT vtkSonoDicomWriter : public vtkSonoFrameWriter
{
public:
  static vtkSonoDicomWriter* New();
  vtkTypeMacro(vtkSonoDicomWriter, vtkSonoFrameWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * What the file says of the patient, in UTF-8: the name as family^given. Default "Simulated^Patient" and empty.
   */
  vtkSetStdStringFromCharMacro(PatientName);
  vtkGetCharFromStdStringMacro(PatientName);
  vtkSetStdStringFromCharMacro(PatientId);
  vtkGetCharFromStdStringMacro(PatientId);
  ///@}

  ///@{
  /**
   * Whether the labels are written, too. Default off.
   */
  vtkSetMacro(LabelMasks, bool);
  vtkGetMacro(LabelMasks, bool);
  vtkBooleanMacro(LabelMasks, bool);
  ///@}

  /**
   * Where they are written: NAME.seg.dcm beside NAME.dcm.
   */
  std::string LabelMaskFileName();

protected:
  vtkSonoDicomWriter();
  ~vtkSonoDicomWriter() override;

  std::string NamelessRefusal() const override;
  void Open(vtkImageData* image) override;
  void AddStep(vtkImageData* image) override;
  void Finish() override;
  void Close() override;

private:
  vtkSonoDicomWriter(const vtkSonoDicomWriter&) = delete;
  void operator=(const vtkSonoDicomWriter&) = delete;

  std::string PatientName = "Simulated^Patient";
  std::string PatientId;
  bool LabelMasks = false;
  std::unique_ptr<sono::DicomCine> Cine; // while it is being written
  std::unique_ptr<sono::DicomMasks> Masks;
};

#endif
