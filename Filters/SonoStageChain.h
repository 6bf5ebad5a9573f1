#pragma once

#include <functional>
#include <string>
#include <vector>

class vtkAlgorithm;

namespace sono {

/// Stages that run inside another filter, which reports their progress and tells of their failures and warnings as
/// its own.
class StageChain
{
public:
  /// One of the stages, and where its progress ends in that of the whole, which has the stage's text meanwhile.
  struct Link
  {
    vtkAlgorithm* stage;
    double progressEnd;
  };

  /// The links in the order in which they run, for as long as the chain lives.
  StageChain(vtkAlgorithm* owner, std::vector<Link> links);
  ~StageChain();
  StageChain(const StageChain&) = delete;
  StageChain& operator=(const StageChain&) = delete;

  /// The information pass of the last link and all before it. Throws Error with the sentence of the one that failed.
  void updateInformation();

  /// Makes the data of the links up to `last` that are not up to date. Throws Error as above, Aborted when the owner is
  /// to stop.
  void update(vtkAlgorithm* last);

private:
  void reportProgress(std::size_t link, double fraction);
  [[noreturn]] void throwFailure() const;

  vtkAlgorithm* owner_;
  std::vector<Link> links_;
  std::vector<unsigned long> ears_; ///< an observer a link
};

} // namespace sono
