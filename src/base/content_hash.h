// A short name for a text's content: two runs or files of equal content have equal names.
#pragma once

#include <string>
#include <string_view>

namespace pprt {

// Returns 16 hexadecimal digits: the 64-bit FNV-1a hash (Fowler, Noll and Vo). Not cryptographic.
std::string content_hash(std::string_view text);

}  // namespace pprt
