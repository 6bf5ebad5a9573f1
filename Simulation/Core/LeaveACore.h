#pragma once

#include <functional>

namespace sono {

/// Runs `work`, whose loops leave a core to others: what is made in the background for later.
void leavingACore(const std::function<void()>& work);

} // namespace sono
