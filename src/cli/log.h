// What the program says of its own doings, for who looks for a fault. Nothing of it is needed to use the
// program.
#pragma once

#include <string>

namespace pprt {

// Standard error gets messages of at least this level: trace, debug, info, warning, error or off. `rank`
// stands before each of them.
void set_up_log(const std::string& level, int rank);

void log_info(const std::string& message);
void log_debug(const std::string& message);

}  // namespace pprt
