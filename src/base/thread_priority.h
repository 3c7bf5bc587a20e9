// Priority of threads that work beside the frame loop and must not slow it down.
#pragma once

namespace pprt {

// Gives the calling thread the lowest scheduling priority. This cannot be undone: a process without
// privileges may not raise a priority.
void take_lowest_priority();

}  // namespace pprt
