#include "study/word_list.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>

#include "base/diagnostics.h"
#include "base/nearest_word.h"

namespace pprt {

std::vector<std::string_view> words_in_list(std::string_view option, std::string_view list,
                                            std::span<const std::string_view> known) {
  std::vector<std::string_view> words;
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    const std::string_view word = list.substr(begin, end - begin);
    if (std::find(known.begin(), known.end(), word) == known.end()) {
      throw UsageError(fmt::format("{} {}: '{}' is none of {}{}", option, list, word, fmt::join(known, ", "),
                                   did_you_mean(word, known)));
    }
    words.push_back(word);
    begin = end + 1;
  }
  return words;
}

}  // namespace pprt
