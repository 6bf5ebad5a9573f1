#pragma once

namespace sono {

/// Walls behind 30 mm of fat, which is slower than assumed: the largest distance along a column of the picture from
/// the brightest place of a wall's echo to where the labels of that picture (Simulator::picture) change, mm. The walls
/// lie across the lines, slanted by 5 degrees, and around a ball.
double maskFitMm();

} // namespace sono
