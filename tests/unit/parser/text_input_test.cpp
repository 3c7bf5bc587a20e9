#include "parser/text/text_input.h"

#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <clocale>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <thread>

#include "base/diagnostics.h"

namespace pprt::text_input_test {
namespace {

struct Scanned {
  double value = 0;
  std::size_t length = 0;
  friend bool operator==(const Scanned&, const Scanned&) = default;
};

std::optional<Scanned> scan(std::string_view text) {
  double value = 0;
  const char* const end = scan_number(text.data(), text.data() + text.size(), value);
  if (!end) return std::nullopt;
  return Scanned{value, static_cast<std::size_t>(end - text.data())};
}

// The places of a text computed the plain way.
SourceLocation place_by_counting(std::string_view text, std::size_t offset) {
  SourceLocation at{1, 1};
  for (std::size_t i = 0; i < offset; ++i) {
    const bool inside_pair = text[i] == '\r' && i + 1 < text.size() && text[i + 1] == '\n';
    if ((text[i] == '\n' || text[i] == '\r') && !inside_pair) {
      at = {at.line + 1, 1};
    } else {
      ++at.column;
    }
  }
  return at;
}

class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& content)
      : path_(std::filesystem::temp_directory_path() / ("pprt_text_input_" + std::to_string(::getpid()))) {
    std::ofstream(path_, std::ios::binary) << content;
  }
  ~TemporaryFile() { std::filesystem::remove(path_); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

long peak_memory_kilobytes() {
  struct rusage usage = {};
  ::getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

std::string reading_problem(const std::string& path, std::size_t max_bytes) {
  try {
    read_text(path, max_bytes);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

}  // namespace

TEST_CASE("numbers in every form of real files are read") {
  CHECK(scan("12 ") == Scanned{12, 2});
  CHECK(scan("-0") == Scanned{0, 2});
  CHECK(scan("+.5") == Scanned{0.5, 3});
  CHECK(scan("5.") == Scanned{5, 2});
  CHECK(scan("-.8e+1x") == Scanned{-8, 6});
  CHECK(scan("1.11022e-16") == Scanned{1.11022e-16, 11});
  CHECK(scan("1E2") == Scanned{100, 3});
  CHECK(scan("007") == Scanned{7, 3});
  CHECK(scan("1e100") == Scanned{1e100, 5});
}

TEST_CASE("what is no finite number is refused") {
  for (const char* text : {"", "+", "-", ".", "+-1", "-+1", "e5", "nan", "inf", "-inf", "-nan", "+inf", "abc",
                           "1e101", "-1e300", "1e999", "1e99999999999999999999", "- 1"}) {
    CAPTURE(text);
    CHECK_FALSE(scan(text));
  }
}

TEST_CASE("numbers too small for a double are 0") {
  CHECK(scan("1e-999") == Scanned{0, 6});
  CHECK(scan("-1e-400") == Scanned{0, 7});
  CHECK(scan("0." + std::string(400, '0') + "1") == Scanned{0, 403});
  CHECK_FALSE(scan("1" + std::string(400, '0') + "e-5"));
  CHECK_FALSE(scan("0." + std::string(20, '0') + "1e999"));
}

TEST_CASE("numbers do not depend on the locale") {
  const std::string before = std::setlocale(LC_NUMERIC, nullptr);
  for (const char* locale : {"de_DE.UTF-8", "fr_FR.UTF-8"}) {
    if (std::setlocale(LC_NUMERIC, locale)) break;
  }
  const std::optional<Scanned> scanned = scan("1.5");
  std::setlocale(LC_NUMERIC, before.c_str());
  CHECK(scanned == Scanned{1.5, 3});
}

TEST_CASE("line and column are right for any order of lookup and any line ends") {
  for (const std::string_view text :
       {"a\nbc\n\nd", "a\r\nbc\r\n\r\nd\r\n", "a\rb\r\rc", "\r\n\n\r\r\n x\n\ry", ""}) {
    CAPTURE(text);
    LineCursor rising(text);
    LineCursor mixed(text);
    for (std::size_t i = 0; i <= text.size(); ++i) {
      CAPTURE(i);
      CHECK(rising.at(text.data() + i) == place_by_counting(text, i));
      const std::size_t back = (i * 7) % (text.size() + 1);
      CHECK(mixed.at(text.data() + back) == place_by_counting(text, back));
    }
  }
}

TEST_CASE("a quoted token is short and harmless to a terminal") {
  CHECK(quoted("abc") == "'abc'");
  CHECK(quoted("a\x1b[2J\x7f") == "'a\\x1b[2J\\x7f'");
  CHECK(quoted(std::string_view(std::string(41, 'x'))) == "'" + std::string(40, 'x') + "...'");
}

TEST_CASE("a file is read whole and byte by byte") {
  std::string content = "s 0 0 0 1\r\n\x1a";
  for (int doubling = 0; doubling < 18; ++doubling) content += content;
  const TemporaryFile file(content);
  CHECK(read_text(file.path(), content.size()) == content);
  CHECK(reading_problem(file.path(), content.size() - 1) ==
        "cannot read '" + file.path() + "': larger than the limit of " + std::to_string(content.size() - 1) +
            " bytes");
}

TEST_CASE("a file beyond the limit is refused by its size, and an endless one at the limit") {
  // A hole of two gigabytes: if it were read, memory would tell.
  constexpr std::size_t kLimit = std::size_t{1} << 28;
  const TemporaryFile file("");
  std::filesystem::resize_file(file.path(), 8 * kLimit);
  const long before = peak_memory_kilobytes();
  CHECK(reading_problem(file.path(), kLimit) ==
        "cannot read '" + file.path() + "': larger than the limit of 268435456 bytes");
  CHECK(peak_memory_kilobytes() - before < 100'000);
  CHECK(reading_problem("/dev/zero", kLimit) ==
        "cannot read '/dev/zero': larger than the limit of 268435456 bytes");
  CHECK(peak_memory_kilobytes() - before < 400'000);
}

TEST_CASE("a pipe is read whole") {
  std::string content;
  for (int i = 0; i < 500'000; ++i) content += std::to_string(i);  // some megabytes
  const TemporaryFile file("");
  std::filesystem::remove(file.path());
  REQUIRE(::mkfifo(file.path().c_str(), 0600) == 0);
  std::thread writer([&] { std::ofstream(file.path(), std::ios::binary) << content; });
  const std::string read = read_text(file.path(), content.size());
  writer.join();
  CHECK((read == content));
}

TEST_CASE("reading a whole file fails with the reason") {
  CHECK(reading_problem("/nonexistent/x.nff", 100) ==
        "cannot read '/nonexistent/x.nff': No such file or directory");
  CHECK(reading_problem("/", 100) == "cannot read '/': Is a directory");
}

}  // namespace pprt::text_input_test
