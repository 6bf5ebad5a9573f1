#pragma once

#include <iomanip>
#include <sstream>
#include <string>

/// What the probe says of its movements.
constexpr const char* sonoOffSkin = "That is off the skin: the probe stays where it last stood.";
constexpr const char* sonoNoSkin =
  "No surface is shown here that the probe could stand on: click the eye of Anatomy, or of the Ultrasound Scene.";

/// Such as "Tilt +5.0 degrees".
inline std::string sonoSignedNumber(const char* what, double value, const char* unit)
{
  std::ostringstream text;
  text << what << " " << std::showpos << std::fixed << std::setprecision(1) << value << " " << unit;
  return text.str();
}
