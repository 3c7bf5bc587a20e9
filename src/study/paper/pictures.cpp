#include "study/paper/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>

#include "image/contact_sheet.h"
#include "image/image_io.h"
#include "layers/frame_layers.h"
#include "parallel/balance/partition.h"

namespace pprt {
namespace {

constexpr int kDrawingWidth = 512;  // pixels, at most

// A layer, or the frame itself.
using Shown = std::optional<Layer>;

bool is_among(int frame, std::span<const int> frames) {
  return std::find(frames.begin(), frames.end(), frame) != frames.end();
}

// As in the paper's figure 4.
std::vector<Shown> views_of_sequences(const PaperOptions& options, const PaperRun& run, int frame) {
  constexpr std::array kSimpleShown = {1, 13, 15, 18, 22, 32};
  constexpr std::array kCastingShown = {1, 5, 13, 18, 26, 35};
  const bool simple =
      run.experiment == kSimple && run.ranks == options.ranks.front() && is_among(frame, kSimpleShown);
  const bool casting = run.experiment == kCasting && run.keep_samples && is_among(frame, kCastingShown);
  if (run.balance != BalanceMode::kCombined || !(simple || casting)) return {};
  return {std::nullopt, Layer::kSamples, Layer::kRegions};
}

// As in figures 1 and 2: one rank's pattern and that of a few, at the end of the still frames.
std::vector<Shown> views_of_patterns(const PaperOptions& options, const PaperRun& run, int frame) {
  if (frame != run.frames) return {};
  const bool combined = run.balance == BalanceMode::kCombined;
  if (run.experiment == kScaling && run.ranks == 1 && combined && run.side == picture_side(options)) {
    return {std::nullopt, Layer::kSamples, Layer::kTriangulation, Layer::kCost};
  }
  if (run.experiment != kPattern) return {};
  return combined ? std::vector<Shown>{Layer::kSamples, Layer::kRegions}
                  : std::vector<Shown>{Layer::kSamples};
}

std::string caption_of(const PaperRun& run, int frame, const Shown& view) {
  const std::string ranks =
      run.ranks == 1 ? "one rank" : fmt::format("{} ranks, {}", run.ranks, word_for(run.balance));
  return fmt::format("{}, frame {}, {}: {}", run.sequence, frame, ranks, view ? name_of(*view) : "frame");
}

}  // namespace

void add_pictures(const PaperOptions& options, const PaperRun& run, const FinishedFrame& frame,
                  PaperResults& results) {
  const int number = frame.order.number;
  const TileGrid grid = tile_grid_for(frame.image.width, frame.image.height, run.ranks);
  const auto add = [&](const std::vector<Shown>& views, std::vector<Picture>& pictures) {
    if (views.empty()) return;
    FrameLayers layers({number, grid, frame.owners, frame.samples, {}});
    for (const Shown& view : views) {
      Image picture = view ? layers.picture(*view, frame.image) : frame.image;
      if (picture.width > kDrawingWidth) picture = thumbnail(picture, kDrawingWidth);
      pictures.push_back({caption_of(run, number, view),
                          encode_png(picture, {}, view ? PictureKind::kDrawn : PictureKind::kRendered), ""});
    }
  };
  add(views_of_sequences(options, run, number), results.sequence_pictures);
  add(views_of_patterns(options, run, number), results.pattern_pictures);
}

}  // namespace pprt
