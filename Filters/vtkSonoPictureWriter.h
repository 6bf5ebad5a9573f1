#ifndef vtkSonoPictureWriter_h
#define vtkSonoPictureWriter_h

#include "vtkSonoFiltersModule.h" // for export macro
#include "vtkWriter.h"

#include <string>

/**
 * @class vtkSonoPictureWriter
 * @brief Writes an ultrasound image to a picture file
 *
 * Takes an image with one slice, such as the flat image of vtkSonoScanConverter, and writes a point array of it, the
 * active scalars unless SetInputArrayToProcess names another: the number of a pixel as it is, the first row on top. So
 * the transducer is on top and the probe's marker on the right, as on a scanner. The name's ending chooses the format
 * among those of OpenImageIO: .png and .tif hold 8-bit greys and 16-bit labels, .tif and .exr floats; in .exr greys are
 * fractions of 255. With the size of a pixel, as pixels per cm, where the format has a place for it.
 */
class VTKSONOFILTERS_EXPORT vtkSonoPictureWriter : public vtkWriter
{
public:
  static vtkSonoPictureWriter* New();
  vtkTypeMacro(vtkSonoPictureWriter, vtkWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Path of the file, ending in .png, .tif, .exr or what else OpenImageIO writes.
   */
  vtkSetStdStringFromCharMacro(FileName);
  vtkGetCharFromStdStringMacro(FileName);
  ///@}

protected:
  vtkSonoPictureWriter();
  ~vtkSonoPictureWriter() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  void WriteData() override;

private:
  vtkSonoPictureWriter(const vtkSonoPictureWriter&) = delete;
  void operator=(const vtkSonoPictureWriter&) = delete;

  std::string FileName;
};

#endif
