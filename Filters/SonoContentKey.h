#pragma once

#include <string>
#include <vector>

class vtkAlgorithm;
class vtkInformation;

namespace sono {

/// Tells the content of the files that a reader reads.
class ReadFiles
{
public:
  /// Before they are read.
  void willRead(const std::vector<std::string>& files);
  /// Their bytes, in a word; the names of the files do not count. Hashed again only where one has changed. Empty where
  /// one cannot be read or has changed since it was read, so that the data are not those of the files.
  std::string key(const std::vector<std::string>& files);

private:
  std::vector<std::string> read_;
  std::string readStamps_;
  std::string hashedStamps_;
  std::string key_;
};

/// Whether all that there is of a volume lies in the file itself: not in another that its header names.
bool holdsItsVoxels(const std::string& path);

/// What tells the data of an algorithm's input, which may not have been made yet: from files read by SonoVDB's readers,
/// perhaps with a scan added, and nothing else between. Empty where that is not so, or not known.
std::string contentKeyOf(vtkAlgorithm* consumer, int port);

/// Of the program's code: another text after each build or installation.
std::string programKey();

/// A small file's bytes in a word. Throws Error when it cannot be read.
std::string fileKey(const std::string& path);

/// The folder that a CacheFolder property means: "auto" the user's own, if there is one, else what it says; empty:
/// none.
std::string keptFolder(const std::string& property);

/// A request upstream for nothing: an empty extent, for data that are not needed, since what follows from them is
/// known.
void askNothing(vtkInformation* inInfo);
bool isAskedNothing(vtkInformation* outInfo);
/// The answer. Who asks next without saying for what, asks for all of it.
void giveNothing(vtkInformation* outInfo);

/// Whether somebody uses an output: ParaView updates all of a filter whatever is shown. Without ParaView, whoever
/// updates it.
bool isOutputWanted(vtkAlgorithm* producer, int port);

/// Of data none of whose arrays is picked ParaView need not hand on what it has handed on: with a filter that can pick
/// arrays it does at each request, also where the data have nothing to pick from. From within RequestUpdateExtent.
void pickNoArrays(vtkAlgorithm* producer);

/// Whether a request for data would leave what a port has as it is; so it does where nothing is connected.
bool isInputUpToDate(vtkAlgorithm* consumer, int port);

} // namespace sono
