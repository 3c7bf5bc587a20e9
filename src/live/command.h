// What a client may ask for. On the wire: one JSON object a message, "do" says which.
//
//   {"do":"take"}  {"do":"give"}  {"do":"pass","to":3}         the camera: one pilot at a time
//   {"do":"look","number":17,"from":[x,y,z],"at":[x,y,z],"up":[x,y,z],"angle":45}
//   {"do":"play"}  {"do":"pause"}  {"do":"step","by":-1}  {"do":"seek","frame":12}      the script
//   {"do":"rate","fps":24}  {"do":"size","width":512,"height":384}  {"do":"overlay","name":"samples"}
//   {"do":"pivot","x":0.5,"y":0.5}   tells what is seen there. Shares of the picture, from its upper left.
//   {"do":"key","frame":49}          keys the camera in the recorded film. "view" gives another, as in
//   "look".
//   {"do":"drop","frame":49}  {"do":"move","frame":49,"to":60}  {"do":"undo"}  {"do":"redo"}
//   {"do":"film","on":true}          play the recorded film in the script's place
//   {"do":"photo","format":"png"}    a picture at full quality, or "exr"
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <variant>

#include "base/words.h"
#include "scene/description/scene_description.h"

namespace pprt {

struct TakeCamera {};
struct GiveCamera {};
struct PassCamera {
  int to = 0;  // client
};
// A camera from the pilot's page. `number` counts the pilot's cameras: frames tell which one they show.
struct LookFrom {
  std::uint32_t number = 0;
  View view = {};  // from, at, up, angle_degrees
};
struct PlayScript {
  bool on = true;
};
struct StepScript {
  int by = 1;  // frames
};
struct SeekScript {
  int frame = 1;
};
struct SetRate {
  double frames_per_second = 4;
};
struct SetSize {
  int width = 1, height = 1;
};

// What is drawn over the picture.
enum class Overlay : std::uint8_t { kNone, kSamples, kTriangulation, kRegions, kAge };
template <>
inline constexpr std::array<Word<Overlay>, 5> kWords<Overlay>{{
    {Overlay::kNone, "none", ""},
    {Overlay::kSamples, "samples", ""},
    {Overlay::kTriangulation, "triangulation", ""},
    {Overlay::kRegions, "regions", ""},
    {Overlay::kAge, "age", ""},
}};
struct ShowOverlay {
  Overlay overlay = Overlay::kNone;
};

// Asks what is seen at a point of the picture, in shares of its width and height.
struct FindPivot {
  double x = 0.5, y = 0.5;
};

// A key of the film that the pilot records.
struct SetKey {
  int frame = 1;
  std::optional<View> view = {};  // empty: the camera as it is
};
struct DropKey {
  int frame = 1;
};
struct MoveKey {
  int frame = 1, to = 1;
};
struct UndoKeys {};
struct RedoKeys {};
struct PlayFilm {
  bool on = true;
};

enum class PhotoFormat : std::uint8_t { kPng, kExr };
template <>
inline constexpr std::array<Word<PhotoFormat>, 2> kWords<PhotoFormat>{{
    {PhotoFormat::kPng, "png", ""},
    {PhotoFormat::kExr, "exr", ""},
}};
struct TakePhoto {
  PhotoFormat format = PhotoFormat::kPng;
};

using LiveCommand = std::variant<TakeCamera, GiveCamera, PassCamera, LookFrom, PlayScript, StepScript,
                                 SeekScript, SetRate, SetSize, ShowOverlay, FindPivot, SetKey, DropKey,
                                 MoveKey, UndoKeys, RedoKeys, PlayFilm, TakePhoto>;

// A message that is none, in words for the person at the page.
class CommandError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The slowest and fastest rate, and the longest side of a picture, that a page may ask for.
inline constexpr double kSlowestRate = 1, kFastestRate = 120;
inline constexpr int kLongestLiveSide = 4096;

// The last frame that a key may stand at.
inline constexpr int kLastKeyFrame = 1'000'000;

// Throws CommandError for what is not a command. It does so, too, for
//   - numbers that are none, or are beyond 1e15
//   - a camera that looks nowhere, or along its up
//   - an angle outside 0.1 to 170 degrees.
LiveCommand parse_command(std::string_view text);

}  // namespace pprt
