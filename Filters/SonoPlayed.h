#pragma once

#include <cstddef>
#include <memory>
#include <string>

class vtkImageData;

namespace sono {

// What was made of the phases of a motion: label maps, anatomies, surfaces and pictures are kept while the filter that
// made them lives, so that the next play takes them. All of the process together take at most playedLimitBytes; what
// was not used for longest goes first, and so it does while the machine has less than a tenth of its memory left, which
// is looked at whenever a phase is made or taken.

/// Default: a quarter of the machine's memory, and 4 GB at most. 0 keeps nothing.
std::size_t playedLimitBytes();
/// Drops at once what is too much.
void setPlayedLimitBytes(std::size_t bytes);
/// What is kept now, by the sizes that it was kept with.
std::size_t playedBytes();

/// What was kept by this key, and is then the last used; null: nothing.
std::shared_ptr<const void> findPlayed(const std::string& key);
/// Instead of what had this key. What is larger than the limit is not kept.
void keepPlayed(const void* owner, const std::string& key, std::shared_ptr<const void> thing, std::size_t bytes);
/// What that filter kept: it goes, or makes something else from now on.
void dropPlayed(const void* owner);
/// What a filter has kept is from now on as if another one, with the same settings, had.
void givePlayed(const void* owner, const void* next);

/// The image that a source made of a phase; false: it is to be made.
bool takePlayedPhase(const void* source, int phase, vtkImageData* image);
void keepPlayedPhase(const void* source, int phase, vtkImageData* image);

} // namespace sono
