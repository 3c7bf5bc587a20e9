#include "parser/aff_parser.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/diagnostics.h"
#include "base/printable.h"
#include "parser/aff_actions.h"
#include "parser/aff_grammar.h"
#include "parser/aff_messages.h"
#include "parser/text/parser_input.h"
#include "parser/text/text_input.h"

namespace pprt {
namespace aff {
namespace {

namespace fs = std::filesystem;
namespace pegtl = tao::pegtl;
using Input = ParserInput;

// Reports what a rule expected and what was found.
template <typename Rule>
[[noreturn]] void fail(const Input& in, SceneBuilder& builder) {
  const char* const tried = builder.tried();  // before the gap
  std::string message = fmt::format("expected {}", expected<Rule>);
  if (!std::is_same_v<Rule, grammar::end_of_directives>) {
    message += fmt::format(" of '{}'", builder.directive());
  } else if (!builder.directive().empty()) {
    message += fmt::format(" after '{}'", builder.directive());
  }
  const std::string_view token = next_token<grammar::gap, grammar::token>(tried, in.end());
  if (token.empty()) throw ParseFailure{tried, message + ", found the end of the file"};
  throw ParseFailure{token.data(), message + ", found " + quoted(token)};
}

template <typename Rule>
struct control : pegtl::normal<Rule> {
  static void start(const Input& in, SceneBuilder& builder) {
    if constexpr (!expected<Rule>.empty()) builder.try_at(in.current());
  }
  static void failure(const Input& in, SceneBuilder& builder) {
    if constexpr (!expected<Rule>.empty()) fail<Rule>(in, builder);
  }
};

bool begins_line(std::string_view text, const char* place) {
  const std::string_view before = text.substr(0, static_cast<std::size_t>(place - text.data()));
  const std::size_t last = before.find_last_not_of(" \t\f\v");
  return last == std::string_view::npos || before[last] == '\n' || before[last] == '\r';
}

// Reads a scene's files, each in the place where it is included.
class Reader {
 public:
  Reader(const std::string& path, const AffOptions& options)
      : options_(options),
        main_(path),
        folder_(fs::weakly_canonical(fs::path(path)).parent_path()),
        builder_(options, [this](std::string_view name) { include(name); }) {}

  // The main file's text is known, and there are no others.
  void give(std::string_view text) {
    is_alone_ = true;
    files_[main_.string()] =
        std::make_unique<SourceFile>(SourceFile{printable(main_.string()), std::string(text)});
    order_.push_back(files_[main_.string()].get());
  }

  ParsedScene read() {
    try {
      read_file(main_);
    } catch (const Stopped&) {
      throw InputError(report());
    } catch (const TooManyErrors&) {
      throw InputError(report() + fmt::format("\n{}: reading stopped after {} errors",
                                              printable(main_.string()), options_.max_errors));
    }
    builder_.finish();
    if (std::any_of(files_.begin(), files_.end(),
                    [](const auto& f) { return f.second->diagnostics.has_errors(); }))
      throw InputError(report());
    SceneDescription& scene = builder_.scene();
    scene.name = printable(main_.string());
    return {.scene = std::move(scene),
            .warnings = warnings(),
            .files = files_read(),
            .texture_places = std::move(builder_.texture_places())};
  }

 private:
  void read_file(const fs::path& path) {
    SourceFile& file = load(path);
    builder_.enter(file);
    stack_.push_back(path);
    read_directives(file);
    stack_.pop_back();
    builder_.leave();
  }

  // After a problem it continues at the next line that looks like a directive, perhaps the one at hand.
  void read_directives(const SourceFile& file) {
    Input in(file.text.data(), file.text.data() + file.text.size(), "");
    while (!in.empty()) {
      try {
        pegtl::parse<grammar::file, action, control>(in, builder_);
      } catch (const ParseFailure& failure) {
        builder_.report(failure);
        if (failure.fatal) throw Stopped{};
        const bool is_ahead = failure.place > in.current();
        if (is_ahead) in.bump(static_cast<std::size_t>(failure.place - in.current()));
        if (!is_ahead || !begins_line(file.text, failure.place) ||
            !pegtl::parse<pegtl::at<grammar::any_keyword>>(in))
          pegtl::parse<grammar::resume>(in);
      }
    }
  }

  void include(std::string_view name) {
    const auto refuse = [&](const std::string& why, bool fatal = false) {
      throw ParseFailure{name.data(), fmt::format("{}: {}", quoted(name), why), fatal};
    };
    if (builder_.depth() >= static_cast<std::size_t>(options_.max_depth))
      refuse(fmt::format("more than {} files in each other", options_.max_depth));
    if (++reads_ > options_.max_reads)
      refuse(fmt::format("more than {} files are read", options_.max_reads), true);
    const fs::path path = is_alone_ ? fs::path() : find(name);
    if (path.empty()) refuse("there is no such file");
    if (!options_.files_anywhere && !lies_in_folder(path)) refuse("the file lies outside the scene's folder");
    const auto is_it = [&](const fs::path& open) {
      std::error_code error;
      return fs::equivalent(open, path, error);
    };
    if (std::any_of(stack_.begin(), stack_.end(), is_it)) refuse("the file includes itself");
    const std::string_view directive = builder_.directive();
    try {
      read_file(path);
    } catch (const InputError& e) {
      refuse(e.what());
    }
    builder_.begin(directive);
  }

  // Beside the file that includes it, else beside the scene.
  fs::path find(std::string_view name) const {
    for (const fs::path& beside : {stack_.back().parent_path(), main_.parent_path()}) {
      const fs::path path = beside / fs::path(name);
      std::error_code error;
      if (fs::is_regular_file(path, error)) return path;
    }
    return {};
  }

  bool lies_in_folder(const fs::path& path) const {
    const fs::path whole = fs::weakly_canonical(path);
    return std::mismatch(folder_.begin(), folder_.end(), whole.begin(), whole.end()).first == folder_.end();
  }

  SourceFile& load(const fs::path& path) {
    std::unique_ptr<SourceFile>& file = files_[path.string()];
    if (!file) {
      file = std::make_unique<SourceFile>();
      order_.push_back(file.get());
      file->name = printable(path.string());
      const std::size_t most = std::min<std::uint64_t>(options_.max_bytes, options_.max_memory);
      file->text = read_text(path.string(), most - std::min(most, bytes_));
      bytes_ += file->text.size();
    }
    return *file;
  }

  std::vector<std::string> files_read() const {
    std::vector<std::string> paths;
    for (const auto& [path, file] : files_)
      if (!is_alone_) paths.push_back(path);
    return paths;
  }

  std::string report() const {
    std::string all;
    for (const SourceFile* file : order_)
      if (file->diagnostics.has_errors()) all += report_of(file->diagnostics, file->name, file->text);
    while (all.ends_with('\n')) all.pop_back();
    return all;
  }

  std::string warnings() const {
    std::string all;
    for (const SourceFile* file : order_) all += report_of(file->diagnostics, file->name, file->text);
    return all;
  }

  const AffOptions& options_;
  fs::path main_, folder_;
  SceneBuilder builder_;
  std::map<std::string, std::unique_ptr<SourceFile>> files_;
  std::vector<SourceFile*> order_;  // as they were read first
  std::vector<fs::path> stack_;     // of open files
  std::size_t reads_ = 0, bytes_ = 0;
  bool is_alone_ = false;
};

}  // namespace
}  // namespace aff

ParsedScene parse_aff(std::string_view text, std::string_view file_name, const AffOptions& options) {
  aff::Reader reader{std::string(file_name), options};
  reader.give(text);
  return reader.read();
}

ParsedScene read_aff(const std::string& path, const AffOptions& options) {
  return aff::Reader(path, options).read();
}

}  // namespace pprt
