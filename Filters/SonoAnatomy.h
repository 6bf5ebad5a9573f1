#pragma once

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <functional>
#include <string>
#include <vector>

class vtkAlgorithm;
class vtkDataObject;
class vtkMultiBlockDataSet;
class vtkSonoSceneBuilder;

namespace sono {

/// The anatomy of a filter that takes a label image or a scene: a scene builder inside, whose progress, failures and
/// perhaps warnings are told as the filter's own. It runs when the image or its settings have changed.
class Anatomy
{
public:
  /// `progressEnd`: where the builder's progress ends in that of the whole, which has the builder's text meanwhile.
  /// `say`: hears what there is to say of the anatomy each time that it is built; none where another filter will say
  /// it.
  Anatomy(vtkAlgorithm* owner, vtkSonoSceneBuilder* builder, double progressEnd,
          std::function<void(const std::string&)> say);
  ~Anatomy();
  Anatomy(const Anatomy&) = delete;
  Anatomy& operator=(const Anatomy&) = delete;

  /// The scene's blocks: those of the input, or of the builder where the input is an image, whose labels are the point
  /// array that the owner is set to process, if it is. Throws Error with the builder's sentence, Aborted when the owner
  /// is to stop.
  vtkMultiBlockDataSet* blocks(vtkDataObject* input);
  /// The same where nothing need be built; null otherwise.
  vtkMultiBlockDataSet* builtBlocks(vtkDataObject* input) const;
  /// What there was to say when they were built.
  const std::vector<std::string>& warnings() const { return warnings_; }

private:
  void reportProgress(double fraction);
  void update();

  vtkAlgorithm* owner_;
  vtkSmartPointer<vtkSonoSceneBuilder> builder_;
  double progressEnd_;
  std::function<void(const std::string&)> say_;
  unsigned long ear_;             ///< of the builder's progress
  std::vector<double> connected_; ///< content of the builder's input
  std::vector<std::string> warnings_;
  vtkMTimeType builtAt_ = 0; ///< the builder's time then; 0: what it has is not whole
};

} // namespace sono
