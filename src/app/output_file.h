// Output that is either whole or not there.
#pragma once

#include <functional>
#include <iosfwd>
#include <string>

namespace pprt {

// Lets `write` fill a file that gets the name `path` only when it is whole: it is written beside it under a
// temporary name, then renamed, replacing an older one. A path to something other than a regular file (a
// device, a pipe) is written directly; "-" is standard output. Throws std::runtime_error naming the file.
void write_output(const std::string& path, const std::function<void(std::ostream&)>& write);

}  // namespace pprt
