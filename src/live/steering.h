// Who has the camera, and what the next frame shows.
//
// A script plays, or the picture rests. Where something else than the camera moves, the script plays again
// and again, and goes on while the camera is moved by hand. One client at a time may take the camera: the
// pilot. The pilot moves it by hand, plays the script or steps through it, sets rate and size, and records
// keys of a film. All others watch.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "live/command.h"
#include "live/film_keys.h"
#include "scene/animation/animation.h"
#include "scene/description/scene_description.h"

namespace pprt {

// One frame of a script.
struct ScriptFrame {
  int number = 1;
  View view = {};
  bool cut = false;
};

// What there is to show.
struct LiveShow {
  std::string title;                           // of the scene, for people
  std::optional<std::string> scene_name = {};  // as a script names the scene; empty: no script can
  std::vector<ObjectMotion> objects = {};      // that a script moves, named as there
  Daylight daylight = {};                      // of a script
  View home = {};                              // what is shown first; its size is that of the pictures
  std::vector<ScriptFrame> script = {};        // empty: there is none
  double frames_per_second = 24;               // between kSlowestRate and kFastestRate
  bool moves = false;                          // something besides the camera, as the script goes on
  std::optional<Box3d> bounds = {};            // of what there is to see
  int ranks = 1;
  // Every frame of the script is to be shown once, whether or not anybody watches; pictures keep their size.
  bool records = false;
  // Throw std::exception for a view, or a size, that cannot be rendered.
  std::function<void(const View&)> require_camera = [](const View&) {};
  std::function<void(int width, int height)> require_size = [](int, int) {};
  // Returns what the camera sees at an image point, pixels, as it stands in that frame of the script; 0: as
  // it began. Empty: the background.
  std::function<std::optional<Vec3d>(const View&, double x, double y, int moment)> seen_at =
      [](const View&, double, double, int) { return std::nullopt; };
};

// A frame to be rendered.
struct LiveShot {
  View view = {};
  int script_frame = 0;      // number; 0: by hand, or of the recorded film
  int moment = 0;            // number of the frame of the script in which what moves stands so; 0: none yet
  int position = 0;          // in what plays, from 1; 0: nothing has played
  bool by_hand = false;      // the camera is the pilot's
  bool cut = false;          // it does not follow the shot before
  std::uint32_t camera = 0;  // counts the cameras shown
  std::uint32_t look = 0;    // the number of the pilot's last LookFrom
  int pilot = 0;             // client; 0: nobody
  Overlay overlay = Overlay::kNone;
  std::uint64_t change = 0;  // counts what changed the picture, for rest()
};

// Settings that hold for a run of frames; others need a new one.
struct LiveRun {
  int width = 0, height = 0;
  double frames_per_second = 0;
  std::optional<PhotoFormat> photo = {};  // one picture at full quality, for `photo_for`
  int photo_for = 0;                      // client
  View view = {};                         // of the photo

  friend bool operator==(const LiveRun& a, const LiveRun& b) {
    return a.width == b.width && a.height == b.height && a.frames_per_second == b.frames_per_second &&
           a.photo == b.photo;
  }
};

// What is said to clients.
struct LiveVoice {
  std::function<void(int client, std::string text)> tell;
  std::function<void(std::string text)> tell_all;
};

// Any thread may call anything.
class Steering {
 public:
  Steering(LiveShow show, LiveVoice voice);

  // --- Clients

  // Tells a new client who it is and what there is.
  void joined(int client);

  // The camera of a pilot who has left stands still, for he may come back. Where frames are recorded it goes
  // back to the script.
  void left(int client);

  // Does what a client asks for. What is no command, or not allowed, is answered by {"error":TEXT}.
  void said(int client, std::string_view text);

  bool is_watched() const;

  // --- Frames

  // Waits until a frame is wanted, at most so many seconds. None is while a picture is finished, or while
  // nobody watches, unless frames are recorded.
  bool wait_for_change(double at_most_s);

  // What the next run of frames is like. A photo is over when this is asked again.
  LiveRun next_run();

  // Whether the client for whom a photo is being made is still there.
  bool awaits_photo() const;

  // The next frame's camera; empty: another run is wanted, or none.
  std::optional<LiveShot> next_shot();

  // The picture of a shot with this `change` is finished. Frames are wanted again once something changes it.
  void rest(std::uint64_t change);

  // Whether nothing plays and nobody has the camera.
  bool is_played_out() const;

 private:
  void obey(int client, const TakeCamera&);
  void obey(int client, const GiveCamera&);
  void obey(int client, const PassCamera& command);
  void obey(int client, const LookFrom& command);
  void obey(int client, const PlayScript& command);
  void obey(int client, const StepScript& command);
  void obey(int client, const SeekScript& command);
  void obey(int client, const SetRate& command);
  void obey(int client, const SetSize& command);
  void obey(int client, const ShowOverlay& command);
  void obey(int client, const FindPivot& command);
  void obey(int client, const SetKey& command);
  void obey(int client, const DropKey& command);
  void obey(int client, const MoveKey& command);
  void obey(int client, const UndoKeys&);
  void obey(int client, const RedoKeys&);
  void obey(int client, const PlayFilm& command);
  void obey(int client, const TakePhoto& command);
  void note_change();
  void give_back();
  void leave_hand();
  void jump_to(int position);
  void end_of_play();
  void show_position(int position);
  void keys_changed();
  std::optional<int> first_unseen() const;
  bool rolls() const { return show_.moves && !plays_film_; }
  bool loops() const { return show_.moves && !show_.records; }
  int frames() const;
  int line() const;
  int moment() const;
  ScriptFrame frame_at(int position) const;
  Animation film() const;
  std::string state() const;
  std::string film_text() const;
  bool wants_frames() const;

  const LiveShow show_;
  const LiveVoice voice_;

  std::condition_variable changed_;  // frames may be wanted
  mutable std::mutex mutex_;         // guards what follows
  std::set<int> clients_;
  int pilot_ = 0;
  LiveRun run_;                        // as wanted
  LiveRun run_now_;                    // as it is
  std::uint64_t change_ = 1;           // counts what changed the picture
  std::uint64_t finished_change_ = 0;  // whose picture is finished
  bool plays_ = false;                 // the script or the film
  bool plays_film_ = false;            // the film takes the script's place
  int position_ = 0;                   // in what plays: shown last, from 1; 0: nothing yet
  int script_position_ = 0;            // while the film takes its place
  std::vector<bool> seen_;             // frames of the script
  bool is_by_hand_ = false;            // the view is the pilot's
  bool jumps_ = true;                  // the next shot does not follow the one before
  View view_;                          // wanted next, unless something plays
  View shown_;                         // last
  std::uint32_t camera_ = 0, look_ = 0;
  Overlay overlay_ = Overlay::kNone;
  FilmKeys keys_;
};

}  // namespace pprt
