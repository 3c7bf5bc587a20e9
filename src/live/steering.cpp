#include "live/steering.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <utility>
#include <variant>

#include "live/frame_header.h"
#include "scene/anim_writer.h"

namespace pprt {
namespace {

using Json = nlohmann::json;

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

CameraKey key_of(const View& view, int frame) {
  CameraKey key;
  key.frame = frame;
  key.from = view.from;
  key.at = view.at;
  key.up = view.up;
  key.angle_degrees = view.angle_degrees;
  return key;
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
      view_(show_.home) {}

// --- Clients

void Steering::joined(int client) {
  const std::lock_guard lock(mutex_);
  clients_.insert(client);
  wish_.notify_all();
  Json hello = {{"you", client},
                {"title", show_.title},
                {"script", !show_.script.empty()},
                {"home", json_of(show_.home)},
                {"rates", {kSlowestRate, kFastestRate}},
                {"longest_side", kLongestLiveSide},
                {"fixed_size", show_.fixed_size}};
  for (const Word<Overlay>& overlay : kWords<Overlay>) hello["overlays"].push_back(overlay.word);
  voice_.tell(client, Json{{"hello", std::move(hello)}}.dump());
  voice_.tell_all(state());
}

// The picture stays as it is: who has lost the connection may come back.
void Steering::left(int client) {
  const std::lock_guard lock(mutex_);
  clients_.erase(client);
  if (pilot_ == client) pilot_ = 0;
  voice_.tell_all(state());
}

void Steering::said(int client, std::string_view text) {
  const std::lock_guard lock(mutex_);
  try {
    const LiveCommand command = parse_command(text);
    const bool is_taking = std::holds_alternative<TakeCamera>(command);
    if (!is_taking && pilot_ != client) throw CommandError("take the camera first");
    std::visit([&](const auto& what) { obey(client, what); }, command);
    is_finished_ = false;
    wish_.notify_all();
    // Cameras come many times a second, and frames tell of them.
    if (!std::holds_alternative<LookFrom>(command)) voice_.tell_all(state());
  } catch (const CommandError& e) {
    voice_.tell(client, Json{{"error", e.what()}}.dump(-1, ' ', false, Json::error_handler_t::replace));
  }
}

bool Steering::is_watched() const {
  const std::lock_guard lock(mutex_);
  return !clients_.empty();
}

void Steering::obey(int client, const TakeCamera&) {
  if (pilot_ != 0 && pilot_ != client)
    throw CommandError(fmt::format("viewer number {} has the camera", pilot_));
  pilot_ = client;
  plays_ = false;
  look_ = 0;
}

// What there is to play goes on where it was left.
void Steering::obey(int, const GiveCamera&) {
  pilot_ = 0;
  plays_ = position_ < frames();
  if (plays_ && is_by_hand_) jumps_ = true;
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
  try {
    show_.require_camera(view);
  } catch (const std::exception& e) {
    throw CommandError(e.what());
  }
  view_ = view;
  plays_ = false;
  is_by_hand_ = true;
  look_ = command.number;
}

void Steering::obey(int, const PlayScript& command) {
  if (frames() == 0) throw CommandError("there is no script to play");
  plays_ = command.on;
  if (!plays_) return;
  if (is_by_hand_) jumps_ = true;
  if (position_ >= frames()) position_ = 0;
}

void Steering::obey(int, const StepScript& command) {
  const std::int64_t to = std::int64_t{position_} + command.by;
  go_to(static_cast<int>(std::clamp<std::int64_t>(to, 1, std::max(1, frames()))));
}

void Steering::obey(int, const SeekScript& command) {
  go_to(std::clamp(command.frame, 1, std::max(1, frames())));
}

void Steering::obey(int, const SetRate& command) {
  run_.frames_per_second = command.frames_per_second;
}

void Steering::obey(int, const SetSize& command) {
  if (show_.fixed_size) throw CommandError("files are written: the size stays");
  run_.width = command.width;
  run_.height = command.height;
}

void Steering::obey(int, const ShowOverlay& command) {
  overlay_ = command.overlay;
}

void Steering::obey(int, const SetKey& command) {
  std::vector<CameraKey> before = keys_;
  const auto is_there = [&](const CameraKey& key) { return key.frame == command.frame; };
  std::erase_if(keys_, is_there);
  const auto next = std::find_if(keys_.begin(), keys_.end(),
                                 [&](const CameraKey& key) { return key.frame > command.frame; });
  keys_.insert(next, key_of(view_, command.frame));
  keys_changed(std::move(before));
}

void Steering::obey(int, const DropKey& command) {
  std::vector<CameraKey> before = keys_;
  if (std::erase_if(keys_, [&](const CameraKey& key) { return key.frame == command.frame; }) == 0)
    throw CommandError(fmt::format("there is no key at frame {}", command.frame));
  keys_changed(std::move(before));
}

void Steering::obey(int, const UndoKeys&) {
  if (keys_before_.empty()) throw CommandError("there is nothing to undo");
  std::vector<CameraKey> before = std::move(keys_before_.back());
  keys_before_.pop_back();
  keys_changed(std::exchange(keys_, std::move(before)));
  keys_before_.pop_back();  // undoing is not undone
}

void Steering::obey(int, const PlayFilm& command) {
  if (command.on && keys_.empty()) throw CommandError("the film has no key yet");
  plays_film_ = command.on;
  plays_ = false;
  position_ = 0;
}

void Steering::obey(int client, const TakePhoto& command) {
  run_.photo = command.format;
  run_.photo_for = client;
}

void Steering::go_to(int position) {
  if (frames() == 0) throw CommandError("there is no script to play");
  plays_ = false;
  is_by_hand_ = false;
  jumps_ = jumps_ || position != position_ + 1;
  position_ = position;
  set_camera(view_, frame_at(position_).view);
}

// Keeps what was before for undo.
void Steering::keys_changed(std::vector<CameraKey> before) {
  constexpr std::size_t kMostKept = 200;
  if (keys_before_.size() == kMostKept) keys_before_.erase(keys_before_.begin());
  keys_before_.push_back(std::move(before));
  if (keys_.empty() && plays_film_) plays_film_ = plays_ = false, position_ = 0;
}

// --- What plays

int Steering::frames() const {
  if (plays_film_) return static_cast<int>(keys_.back().frame);
  return static_cast<int>(show_.script.size());
}

ScriptFrame Steering::frame_at(int position) const {
  if (!plays_film_) return show_.script[static_cast<std::size_t>(position - 1)];
  return {.number = 0, .view = view_at(film(), position, show_.home), .cut = false};
}

// Its first key stands at its first frame: before it the camera stands still.
Animation Steering::film() const {
  Animation film;
  film.scene = show_.scene_name;
  film.frames = keys_.empty() ? 1 : static_cast<int>(keys_.back().frame);
  film.fps = run_.frames_per_second;
  film.width = run_.width;
  film.height = run_.height;
  film.keys = keys_;
  return film;
}

// --- Frames

bool Steering::wants_frames() const {
  return run_.photo || (!is_finished_ && (show_.plays_unwatched || !clients_.empty()));
}

bool Steering::wait_for_wish(double at_most_s) {
  std::unique_lock lock(mutex_);
  return wish_.wait_for(lock, std::chrono::duration<double>(at_most_s), [this] { return wants_frames(); });
}

void Steering::rest() {
  const std::lock_guard lock(mutex_);
  is_finished_ = true;
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

std::optional<LiveShot> Steering::next_shot() {
  const std::lock_guard lock(mutex_);
  if (!(run_ == run_now_) || !wants_frames()) return std::nullopt;
  if (position_ >= frames()) plays_ = false;  // the film may have become shorter
  ScriptFrame frame;
  frame.number = 0;
  if (plays_) {
    is_by_hand_ = false;
    frame = frame_at(++position_);
  } else if (!is_by_hand_ && position_ > 0) {
    frame.number = plays_film_ || position_ > frames() ? 0 : frame_at(position_).number;
  }
  LiveShot shot;
  shot.view = plays_ ? frame.view : view_;
  shot.view.width = run_now_.width;
  shot.view.height = run_now_.height;
  shot.script_frame = frame.number;
  shot.position = is_by_hand_ ? 0 : position_;
  shot.cut = std::exchange(jumps_, false) || (plays_ && frame.cut);
  if (camera_ == 0 || !same_camera(shot.view, shown_)) ++camera_;
  view_ = shown_ = shot.view;
  shot.camera = camera_;
  shot.look = look_;
  shot.pilot = pilot_;
  shot.overlay = overlay_;
  if (plays_ && position_ >= frames()) {
    plays_ = false;
    voice_.tell_all(state());
  }
  return shot;
}

bool Steering::is_played_out() const {
  const std::lock_guard lock(mutex_);
  return pilot_ == 0 && !plays_ && position_ >= frames();
}

std::string Steering::state() const {
  Json keys = Json::array();
  for (const CameraKey& key : keys_) keys.push_back(static_cast<int>(key.frame));
  Json state = {{"pilot", pilot_},
                {"viewers", clients_},
                {"plays", plays_},
                {"frames", frames()},
                {"film", plays_film_},
                {"rate", run_.frames_per_second},
                {"size", {run_.width, run_.height}},
                {"overlay", word_for(overlay_)},
                {"keys", std::move(keys)},
                {"undo", !keys_before_.empty()},
                {"script", keys_.empty() ? std::string() : anim_script(film())},
                {"photo", run_.photo.has_value()}};
  return Json{{"state", std::move(state)}}.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace pprt
