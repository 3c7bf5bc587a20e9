#include "live/steering.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <utility>
#include <variant>

#include "live/frame_header.h"
#include "scene/writers/anim_writer.h"

namespace pprt {
namespace {

using Json = nlohmann::json;

// Names of files may hold any bytes.
std::string text_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json json_of_key(const CameraKey& key) {
  View view;
  view.from = key.from, view.at = key.at, view.up = key.up, view.angle_degrees = key.angle_degrees;
  return {{"frame", static_cast<int>(key.frame)}, {"view", json_of(view)}};
}

bool same_camera(const View& a, const View& b) {
  return a.from == b.from && a.at == b.at && a.up == b.up && a.angle_degrees == b.angle_degrees;
}

// The size stays.
void set_camera(View& view, const View& camera) {
  view.from = camera.from;
  view.at = camera.at;
  view.up = camera.up;
  view.angle_degrees = camera.angle_degrees;
}

// What the show refuses is told to who asked for it.
template <typename Require, typename... Values>
void require(const Require& accepts, const Values&... values) try {
  accepts(values...);
} catch (const std::exception& e) {
  throw CommandError(e.what());
}

}  // namespace

Steering::Steering(LiveShow show, LiveVoice voice)
    : show_(std::move(show)),
      voice_(std::move(voice)),
      run_{.width = show_.home.width,
           .height = show_.home.height,
           .frames_per_second = show_.frames_per_second},
      run_now_(run_),
      plays_(!show_.script.empty()),
      seen_(show_.script.size()),
      view_(show_.home) {}

// --- Clients

void Steering::joined(int client) {
  const std::lock_guard lock(mutex_);
  clients_.insert(client);
  changed_.notify_all();
  Json hello = {{"you", client},
                {"title", show_.title},
                {"home", json_of(show_.home)},
                {"size", {show_.home.width, show_.home.height}},
                {"rates", {kSlowestRate, kFastestRate}},
                {"longest_side", kLongestLiveSide},
                {"fixed_size", show_.records},
                {"moves", show_.moves},
                {"ranks", show_.ranks}};
  if (show_.bounds) {
    const Vec3d &least = show_.bounds->min, &most = show_.bounds->max;
    hello["bounds"] = {{least.x, least.y, least.z}, {most.x, most.y, most.z}};
  }
  for (const Word<Overlay>& overlay : kWords<Overlay>) hello["overlays"].push_back(overlay.word);
  voice_.tell(client, text_of({{"hello", std::move(hello)}}));
  voice_.tell(client, film_text());
  voice_.tell_all(state());
}

void Steering::left(int client) {
  const std::lock_guard lock(mutex_);
  clients_.erase(client);
  if (run_.photo_for == client) run_.photo.reset();
  if (pilot_ == client) {
    pilot_ = 0;
    if (show_.records) give_back();
  }
  voice_.tell_all(state());
}

void Steering::said(int client, std::string_view text) {
  const std::lock_guard lock(mutex_);
  try {
    const LiveCommand command = parse_command(text);
    if (!std::holds_alternative<TakeCamera>(command) && pilot_ != client)
      throw CommandError("take the camera first");
    std::visit([&](const auto& what) { obey(client, what); }, command);
    // Cameras come many times a second, and frames tell of them.
    if (!std::holds_alternative<LookFrom>(command)) voice_.tell_all(state());
  } catch (const CommandError& e) {
    voice_.tell(client, text_of({{"error", e.what()}}));
  }
}

bool Steering::is_watched() const {
  const std::lock_guard lock(mutex_);
  return !clients_.empty();
}

// --- Commands

// Something changes the picture.
void Steering::note_change() {
  ++change_;
  changed_.notify_all();
}

void Steering::obey(int client, const TakeCamera&) {
  if (pilot_ != 0 && pilot_ != client)
    throw CommandError(fmt::format("viewer number {} has the camera", pilot_));
  pilot_ = client;
  if (rolls() && plays_) {
    is_by_hand_ = true;  // the camera stands still
  } else {
    plays_ = false;
  }
  look_ = 0;
}

void Steering::obey(int, const GiveCamera&) {
  pilot_ = 0;
  give_back();
}

// The script goes on where it was left, or with a frame that nobody has seen and that is to be recorded.
void Steering::give_back() {
  if (plays_film_) obey(pilot_, PlayFilm{false});
  if (position_ >= frames()) {
    if (const std::optional<int> unseen = first_unseen()) {
      jump_to(*unseen - 1);
    } else if (loops()) {
      jump_to(0);
    }
  }
  plays_ = position_ < frames();
  if (!plays_) return;
  leave_hand();
  note_change();
}

// What plays has the camera from now on.
void Steering::leave_hand() {
  if (std::exchange(is_by_hand_, false)) jumps_ = true;
}

void Steering::obey(int, const PassCamera& command) {
  if (!clients_.contains(command.to))
    throw CommandError(fmt::format("there is no viewer number {}", command.to));
  pilot_ = command.to;
  look_ = 0;
}

void Steering::obey(int, const LookFrom& command) {
  View view = view_;
  set_camera(view, command.view);
  require(show_.require_camera, view);
  view_ = view;
  if (!rolls()) plays_ = false;
  is_by_hand_ = true;
  look_ = command.number;
  note_change();
}

void Steering::obey(int, const PlayScript& command) {
  if (frames() == 0) throw CommandError("there is no script to play");
  plays_ = command.on;
  if (!plays_) return;
  if (!rolls()) leave_hand();
  if (position_ >= frames()) jump_to(0);
  note_change();
}

void Steering::obey(int, const StepScript& command) {
  const std::int64_t to = std::int64_t{position_} + command.by;
  show_position(static_cast<int>(std::clamp<std::int64_t>(to, 1, std::max(1, line()))));
}

void Steering::obey(int, const SeekScript& command) {
  show_position(std::clamp(command.frame, 1, std::max(1, line())));
}

void Steering::obey(int, const SetRate& command) {
  run_.frames_per_second = command.frames_per_second;
  note_change();
  voice_.tell_all(film_text());
}

void Steering::obey(int, const SetSize& command) {
  if (show_.records) throw CommandError("files are written: the size stays");
  require(show_.require_size, command.width, command.height);
  run_.width = command.width;
  run_.height = command.height;
  note_change();
  voice_.tell_all(film_text());
}

void Steering::obey(int, const ShowOverlay& command) {
  overlay_ = command.overlay;
  note_change();
}

void Steering::obey(int client, const FindPivot& command) {
  const double x = command.x * run_now_.width, y = command.y * run_now_.height;
  View view = view_;
  view.width = run_now_.width, view.height = run_now_.height;
  const std::optional<Vec3d> seen = show_.seen_at(view, x, y, moment());
  if (!seen) throw CommandError("there is nothing to turn round");
  voice_.tell(client, text_of({{"pivot", {seen->x, seen->y, seen->z}}}));
}

void Steering::obey(int, const SetKey& command) {
  if (command.view) require(show_.require_camera, *command.view);
  if (!keys_.set(command.frame, command.view.value_or(view_))) {
    throw CommandError(fmt::format("a film has at most {} keys", FilmKeys::kMost));
  }
  keys_changed();
}

void Steering::obey(int, const DropKey& command) {
  if (!keys_.drop(command.frame))
    throw CommandError(fmt::format("there is no key at frame {}", command.frame));
  keys_changed();
}

void Steering::obey(int, const MoveKey& command) {
  if (!keys_.move(command.frame, command.to))
    throw CommandError(fmt::format("there is no key at frame {}", command.frame));
  keys_changed();
}

void Steering::obey(int, const UndoKeys&) {
  if (!keys_.undo()) throw CommandError("there is nothing to undo");
  keys_changed();
}

void Steering::obey(int, const RedoKeys&) {
  if (!keys_.redo()) throw CommandError("there is nothing to do again");
  keys_changed();
}

// The script is left where it is until it takes its place again.
void Steering::obey(int, const PlayFilm& command) {
  if (command.on && keys_.keys().empty()) throw CommandError("the film has no key yet");
  if (command.on == plays_film_) return;
  if (command.on) script_position_ = position_;
  plays_film_ = command.on;
  plays_ = false;
  is_by_hand_ = true;  // until the film, or the script, plays
  jump_to(command.on ? 0 : script_position_);
}

void Steering::obey(int client, const TakePhoto& command) {
  run_.photo = command.format;
  run_.photo_for = client;
  note_change();
}

// What plays goes on after this position.
void Steering::jump_to(int position) {
  position_ = position;
  jumps_ = true;
}

void Steering::show_position(int position) {
  if (frames() == 0) throw CommandError("there is no script to play");
  plays_ = false;
  jumps_ = jumps_ || position != position_ + 1;
  position_ = position;
  if (!rolls()) leave_hand();
  if (!is_by_hand_) set_camera(view_, frame_at(position_).view);
  note_change();
}

void Steering::keys_changed() {
  voice_.tell_all(film_text());
  if (!plays_film_) return;
  if (keys_.keys().empty()) return obey(pilot_, PlayFilm{false});
  position_ = std::min(position_, plays_ ? frames() : line());
  plays_ = plays_ && position_ < frames();
}

// --- What plays

int Steering::frames() const {
  return plays_film_ ? film().frames : static_cast<int>(show_.script.size());
}

// The last position that can be shown: behind a film there is room for the next key.
int Steering::line() const {
  constexpr double kRoom_s = 2;
  if (show_.moves || !(plays_film_ || show_.script.empty())) return frames();
  return std::min(kLastKeyFrame, film().frames + static_cast<int>(kRoom_s * run_.frames_per_second));
}

// A film lasts as long as what moves in it.
int Steering::moment() const {
  const int last = static_cast<int>(show_.script.size());
  if (position_ == 0 || last == 0) return 0;
  return show_.script[static_cast<std::size_t>(std::min(position_, last) - 1)].number;
}

// The first position that is still to be recorded.
std::optional<int> Steering::first_unseen() const {
  const auto unseen = std::find(seen_.begin(), seen_.end(), false);
  if (!show_.records || unseen == seen_.end()) return std::nullopt;
  return static_cast<int>(unseen - seen_.begin()) + 1;
}

ScriptFrame Steering::frame_at(int position) const {
  if (!plays_film_) return show_.script[static_cast<std::size_t>(position - 1)];
  return {.number = 0, .view = view_at(film(), position, show_.home), .cut = false};
}

// Before its first key the camera stands still.
Animation Steering::film() const {
  Animation film;
  film.scene = show_.scene_name;
  film.frames = std::max({1, keys_.frames(), show_.moves ? static_cast<int>(show_.script.size()) : 0});
  film.fps = run_.frames_per_second;
  film.width = run_.width;
  film.height = run_.height;
  film.keys = keys_.keys();
  film.objects = show_.objects;
  film.daylight = show_.daylight;
  return film;
}

// --- Frames

bool Steering::wants_frames() const {
  return change_ != finished_change_ && (show_.records || !clients_.empty());
}

bool Steering::wait_for_change(double at_most_s) {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, std::chrono::duration<double>(at_most_s), [this] { return wants_frames(); });
}

// A script whose camera stands still goes on.
void Steering::rest(std::uint64_t change) {
  const std::lock_guard lock(mutex_);
  if (!plays_) finished_change_ = change;
}

LiveRun Steering::next_run() {
  const std::lock_guard lock(mutex_);
  const bool was_photo = run_now_.photo.has_value();
  if (was_photo) run_.photo.reset();
  run_now_ = run_;
  run_now_.view = view_;
  if (was_photo) voice_.tell_all(state());
  jumps_ = true;
  return run_now_;
}

bool Steering::awaits_photo() const {
  const std::lock_guard lock(mutex_);
  return run_.photo.has_value();
}

std::optional<LiveShot> Steering::next_shot() {
  const std::lock_guard lock(mutex_);
  if (!(run_ == run_now_) || !wants_frames()) return std::nullopt;
  LiveShot shot;
  bool cut = false;
  if (plays_) {
    const ScriptFrame frame = frame_at(++position_);
    cut = !is_by_hand_ && frame.cut;
    if (!is_by_hand_) set_camera(view_, frame.view);
  }
  if (!is_by_hand_ && !plays_film_ && position_ > 0) {
    shot.script_frame = frame_at(position_).number;
    seen_[static_cast<std::size_t>(position_ - 1)] = true;
  }
  shot.view = view_;
  shot.view.width = run_now_.width;
  shot.view.height = run_now_.height;
  shot.moment = moment();
  shot.position = position_;
  shot.by_hand = is_by_hand_;
  shot.cut = std::exchange(jumps_, false) || cut;
  if (camera_ == 0 || !same_camera(shot.view, shown_)) ++camera_;
  shown_ = shot.view;
  shot.camera = camera_;
  shot.look = look_;
  shot.pilot = pilot_;
  shot.overlay = overlay_;
  shot.change = change_;
  if (plays_ && position_ >= frames()) end_of_play();
  return shot;
}

// Begins again, or stops.
void Steering::end_of_play() {
  const std::optional<int> unseen = plays_film_ ? std::nullopt : first_unseen();
  if (unseen || loops()) return jump_to(unseen.value_or(1) - 1);
  plays_ = false;
  voice_.tell_all(state());
}

bool Steering::is_played_out() const {
  const std::lock_guard lock(mutex_);
  return pilot_ == 0 && !plays_;
}

std::string Steering::state() const {
  Json keys = Json::array();
  for (const CameraKey& key : keys_.keys()) keys.push_back(static_cast<int>(key.frame));
  return text_of({{"state",
                   {{"pilot", pilot_},
                    {"viewers", clients_},
                    {"plays", plays_},
                    {"frames", frames()},
                    {"line", line()},
                    {"film", plays_film_},
                    {"rate", run_.frames_per_second},
                    {"size", {run_.width, run_.height}},
                    {"overlay", word_for(overlay_)},
                    {"keys", std::move(keys)},
                    {"undo", keys_.can_undo()},
                    {"redo", keys_.can_redo()},
                    {"photo", run_.photo.has_value()}}}});
}

// The keys and the script of the film, for pages to keep. Texts of files' names may hold any bytes.
std::string Steering::film_text() const {
  Json keys = Json::array();
  for (const CameraKey& key : keys_.keys()) keys.push_back(json_of_key(key));
  return text_of({{"film", {{"keys", std::move(keys)}, {"script", anim_script(film())}}}});
}

}  // namespace pprt
