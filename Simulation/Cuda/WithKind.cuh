#pragma once

#include "Kernel/EchoSplat.h"

#include <type_traits>

namespace sono {

/// Calls launch with the kind as a constant.
template<class Launch>
void withKind(BeamKind kind, const Launch& launch)
{
  switch (kind)
  {
    case BeamKind::Gaussian:
      launch(std::integral_constant<BeamKind, BeamKind::Gaussian>());
      break;
    case BeamKind::Aperture:
      launch(std::integral_constant<BeamKind, BeamKind::Aperture>());
      break;
    case BeamKind::Field:
      launch(std::integral_constant<BeamKind, BeamKind::Field>());
      break;
    case BeamKind::Array:
      launch(std::integral_constant<BeamKind, BeamKind::Array>());
      break;
  }
}

} // namespace sono
