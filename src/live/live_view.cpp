#include "live/live_view.h"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>
#include <utility>
#include <vector>

#include "base/system/thread_priority.h"
#include "image/image_io.h"
#include "live/page.h"
#include "live/picture_stream.h"
#include "live/server.h"

namespace pprt {
namespace {

using Json = nlohmann::json;

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

class LiveView::Impl {
 public:
  Impl(const LiveAddress& address, LiveShow show)
      : steering_(std::move(show),
                  {.tell = [this](int client, std::string text) { server_.tell(client, std::move(text)); },
                   .tell_all = [this](std::string text) { server_.tell_all(std::move(text)); }}),
        server_({.address = address.address, .port = address.port, .page = std::string(live_page())}) {
    server_.start({.joined = [this](int client) { steering_.joined(client); },
                   .said = [this](int client, std::string_view text) { steering_.said(client, text); },
                   .left = [this](int client) { steering_.left(client); },
                   .failed = [this](std::string_view why) { complain(why); }});
    thread_ = std::thread([this] {
      ask_for_short_waits();
      run();
    });
  }

  ~Impl() {
    end("The program has ended.");
    {
      const std::lock_guard lock(mutex_);
      is_over_ = true;
    }
    work_.notify_one();
    thread_.join();
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  const LiveServer& server() const { return server_; }
  Steering& steering() { return steering_; }

  void show(LivePicture picture) {
    const bool is_watched = steering_.is_watched();
    {
      const std::lock_guard lock(mutex_);
      constexpr std::size_t kMostFigures = 240;
      if (!is_watched || figures_.size() == kMostFigures) figures_.clear();
      figures_.push_back(picture.figures);
      rests_ = rests_ && picture.rests;
      if (is_watched) next_ = std::move(picture);
    }
    work_.notify_one();
  }

  void show_photo(const LiveRun& run, const Image& image) {
    const bool is_exr = run.photo == PhotoFormat::kExr;
    const Json header = {{"photo", is_exr ? "exr" : "png"}, {"view", json_of(run.view)}};
    server_.send_file(run.photo_for,
                      {.header = header.dump(), .image = is_exr ? encode_exr(image) : encode_png(image)});
  }

  void end(const std::string& why) {
    if (std::exchange(has_told_end_, true)) return;
    server_.tell_all(Json{{"end", why}}.dump());
  }

 private:
  void run() {
    while (true) {
      LivePicture picture;
      std::vector<FrameFigures> figures;
      {
        std::unique_lock lock(mutex_);
        work_.wait(lock, [this] { return is_over_ || next_; });
        if (is_over_) return;
        picture = std::move(*std::exchange(next_, std::nullopt));
        picture.rests = std::exchange(rests_, true);
        figures = std::exchange(figures_, {});
      }
      try {
        server_.show(std::make_shared<const LiveFrame>(frame_of(picture, std::move(figures))));
      } catch (const std::exception& e) {
        complain(e.what());
      }
    }
  }

  LiveFrame frame_of(const LivePicture& picture, std::vector<FrameFigures> figures) {
    const double now_s = seconds_now();
    const bool is_at_rest = rest_.is_at_rest(picture.rests, now_s);
    const Shown shown{picture.shot.camera, picture.image.width, picture.image.height, picture.shot.overlay};
    const PictureCoding coding =
        picture.is_partial ? PictureCoding::kNone : stream_.next(is_at_rest, !(shown == sent_), now_s);
    const bool is_drawn_over = picture.overlaid && coding != PictureCoding::kNone;
    EncodedPicture bytes = encoded(is_drawn_over ? picture.overlaid(picture.image) : picture.image, coding);
    if (coding != PictureCoding::kNone) sent_ = shown;
    const FrameHeader header{
        .shot = picture.shot,
        .is_at_rest = is_at_rest,
        .flip = estimate_.add(picture.image, picture.figures.samples, picture.rests, is_at_rest),
        .type = bytes.type,
        .frames = std::move(figures)};
    return {.header = to_text(header), .image = std::move(bytes.bytes)};
  }

  // Something was dropped: people at the page should know, and the program goes on.
  void complain(std::string_view why) {
    server_.tell_all(Json{{"error", why}}.dump(-1, ' ', false, Json::error_handler_t::replace));
  }

  // What a picture shows, as far as people would miss it.
  struct Shown {
    std::uint32_t camera = 0;
    int width = 0, height = 0;
    Overlay overlay = Overlay::kNone;

    friend bool operator==(const Shown&, const Shown&) = default;
  };

  Steering steering_;
  LiveServer server_;  // after what its clients speak to
  bool has_told_end_ = false;
  Shown sent_;
  RestWatch rest_;  // these four: of the thread
  PictureStream stream_;
  RestEstimate estimate_;

  std::mutex mutex_;  // guards what follows
  std::condition_variable work_;
  std::optional<LivePicture> next_;
  std::vector<FrameFigures> figures_;  // of frames since the last that was taken
  bool rests_ = true;                  // in all of these the camera stood still
  bool is_over_ = false;

  std::thread thread_;  // last: it uses the others
};

LiveView::LiveView(const LiveAddress& address, LiveShow show)
    : impl_(std::make_unique<Impl>(address, std::move(show))) {}
LiveView::~LiveView() = default;

std::string LiveView::url() const {
  return impl_->server().url();
}
std::string LiveView::url_at(const std::string& address) const {
  return http_address({address, port()}) + impl_->server().token() + "/";
}
std::uint16_t LiveView::port() const {
  return impl_->server().port();
}
Steering& LiveView::steering() {
  return impl_->steering();
}
void LiveView::show(LivePicture picture) {
  impl_->show(std::move(picture));
}
void LiveView::show_photo(const LiveRun& run, const Image& image) {
  impl_->show_photo(run, image);
}
void LiveView::end(const std::string& why) {
  impl_->end(why);
}

}  // namespace pprt
