// Who has the camera, and what the next frame shows.
//
// A script plays, or the picture rests. One client at a time may take the camera: the pilot. The pilot moves
// it by hand, plays the script or steps through it, sets rate and size, and records keys of a film. All
// others watch.
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
#include "scene/animation.h"
#include "scene/scene_description.h"

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
  View home = {};                              // what is shown first; its size is that of the pictures
  std::vector<ScriptFrame> script = {};        // empty: there is none
  double frames_per_second = 24;               // between kSlowestRate and kFastestRate
  bool fixed_size = false;                     // pictures keep their size
  bool plays_unwatched = false;                // else it waits for somebody to watch
  std::function<void(const View&)> require_camera = [](const View&) {};  // throws for a view that makes none
};

// A frame to be rendered.
struct LiveShot {
  View view = {};
  int script_frame = 0;      // number; 0: by hand, or of the recorded film
  int position = 0;          // in what plays, from 1; 0: by hand
  bool cut = false;          // it does not follow the shot before
  std::uint32_t camera = 0;  // counts the cameras shown
  std::uint32_t look = 0;    // the number of the pilot's last LookFrom
  int pilot = 0;             // client; 0: nobody
  Overlay overlay = Overlay::kNone;
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
  void left(int client);

  // Does what a client asks for. What is no command, or not allowed, is answered by {"error":TEXT}.
  void said(int client, std::string_view text);

  bool is_watched() const;

  // --- Frames

  // Waits until a frame is wanted, at most so many seconds. None is while a picture is finished, or while
  // nobody watches, unless the show plays all the same.
  bool wait_for_wish(double at_most_s);

  // What the next run of frames is like. A photo is over when this is asked again.
  LiveRun next_run();

  // The next frame's camera; empty: another run is wanted.
  std::optional<LiveShot> next_shot();

  // The picture is finished: frames are wanted again once somebody does something.
  void rest();

  // Whether the script has been played to its end and nobody has the camera.
  bool is_played_out() const;

 private:
  struct Answer;
  void require_pilot(int client) const;
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
  void obey(int client, const SetKey& command);
  void obey(int client, const DropKey& command);
  void obey(int client, const UndoKeys&);
  void obey(int client, const PlayFilm& command);
  void obey(int client, const TakePhoto& command);
  void go_to(int position);
  void keys_changed(std::vector<CameraKey> before);
  int frames() const;
  ScriptFrame frame_at(int position) const;
  Animation film() const;
  std::string state() const;
  bool wants_frames() const;

  const LiveShow show_;
  const LiveVoice voice_;

  std::condition_variable wish_;  // frames may be wanted
  mutable std::mutex mutex_;      // guards what follows
  std::set<int> clients_;
  int pilot_ = 0;
  LiveRun run_;         // as wanted
  LiveRun run_now_;     // as it is
  bool plays_ = false;  // the script or the film
  bool plays_film_ = false;
  int position_ = 0;          // in what plays: shown last, from 1; 0: nothing yet
  bool is_by_hand_ = false;   // the view is the pilot's
  bool is_finished_ = false;  // the picture, at rest
  bool jumps_ = true;         // the next shot does not follow the one before
  View view_;                 // wanted next, unless something plays
  View shown_;                // last
  std::uint32_t camera_ = 0, look_ = 0;
  Overlay overlay_ = Overlay::kNone;
  std::vector<CameraKey> keys_;                      // of the film, ascending by frame
  std::vector<std::vector<CameraKey>> keys_before_;  // to undo
};

}  // namespace pprt
