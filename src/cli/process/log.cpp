#include "cli/process/log.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <memory>

namespace pprt {

void set_up_log(LogLevel level, int rank) {
  auto logger = std::make_shared<spdlog::logger>("pprt", std::make_shared<spdlog::sinks::stderr_sink_mt>());
  logger->set_pattern("%H:%M:%S.%e rank " + std::to_string(rank) + " %l: %v");
  logger->set_level(spdlog::level::from_str(std::string(word_for(level))));
  spdlog::set_default_logger(logger);
}

void log_info(const std::string& message) {
  spdlog::info("{}", message);
}
void log_debug(const std::string& message) {
  spdlog::debug("{}", message);
}

}  // namespace pprt
