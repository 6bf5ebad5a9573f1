#include "DataSets/MitralLine.h"

#include <cstddef>

namespace sono {

void divideAtHinges(const ImagePoint& first, const ImagePoint& second, const ImagePoint& apex, const MitralSides& sides,
                    const std::uint16_t* labels, int width, std::vector<std::uint8_t>& mask)
{
  const double acrossX = second.column - first.column;
  const double acrossY = second.row - first.row;
  const double length2 = acrossX * acrossX + acrossY * acrossY;
  const auto side = [&](double column, double row) {
    return acrossX * (row - first.row) - acrossY * (column - first.column);
  };
  const double apical = side(apex.column, apex.row);
  for (std::size_t at = 0; at < mask.size(); ++at)
  {
    const bool isEither = mask[at] == sides.ventricle || mask[at] == sides.atrium;
    if (!isEither && !(mask[at] == 0 && (*sides.isValve)[labels[at]]))
    {
      continue;
    }
    const double column = double(at % std::size_t(width));
    const double row = double(at / std::size_t(width));
    const double along = acrossX * (column - first.column) + acrossY * (row - first.row);
    if (along >= 0.0 && along <= length2)
    {
      mask[at] = side(column, row) * apical >= 0.0 ? sides.ventricle : sides.atrium;
    }
  }
}

} // namespace sono
