// Priority of threads that work beside the frame loop.
#pragma once

namespace pprt {

// Gives the calling thread the lowest scheduling priority: it must not slow the frame loop down. This cannot
// be undone: a process without privileges may not raise a priority.
void take_lowest_priority();

// Gives the calling thread a quarter of a core that a thread of usual priority wants, too. What it does may
// not be put off for long: then it would have to be made up for. This cannot be undone either.
void take_low_priority();

// Asks that the calling thread, which works little and often, runs soon after it wakes, even where all cores
// are busy. It gets no greater share of a core. Linux from 6.12 on does so; elsewhere nothing happens.
void ask_for_short_waits();

}  // namespace pprt
