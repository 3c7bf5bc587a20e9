#include "parser/anim/anim_actions.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>

#include "base/nearest_word.h"
#include "parser/text/text_input.h"

namespace pprt::anim {
namespace {

constexpr int kMaxNesting = 100;            // levels of operands; each takes some 2 kB of the call stack
constexpr std::size_t kMostKeys = 100'000;  // key, hold and cut statements
constexpr std::size_t kMostObjects = 10'000;
constexpr std::size_t kMostSuns = 1'000;
constexpr std::size_t kMostNames = 100'000;  // declared names

// The keywords of statements and the block of each. The fields come last.
struct Word {
  std::string_view text;
  Block block;
};
constexpr Word kWords[] = {
    {"#declare", Block::kTop},
    {"#version", Block::kTop},
    {"animation", Block::kTop},
    {"scene", Block::kAnimation},
    {"frames", Block::kAnimation},
    {"fps", Block::kAnimation},
    {"camera", Block::kAnimation},
    {"resolution", Block::kAnimation},
    {"spline", Block::kCamera},
    {"key", Block::kCamera},
    {"hold", Block::kCamera},
    {"cut", Block::kCamera},
    {"from", Block::kKey},
    {"at", Block::kKey},
    {"up", Block::kKey},
    {"angle", Block::kKey},
    {"tension", Block::kKey},
    {"continuity", Block::kKey},
    {"bias", Block::kKey},
    {"ease_in", Block::kKey},
    {"ease_out", Block::kKey},
    {"object", Block::kAnimation},
    {"translate", Block::kObjectKey},
    {"rotate", Block::kObjectKey},
    {"scale", Block::kObjectKey},
    {"visible", Block::kObjectKey},
    {"sun", Block::kAnimation},
    {"sky", Block::kAnimation},
    {"color", Block::kLight},
    {"horizon", Block::kLight},
    {"zenith", Block::kLight},
};

constexpr std::string_view name_of(Block block) {
  switch (block) {
    case Block::kTop:
      return "the script itself";
    case Block::kAnimation:
      return "animation { ... }";
    case Block::kCamera:
      return "camera { ... }";
    case Block::kKey:
      return "a key's { ... }";
    case Block::kObject:
      return "object { ... }";
    case Block::kObjectKey:
      return "the { ... } of an object's key";
    case Block::kLight:
      return "the { ... } of a sun or sky";
  }
  return {};
}

// Returns the keywords of a block first, then all others: the former are likelier suggestions.
std::vector<std::string_view> candidates_in(Block block) {
  std::vector<std::string_view> words;
  for (const Word& word : kWords) {
    if (word.block == block) words.push_back(word.text);
  }
  for (const Word& word : kWords) {
    if (word.block != block) words.push_back(word.text);
  }
  return words;
}

bool is_name_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

constexpr FieldOwner kOwners[] = {FieldOwner::kCamera, FieldOwner::kObject, FieldOwner::kSun,
                                  FieldOwner::kSky};

constexpr std::string_view name_of(FieldOwner owner) {
  switch (owner) {
    case FieldOwner::kCamera:
      return "the camera's";
    case FieldOwner::kObject:
      return "an object's";
    case FieldOwner::kSun:
      return "a sun's";
    case FieldOwner::kSky:
      return "the sky's";
  }
  return {};
}

std::string_view leading_name(std::string_view text) {
  const auto end = std::find_if_not(text.begin(), text.end(), is_name_letter);
  return text.substr(0, static_cast<std::size_t>(end - text.begin()));
}

}  // namespace

std::string found_at(const char* place, const char* end) {
  const std::string_view rest(place, static_cast<std::size_t>(end - place));
  if (rest.empty()) return "the end of the script";
  const std::string_view name = leading_name(rest);
  return quoted(name.empty() ? rest.substr(0, 1) : name);
}

Value ScriptReader::take() {
  const Value value = stack_.back();
  stack_.pop_back();
  return value;
}

void ScriptReader::given_twice(std::string_view word) {
  problems_.error(setting_, fmt::format("'{}' is given twice", word));
}

void ScriptReader::push_number(std::string_view token) {
  Value value{1, {}, token.data()};
  if (!scan_number(token.data(), token.data() + token.size(), value.c[0])) {
    problems_.error(token.data(), "the number is too large");
    value.size = 0;
  }
  stack_.push_back(value);
}

void ScriptReader::push_variable(std::string_view name) {
  Value value;
  if (const auto found = names_.find(name); found != names_.end()) {
    value = found->second;
  } else if (name == "pi") {
    value = {1, {std::numbers::pi, 0, 0}, nullptr};
  } else if (is_function(name)) {
    problems_.error(name.data(), fmt::format("'{}' is a function: expected '(' after it", name));
  } else {
    std::vector<std::string_view> known(built_in_names().begin(), built_in_names().end());
    for (const auto& [declared, ignored] : names_) known.push_back(declared);
    problems_.error(name.data(), fmt::format("unknown name {}{}", quoted(name), did_you_mean(name, known)));
  }
  value.place = name.data();
  stack_.push_back(value);
}

void ScriptReader::calculate_top(Operation operation, const char* place) {
  const Value b = take();
  const Value a = take();
  stack_.push_back(calculate(operation, a, b, place, problems_));
}

void ScriptReader::negate_top(const char* place) {
  stack_.back() = negated(stack_.back());
  stack_.back().place = place;
}

void ScriptReader::join_two(const char* place) {
  const Value y = take();
  const Value x = take();
  Value joined{2, {x.c[0], y.c[0], 0}, place};
  for (const Value& component : {x, y}) {
    if (component.size > 1) problems_.error(component.place, "a component of a vector is a number");
    if (component.size != 1) joined.size = 0;
  }
  stack_.push_back(joined);
}

void ScriptReader::append_third(const char*) {
  const Value z = take();
  Value& vector = stack_.back();
  if (z.size > 1) problems_.error(z.place, "a component of a vector is a number");
  vector.c[2] = z.c[0];
  vector.size = vector.size == 2 && z.size == 1 ? 3 : 0;
}

void ScriptReader::begin_call(std::string_view callee) {
  calls_.push_back({leading_name(callee), stack_.size()});
}

void ScriptReader::end_call() {
  const Call call = calls_.back();
  calls_.pop_back();
  const std::span<const Value> arguments = std::span(stack_).subspan(call.first_argument);
  const Value result = call_function(call.name, arguments, call.name.data(), problems_);
  stack_.resize(call.first_argument);
  stack_.push_back(result);
}

void ScriptReader::enter_operand(const char* place) {
  if (++depth_ > kMaxNesting) {
    throw ParseFailure{place, fmt::format("the expression nests deeper than {} levels", kMaxNesting)};
  }
}

void ScriptReader::declare() {
  const Value value = take();
  if (names_.size() >= kMostNames)
    throw ParseFailure{declared_.data(), fmt::format("more than {} names", kMostNames), true};
  names_.insert_or_assign(std::string(declared_), value);
  declared_ = {};
}

void ScriptReader::check_version() {
  const Value value = take();
  const std::optional<double> version = number(value, "#version", problems_);
  if (version && *version != kScriptVersion) {
    problems_.error(value.place,
                    fmt::format("this is a script of version {}; version {} is the one that can be read",
                                *version, kScriptVersion));
  }
}

void ScriptReader::begin_animation(const char* place) {
  owner_ = FieldOwner::kCamera;
  if (script_.has_animation) problems_.error(place, "a script has one animation");
  script_.has_animation = true;
}

void ScriptReader::begin_camera(const char* place) {
  owner_ = FieldOwner::kCamera;
  if (script_.has_camera) problems_.error(place, "an animation has one camera");
  script_.has_camera = true;
}

void ScriptReader::begin_object(std::string_view name) {
  if (script_.objects.size() >= kMostObjects)
    throw ParseFailure{name.data(), fmt::format("more than {} objects", kMostObjects), true};
  script_.objects.push_back({.name = std::string(name), .place = name.data(), .keys = {}});
  owner_ = FieldOwner::kObject;
}

void ScriptReader::begin_light(FieldOwner owner, const char* place) {
  owner_ = owner;
  begin_key(WrittenKey::Kind::kKey, place);
}

void ScriptReader::end_sun() {
  if (script_.suns.size() >= kMostSuns)
    throw ParseFailure{key_.place, fmt::format("more than {} suns", kMostSuns), true};
  script_.suns.push_back(key_);
  owner_ = FieldOwner::kCamera;
}

void ScriptReader::end_sky() {
  if (script_.sky) problems_.error(key_.place, "'sky' is given twice");
  script_.sky = key_;
  owner_ = FieldOwner::kCamera;
}

void ScriptReader::begin_key(WrittenKey::Kind kind, const char* place) {
  key_ = {};
  key_.kind = kind;
  key_.place = place;
}

void ScriptReader::set_when() {
  key_.when = take();
}

void ScriptReader::begin_field(std::string_view word) {
  field_ =
      static_cast<std::size_t>(std::find(kFieldWords.begin(), kFieldWords.end(), word) - kFieldWords.begin());
  field_place_ = word.data();
}

void ScriptReader::set_field() {
  std::optional<Value>& field = key_.fields[field_];
  if (field)
    problems_.error(field_place_, fmt::format("'{}' is given twice in this key", kFieldWords[field_]));
  field = take();
  const auto which = static_cast<Field>(field_);
  if (is_of(owner_, which)) return;
  const auto* owner =
      std::find_if(std::begin(kOwners), std::end(kOwners), [&](FieldOwner o) { return is_of(o, which); });
  problems_.error(field_place_,
                  fmt::format("'{}' is {}, not {}", kFieldWords[field_], name_of(*owner), name_of(owner_)));
}

void ScriptReader::end_key() {
  if (keys_++ >= kMostKeys) throw ParseFailure{key_.place, fmt::format("more than {} keys", kMostKeys), true};
  (owner_ == FieldOwner::kObject ? script_.objects.back().keys : script_.keys).push_back(key_);
}

void ScriptReader::set_scene(std::string_view name) {
  set(script_.scene, "scene", std::string(name));
  script_.scene_place = setting_;
}

void ScriptReader::set_spline(std::string_view kind) {
  constexpr std::array<std::string_view, 3> kKinds = {"linear", "catmull_rom",
                                                      "tcb"};  // in the order of SplineKind
  const auto found = std::find(kKinds.begin(), kKinds.end(), kind);
  if (found == kKinds.end()) {
    problems_.error(kind.data(), fmt::format("expected linear, catmull_rom or tcb, found {}{}", quoted(kind),
                                             did_you_mean(kind, kKinds)));
  }
  set(script_.spline, "spline",
      found == kKinds.end() ? SplineKind::kTcb : static_cast<SplineKind>(found - kKinds.begin()));
}

void ScriptReader::unknown(std::string_view token, Block block) {
  const std::string_view name = leading_name(token);
  if (name.empty() || (name[0] >= '0' && name[0] <= '9')) {
    problems_.error(token.data(), fmt::format("did not expect {} in {}", quoted(token), name_of(block)));
    return;
  }
  const auto known =
      std::find_if(std::begin(kWords), std::end(kWords), [&](const Word& w) { return w.text == name; });
  if (known != std::end(kWords)) {
    problems_.error(token.data(),
                    fmt::format("'{}' stands in {}, not in {}", name, name_of(known->block), name_of(block)));
    return;
  }
  problems_.error(token.data(),
                  fmt::format("unknown word {}{}", quoted(name), did_you_mean(name, candidates_in(block))));
}

void ScriptReader::recover(const ParseFailure& failure) {
  if (failure.fatal) throw failure;
  problems_.error(failure.place, failure.message);
  // Declares the name all the same, so that its uses are not reported as unknown.
  if (!declared_.empty()) names_.insert_or_assign(std::string(declared_), Value{});
  declared_ = {};
  stack_.clear();
  calls_.clear();
  depth_ = 0;
}

}  // namespace pprt::anim
