#include "cli/process/rank_news.h"

#include <fmt/core.h>

#include <cstring>
#include <sstream>

namespace pprt {

std::string to_text(const RankNews& news) {
  return fmt::format("{}{} {} {} {}{}", kNewsBegin, static_cast<int>(news.event), news.rank, news.number,
                     news.host, kNewsEnd);
}

std::optional<RankNews> news_in(std::string_view text) {
  std::istringstream in{std::string(text)};
  int event = 0;
  RankNews news;
  if (!(in >> event >> news.rank >> news.number)) return std::nullopt;
  if (event < 0 || event > static_cast<int>(RankEvent::kLeft)) return std::nullopt;
  news.event = static_cast<RankEvent>(event);
  in >> news.host;
  return news;
}

std::string rank_name(int rank, std::string_view host) {
  return fmt::format("rank {}", rank) + (host.empty() ? "" : fmt::format(" on {}", host));
}

std::string signal_name(int signal) {
  return fmt::format("signal {} ({})", signal, strsignal(signal));
}

}  // namespace pprt
