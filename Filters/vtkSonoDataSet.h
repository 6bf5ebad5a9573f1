#ifndef vtkSonoDataSet_h
#define vtkSonoDataSet_h

#include "vtkImageAlgorithm.h"
#include "vtkSmartPointer.h"
#include "vtkSonoFiltersModule.h" // for export macro

#include <memory>
#include <string>

namespace sono {
class DataSetImager;
class DataSetPlan;
class ImageStream;
struct DataSetShare;
struct StreamedImage;
}

class vtkSonoGpuImage;

/**
 * @class vtkSonoDataSet
 * @brief Makes the images and masks of a data set that one file declares
 *
 * The output is one of the images, flat, in the probe's own frame as of output 1 of vtkSonoScanConverter, to look at or
 * to learn from. Point arrays: "BMode" (1, black, to 255 in the scanned area, 0 outside) and "Mask" (n for the n-th
 * mask group, from 1; 0 elsewhere), and of the channels that the file asks for those of the pixels, floats by their
 * names (see Data/docs/datasets.md). Field data: "Info", all settings and flags as JSON, and "MaskGroups", the names.
 *
 * With a Folder an update writes the images into it that are not there yet, for nnU-Net or MONAI, as
 * sono::writeDataSet says, with OpenEXR files where the file asks for channels: interrupted or killed, it goes on where
 * it was. Under MPI each process writes its share; the first one gives the output.
 */
class VTKSONOFILTERS_EXPORT vtkSonoDataSet : public vtkImageAlgorithm
{
public:
  static vtkSonoDataSet* New();
  vtkTypeMacro(vtkSonoDataSet, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The file that declares the data set (JSON, see Data/datasets/schema.json), or the name of a bundled one, "apical"
   * or "amadou2024"; empty: "apical". Default empty.
   */
  vtkSetStdStringFromCharMacro(FileName);
  vtkGetCharFromStdStringMacro(FileName);
  ///@}

  ///@{
  /**
   * Where the data set is written; empty: nowhere. Default empty.
   */
  vtkSetStdStringFromCharMacro(Folder);
  vtkGetCharFromStdStringMacro(Folder);
  ///@}

  ///@{
  /**
   * Number of the image that is given, from 0. Default 0.
   */
  vtkSetClampMacro(ImageNumber, int, 0, VTK_INT_MAX);
  vtkGetMacro(ImageNumber, int);
  ///@}

  ///@{
  /**
   * Of how many parts, processes that share the work, this is which, from 0. With 0 parts they are those of MPI.
   * Default 0 and 0.
   */
  vtkSetClampMacro(Part, int, 0, VTK_INT_MAX);
  vtkGetMacro(Part, int);
  vtkSetClampMacro(Parts, int, 0, VTK_INT_MAX);
  vtkGetMacro(Parts, int);
  ///@}

  ///@{
  /**
   * Of the file as it is now: how many images the data set has, which of them this part makes, First to before End, and
   * what an image is for: "train", "validation" or "test". 0 or empty, after an error, where the file or the number is
   * wrong.
   */
  vtkIdType GetNumberOfImages();
  vtkIdType GetFirstImage();
  vtkIdType GetEndImage();
  std::string GetSplit(vtkIdType image);
  ///@}

  ///@{
  /**
   * This part's images one after the other, those of a split or, where it is empty, all: threads make them ahead while
   * the caller does something else, on a GPU several of many bodies at once (see sono::ImageStream). TakeImage, which
   * does not wait, returns IMAGE_TAKEN and has set ImageNumber to one that the next update gives without making it;
   * IMAGE_AWAITED, while none is made; NO_IMAGE_LEFT at the end and after an error. The stream also ends with
   * EndStream, with another BeginStream, and when the file has changed. False after an error.
   */
  enum
  {
    IMAGE_TAKEN,
    IMAGE_AWAITED,
    NO_IMAGE_LEFT
  };
  bool BeginStream(const std::string& split);
  int TakeImage();
  void EndStream();
  ///@}

  ///@{
  /**
   * Images stay on the GPU as well, that of the last update as GetGpuImage says. False after an error, where no GPU
   * makes them. By default they do not, and that is null.
   */
  bool KeepOnGpu();
  vtkSonoGpuImage* GetGpuImage();
  ///@}

  ///@{
  /**
   * Of the last update with a folder: images that were written and how many a second.
   */
  vtkGetMacro(WrittenImages, vtkIdType);
  vtkGetMacro(ImagesPerSecond, double);
  ///@}

protected:
  vtkSonoDataSet();
  ~vtkSonoDataSet() override;

  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSonoDataSet(const vtkSonoDataSet&) = delete;
  void operator=(const vtkSonoDataSet&) = delete;

  std::shared_ptr<const sono::DataSetPlan> ReadPlan();
  sono::DataSetShare GetShare() const;
  void WriteFolder();
  void GiveImage(vtkImageData* image);

  std::string FileName;
  std::string Folder;
  int ImageNumber = 0;
  int Part = 0;
  int Parts = 0;
  vtkIdType WrittenImages = 0;
  double ImagesPerSecond = 0.0;
  std::string Stamp; // of the file that was read last
  std::shared_ptr<const sono::DataSetPlan> Plan;
  std::unique_ptr<sono::DataSetImager> Imager; // keeps the anatomy from image to image
  std::unique_ptr<sono::ImageStream> Stream;
  bool KeepsOnGpu = false;
  vtkSmartPointer<vtkSonoGpuImage> GpuImage;
  std::unique_ptr<sono::StreamedImage> Taken; // of the stream, until an update has given it
};

#endif
