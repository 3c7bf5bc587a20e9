// Threads that work beside the frame loop must not take its time.
#pragma once

namespace pprt {

// Makes the calling thread the last to be given a processor, as long as others want it. There is no way back:
// a process without privileges may not raise a priority.
void take_lowest_priority();

}  // namespace pprt
