#ifndef vtkSonoTrackedReader_h
#define vtkSonoTrackedReader_h

#include "vtkPolyDataAlgorithm.h"
#include "vtkSonoFiltersModule.h" // for export macro

#include <string>

/**
 * @class vtkSonoTrackedReader
 * @brief Reads the poses of a tracked ultrasound sequence, for vtkSonoSweep
 *
 * Of a sequence of PLUS (.igs.mha, .igs.nrrd): where the probe was, a point a frame, LPS mm, joined by a line, with the
 * point arrays "Axial" and "Lateral", which vtkSonoSweep takes as its poses, "TimeS" and "Frame", the number in the
 * file. Frames in which the tracker did not see the probe are left out, with a warning. The pictures are not read:
 * they are an ordinary MetaImage or NRRD.
 */
class VTKSONOFILTERS_EXPORT vtkSonoTrackedReader : public vtkPolyDataAlgorithm
{
public:
  static vtkSonoTrackedReader* New();
  vtkTypeMacro(vtkSonoTrackedReader, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Path of the file.
   */
  vtkSetStdStringFromCharMacro(FileName);
  vtkGetCharFromStdStringMacro(FileName);
  ///@}

  ///@{
  /**
   * From which system of coordinates to which, as ProbeToReference; put together of those in the file where it has not
   * that one. Default "ProbeToReference".
   */
  vtkSetStdStringFromCharMacro(Transform);
  vtkGetCharFromStdStringMacro(Transform);
  ///@}

  ///@{
  /**
   * From our system of the probe (x lateral, y into the body, mm, 0 in the middle of the face) to the file's, which is
   * the first of Transform, row by row: what a calibration found. Default: they are the same.
   */
  vtkSetVectorMacro(Calibration, double, 16);
  vtkGetVectorMacro(Calibration, double, 16);
  ///@}

  ///@{
  /**
   * From the second system of Transform to the label map's, LPS mm, row by row: what a registration found. Default:
   * they are the same.
   */
  vtkSetVectorMacro(Registration, double, 16);
  vtkGetVectorMacro(Registration, double, 16);
  ///@}

  /**
   * Whether the name is that of a tracked sequence.
   */
  int CanReadFile(const char* fileName);

protected:
  vtkSonoTrackedReader();
  ~vtkSonoTrackedReader() override;

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSonoTrackedReader(const vtkSonoTrackedReader&) = delete;
  void operator=(const vtkSonoTrackedReader&) = delete;

  std::string FileName;
  std::string Transform = "ProbeToReference";
  double Calibration[16] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 };
  double Registration[16] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 };
};

#endif
