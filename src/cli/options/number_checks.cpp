#include "cli/options/number_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <string>
#include <string_view>
#include <system_error>

namespace pprt {
namespace {

// Accepts numbers for which `fits`; `wanted` describes them.
CLI::Validator number_check(const std::function<bool(double)>& fits, const std::string& wanted) {
  return CLI::Validator(
      [fits, wanted](std::string& text) -> std::string {
        double value = 0;
        if (CLI::detail::lexical_cast(text, value) && fits(value)) return {};
        return fmt::format("value {} is not a {}", text, wanted);
      },
      "");
}

}  // namespace

CLI::Validator number_between(double least, double most) {
  const bool open = most == std::numeric_limits<double>::max();
  return number_check(
      [=](double value) { return value >= least && value <= most; },
      open ? fmt::format("number from {:g}", least) : fmt::format("number from {:g} to {:g}", least, most));
}

CLI::Validator number_above_zero() {
  return number_check([](double value) { return value > 0 && std::isfinite(value); }, "number above 0");
}

CLI::Validator any_number() {
  return number_check([](double value) { return !std::isnan(value); }, "number");
}

CLI::Validator count_from(std::uint64_t least, std::uint64_t most) {
  return CLI::Validator(
      [least, most](std::string& text) -> std::string {
        std::uint64_t value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool whole = error == std::errc() && end == text.data() + text.size();
        if (whole && value >= least && value <= most) return {};
        return fmt::format("value {} is not a whole number from {}", text, least) +
               (most < std::numeric_limits<std::uint64_t>::max() ? fmt::format(" to {}", most) : "");
      },
      "");
}

CLI::Validator memory_size() {
  return CLI::Validator(
      [](std::string& text) -> std::string {
        constexpr std::string_view kUnits = "kMGT";
        std::uint64_t value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        const std::string_view unit(end, static_cast<std::size_t>(text.data() + text.size() - end));
        const std::size_t found = unit.empty() ? 0 : kUnits.find(unit);
        double bytes = static_cast<double>(value);
        for (std::size_t i = 0; !unit.empty() && i <= std::min(found, kUnits.size()); ++i) bytes *= 1000;
        if (error != std::errc() || value == 0 || found == std::string_view::npos || bytes > 1e18)
          return fmt::format("value {} is no size of memory, such as 500M or 4G", text);
        text = fmt::format("{:.0f}", bytes);
        return {};
      },
      "");
}

}  // namespace pprt
