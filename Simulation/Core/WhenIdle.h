#pragma once

namespace sono {

/// From now on the calling thread, which is to end after what it does, runs on cores that no other thread wants. It
/// must hold nothing that others wait for.
void runWhenIdle();

} // namespace sono
