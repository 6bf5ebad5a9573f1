#include "SonoParameters.h"

namespace sono {

ParameterSet::~ParameterSet() = default;

} // namespace sono
