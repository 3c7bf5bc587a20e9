// Text of others in messages: a terminal would obey the control characters in it.
#pragma once

#include <string>
#include <string_view>

namespace pprt {

// Returns the text with its control characters as escapes: "\x1b" for ESC, "\n" for a line end. C1 controls
// in UTF-8 count too.
std::string printable(std::string_view text);

// The same for a message of several lines, whose line ends stay.
std::string printable_lines(std::string_view text);

}  // namespace pprt
