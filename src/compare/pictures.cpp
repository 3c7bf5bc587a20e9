#include "compare/pictures.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "base/counted.h"
#include "base/diagnostics.h"
#include "cli/options/number_pair.h"
#include "image/frame_pattern.h"
#include "image/image_io.h"

namespace pprt {
namespace {

bool is_sequence(const std::string& name) {
  return name.find_first_of("%#") != std::string::npos && !std::filesystem::exists(name);
}

// Returns the frames of both sequences. Throws unless both have the same.
std::vector<int> frames_of_both(const FramePattern& image, const FramePattern& reference,
                                const CompareOptions& options) {
  std::vector<int> a = frames_present(image);
  const std::vector<int> b = frames_present(reference);
  if (a.empty()) throw std::runtime_error(fmt::format("there are no frames '{}'", options.image));
  if (b.empty()) throw std::runtime_error(fmt::format("there are no frames '{}'", options.reference));
  std::vector<int> lonely;
  std::set_symmetric_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(lonely));
  if (!lonely.empty()) {
    const int frame = lonely.front();
    const bool in_a = std::binary_search(a.begin(), a.end(), frame);
    throw std::runtime_error(
        fmt::format("there is no '{}' to go with '{}'; --frames compares a part of the sequences",
                    file_name(in_a ? reference : image, frame).string(),
                    file_name(in_a ? image : reference, frame).string()));
  }
  return a;
}

std::vector<int> frames_to_compare(const FramePattern& image, const FramePattern& reference,
                                   const CompareOptions& options) {
  if (!options.frames) return frames_of_both(image, reference, options);
  const FrameRange range = *options.frames;
  std::vector<int> frames;
  for (int frame = range.first; frame <= range.last; ++frame) {
    for (const FramePattern* pattern : {&image, &reference}) {
      if (std::filesystem::exists(file_name(*pattern, frame))) continue;
      throw std::runtime_error(fmt::format("there is no '{}'", file_name(*pattern, frame).string()));
    }
    frames.push_back(frame);
  }
  return frames;
}

std::vector<PicturePair> single_pair(const CompareOptions& options) {
  if (options.frames) throw UsageError("--frames is for sequences such as out/%04d.png");
  if (options.max_flicker) throw UsageError("--max-flicker is for sequences such as out/%04d.png");
  return {{options.image, options.reference, options.difference_picture, std::nullopt}};
}

}  // namespace

std::vector<PicturePair> pairs_to_compare(const CompareOptions& options) {
  const bool sequence = is_sequence(options.image);
  if (is_sequence(options.reference) != sequence) {
    throw UsageError(fmt::format("'{}' is a sequence and '{}' is a single picture",
                                 sequence ? options.image : options.reference,
                                 sequence ? options.reference : options.image));
  }
  if (!sequence) return single_pair(options);

  const FramePattern image = parse_frame_pattern(options.image, FrameCount::kMany, "A");
  const FramePattern reference = parse_frame_pattern(options.reference, FrameCount::kMany, "B");
  std::optional<FramePattern> difference;
  if (!options.difference_picture.empty()) {
    difference = parse_frame_pattern(options.difference_picture, FrameCount::kMany, "--diff");
  }
  std::vector<PicturePair> pairs;
  for (const int frame : frames_to_compare(image, reference, options)) {
    pairs.push_back({file_name(image, frame).string(), file_name(reference, frame).string(),
                     difference ? file_name(*difference, frame).string() : "", frame});
  }
  if (options.max_flicker && pairs.size() < 2) throw UsageError("--max-flicker needs two frames or more");
  return pairs;
}

LoadedPair load(const PicturePair& pair, bool clamp) {
  LoadedPair loaded{read_image(pair.image), read_image(pair.reference)};
  if (loaded.image.width != loaded.reference.width || loaded.image.height != loaded.reference.height) {
    throw std::runtime_error(fmt::format("the sizes differ: '{}' has {}x{} pixels, '{}' has {}x{}",
                                         pair.image, loaded.image.width, loaded.image.height, pair.reference,
                                         loaded.reference.width, loaded.reference.height));
  }
  for (const auto& [name, picture] :
       {std::pair{&pair.image, &loaded.image}, {&pair.reference, &loaded.reference}}) {
    if (const std::size_t bad = replace_non_finite(*picture); bad > 0) {
      throw std::runtime_error(fmt::format(
          "'{}' has {}", *name, counted(bad, "pixel that is not finite", "pixels that are not finite")));
    }
    if (clamp) *picture = clamped_to_display(*picture);
  }
  return loaded;
}

}  // namespace pprt
