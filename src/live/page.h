// The page that the live server serves: page/ as one text, put together at build time (page/embed.cmake).
#pragma once

#include <string_view>

namespace pprt {

// HTML that refers to nothing else.
std::string_view live_page();

}  // namespace pprt
