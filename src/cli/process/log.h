// Diagnostic logging on standard error.
#pragma once

#include <string>

#include "base/words.h"

namespace pprt {

enum class LogLevel { kTrace, kDebug, kInfo, kWarning, kError, kOff };

template <>
inline constexpr std::array<Word<LogLevel>, 6> kWords<LogLevel>{{
    {LogLevel::kTrace, "trace", ""},
    {LogLevel::kDebug, "debug", ""},
    {LogLevel::kInfo, "info", ""},
    {LogLevel::kWarning, "warning", ""},
    {LogLevel::kError, "error", ""},
    {LogLevel::kOff, "off", ""},
}};

// Messages of at least this level are printed, each after the time and `rank`.
void set_up_log(LogLevel level, int rank);

void log_info(const std::string& message);
void log_debug(const std::string& message);

}  // namespace pprt
