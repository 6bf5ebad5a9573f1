#pragma once

namespace sono {

/// Speed of sound that turns time into range, mm per microsecond. Ranges of all stages are counted with it; what a
/// scanner that assumes another one shows is a matter of scale (see ScanGeometry::shownPerRange).
constexpr double assumedSoundSpeedMmPerUs = 1.54;

/// What an image shows may lie so much deeper than where it is shown: soft tissue that is faster than assumed fills the
/// way. Bone is faster still, but little is heard through it.
constexpr double deepestPerRange = 1.04;

} // namespace sono
