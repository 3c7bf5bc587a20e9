// What a program that renders frames has to do with the people who watch them: it asks for the next camera,
// and shows the frame.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "image/image.h"
#include "live/address.h"
#include "live/frame_header.h"
#include "live/steering.h"

namespace pprt {

// A frame to be shown.
struct LivePicture {
  Image image;
  LiveShot shot = {};
  FrameFigures figures = {};
  bool rests = false;       // it shows the same as the frame before, whose samples it keeps
  bool is_partial = false;  // its overlay lacks what late ranks have not sent: the picture before is kept
  // Draws the shot's overlay; null: there is none.
  std::function<Image(const Image& image)> overlaid = {};
};

// Encodes and serves in threads of its own: no call waits for a client or for an encoder. Where pictures come
// faster than they are encoded, the newest wins. What cannot be encoded is dropped, and viewers are told.
class LiveView {
 public:
  // Throws std::runtime_error where the address cannot be had.
  LiveView(const LiveAddress& address, LiveShow show);

  // Tells all clients that the program has ended, unless end() has told why.
  ~LiveView();
  LiveView(const LiveView&) = delete;
  LiveView& operator=(const LiveView&) = delete;

  // The page's address, with the token that it needs.
  std::string url() const;

  // The same for another of this host's addresses.
  std::string url_at(const std::string& address) const;
  std::uint16_t port() const;

  // Tells all clients why nothing more comes.
  void end(const std::string& why);

  Steering& steering();

  void show(LivePicture picture);

  // A picture at full quality, for one client.
  void show_photo(const LiveRun& run, const Image& image);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pprt
