#pragma once

namespace sono {

/// The version of the library that is linked, as "0.2.0".
const char* version();

} // namespace sono
