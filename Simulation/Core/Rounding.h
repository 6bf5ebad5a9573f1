#pragma once

namespace sono {

/// The nearest whole number, halves away from zero, as lround; unlike that, loops over it become vector instructions.
/// |value| < 2^31.
inline int roundedToInt(float value)
{
  const int whole = int(value);
  const float rest = value - float(whole);
  return whole + int(rest >= 0.5f) - int(rest <= -0.5f);
}

} // namespace sono
