#pragma once

#include <algorithm>
#include <cstddef>
#include <initializer_list>

namespace sono {

/// At least so long all.
template<class List>
void resizeAll(std::initializer_list<List*> lists, std::size_t count)
{
  for (List* values : lists)
  {
    values->resize(std::max(values->size(), count));
  }
}

} // namespace sono
