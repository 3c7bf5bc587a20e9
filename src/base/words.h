// The words of an enum: one table serves the options that take it, their help and shell completion, the
// ledger and the key by which a run is resumed.
#pragma once

#include <array>
#include <optional>
#include <stdexcept>
#include <string_view>

namespace pprt {

template <typename E>
struct Word {
  E value;
  std::string_view word;
  std::string_view help;  // what it chooses, in a few words; without quotes, which a shell would read
};

// Specialised for each enum that has words, with every value once, in the order in which they are listed:
//   template <> inline constexpr std::array<Word<Axis>, 2> kWords<Axis>{{{Axis::kX, "x", "to the right"}, ...
template <typename E>
inline constexpr std::array<Word<E>, 0> kWords{};

// Returns the value that the word names, or nothing.
template <typename E>
constexpr std::optional<E> find_word(std::string_view word) {
  static_assert(!kWords<E>.empty(), "this enum has no table of words, or its header is not included");
  for (const Word<E>& entry : kWords<E>) {
    if (entry.word == word) return entry.value;
  }
  return std::nullopt;
}

// Returns the word for a value. Throws std::logic_error when the table lacks it.
template <typename E>
constexpr std::string_view word_for(E value) {
  static_assert(!kWords<E>.empty(), "this enum has no table of words, or its header is not included");
  for (const Word<E>& entry : kWords<E>) {
    if (entry.value == value) return entry.word;
  }
  throw std::logic_error("a value without a word");
}

// A switch.
template <>
inline constexpr std::array<Word<bool>, 2> kWords<bool>{{{true, "on", ""}, {false, "off", ""}}};

}  // namespace pprt
