#pragma once

#include "Labels/LabelVolume.h"

#include <string>

namespace sono {

/// What the labels of a map without any names are, where their shapes are a heart's: chambers and the wall around one.
///
/// A label is the wall where it lies around another: 60 % of that one's faces but those on the volume's border are
/// beside it, and its wall would be 2 to 30 mm thick, of 0.1 to 10 times the volume of the cavity of 4 to 600 ml. What
/// such a wall lies around, and what else comes within 4 mm or a voxel of one or of a chamber, is a chamber. The
/// numbers are chosen: they hold for left ventricles between systole and diastole, in whatever order the labels are
/// (ACDC: right ventricle, wall, left ventricle; CAMUS: left ventricle, wall, atrium; MM-WHS renumbered).
///
/// Gives these labels the tissues "myocardium" and "blood", as guesses, unless they have one, and returns a sentence
/// that says so; empty, and nothing is changed, where one label besides the background and what a body fill adds has
/// a name, or where there is no such wall. Call it before assignTissues.
std::string guessHeart(LabelVolume& volume);

} // namespace sono
