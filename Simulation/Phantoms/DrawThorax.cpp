#include "Phantoms/DrawThorax.h"

#include "Kernel/Rng.h"

namespace sono {

ThoraxParameters drawThoraxParameters(std::uint64_t seed)
{
  std::uint32_t count = 0;
  const auto draw = [&](double low, double high) {
    return low + (high - low) * double(uniformFrom(philox(seed, count++, 0u, 0u, 0x7402a8u).v[0]));
  };
  const double state = draw(0.0, 3.0);
  const bool dilated = state > 1.0 && state < 2.0;
  const bool thick = state >= 2.0;
  ThoraxParameters p;
  p.leftVentricleMl = dilated ? draw(150.0, 180.0) : draw(70.0, 140.0);
  p.wallThicknessMm = thick ? draw(11.0, 15.0) : draw(7.0, 10.0);
  p.leftAtriumMl = dilated ? draw(55.0, 85.0) : draw(35.0, 60.0);
  p.rightVentricleMl = draw(85.0, 140.0);
  p.rightAtriumMl = draw(50.0, 90.0);
  p.valveOpening = draw(0.1, 0.6);
  p.bodyScale = dilated ? draw(1.10, 1.18) : draw(1.0, 1.15);
  p.heartLeftMm = draw(-6.0, 0.0);
  p.heartBackMm = dilated ? draw(4.0, 9.0) : draw(0.0, 6.0); // a large heart keeps off the ribs
  p.heartUpMm = draw(-8.0, 8.0);
  const double fat = draw(0.0, 1.0);
  p.extraFatMm = 20.0 * fat * fat; // few are stout
  p.ribSpacingMm = draw(26.0, 32.0);
  p.lungOverlapMm = draw(0.0, 20.0);
  p.breathing = draw(0.0, 0.6);
  const bool supine = draw(0.0, 1.0) < 0.02; // few cannot turn
  p.leftLateral = supine ? draw(0.0, 0.4) : draw(0.6, 1.0);
  p.phase = draw(0.0, 1.0);
  p.ejectionPercent = dilated ? draw(20.0, 45.0) : draw(52.0, 62.0);
  // On the left side the heart lies against the chest wall; along its axis.
  const double forwardMm = supine ? 0.0 : draw(0.0, dilated ? 3.0 : 6.0);
  p.heartLeftMm += 0.53 * forwardMm;
  p.heartBackMm -= 0.65 * forwardMm;
  p.heartUpMm -= 0.545 * forwardMm;
  return p;
}

} // namespace sono
