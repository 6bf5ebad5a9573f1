#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace sono {

/// Values that several hold, wherever their memory comes from (a vector, memory that a device writes to).
template<class T>
struct SharedSpan
{
  std::shared_ptr<const T> data;
  std::size_t size = 0;

  SharedSpan() = default;
  SharedSpan(std::shared_ptr<const T> values, std::size_t count)
    : data(std::move(values))
    , size(count)
  {
  }
  explicit SharedSpan(std::vector<T> values)
    : size(values.size())
  {
    const auto owner = std::make_shared<const std::vector<T>>(std::move(values));
    data = std::shared_ptr<const T>(owner, owner->data());
  }

  const T* begin() const { return data.get(); }
  const T* end() const { return data.get() + size; }
  const T& operator[](std::size_t i) const { return data.get()[i]; }
};

} // namespace sono
