#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>

#include "image/contact_sheet.h"
#include "image/image_io.h"
#include "layers/frame_layers.h"
#include "layers/pictures.h"
#include "parallel/balance/partition.h"
#include "study/paper/runs.h"

namespace pprt {
namespace {

constexpr int kDrawingWidth = 512;  // pixels, at most

// A layer, or the frame itself.
using Shown = std::optional<Layer>;

// Frames of a run to be shown, each in some views.
struct Exhibit {
  std::string_view experiment;
  int ranks;
  BalanceMode balance;
  std::vector<int> frames;
  std::vector<Shown> views;
  std::vector<Picture> PaperResults::*gallery;
};

// As in the paper's figure 4: frames, patterns and regions. As in figures 1 and 2: one rank's pattern and
// that of a few, at the end of the still frames.
std::vector<Exhibit> exhibits(const PaperOptions& options, int last_frame) {
  using enum BalanceMode;
  using enum Layer;
  const Shown frame;
  const auto sequences = &PaperResults::sequence_pictures, patterns = &PaperResults::pattern_pictures;
  const std::vector<Shown> progress = {frame, kSamples, kRegions};
  return {{kSimple, options.ranks.front(), kCombined, {1, 13, 15, 18, 22, 32}, progress, sequences},
          {kCasting, options.ranks.back(), kCombined, {1, 5, 13, 18, 26, 35}, progress, sequences},
          {kScaling, 1, kCombined, {last_frame}, {frame, kSamples, kTriangulation, kCost}, patterns},
          {kPattern, kPatternRanks, kCombined, {last_frame}, {kSamples, kRegions}, patterns},
          {kPattern, kPatternRanks, kNone, {last_frame}, {kSamples}, patterns}};
}

bool shows(const Exhibit& exhibit, const PaperRun& run, int frame) {
  return exhibit.experiment == run.experiment && exhibit.ranks == run.ranks &&
         exhibit.balance == run.balance && run.keep_samples && run.compare_serial &&
         std::find(exhibit.frames.begin(), exhibit.frames.end(), frame) != exhibit.frames.end();
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
  for (const Exhibit& exhibit : exhibits(options, run.frames)) {
    if (!shows(exhibit, run, number)) continue;
    FrameLayers layers({number, grid, frame.owners, frame.samples, {}});
    for (const Shown& view : exhibit.views) {
      Image picture = view ? layers.picture(*view, frame.image) : frame.image;
      if (picture.width > kDrawingWidth) picture = thumbnail(picture, kDrawingWidth);
      if (view == Layer::kRegions) label_ranks(picture, grid, frame.owners);
      const PictureKind kind = view ? PictureKind::kDrawn : PictureKind::kRendered;
      (results.*exhibit.gallery)
          .push_back({caption_of(run, number, view), encode_png(picture, {}, kind), ""});
    }
  }
}

}  // namespace pprt
