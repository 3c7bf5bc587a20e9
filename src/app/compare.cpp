#include "app/compare.h"

#include <fmt/core.h>

#include <array>
#include <nlohmann/json.hpp>
#include <ostream>
#include <stdexcept>

#include "base/diagnostics.h"
#include "image/image_io.h"
#include "image/metrics.h"

namespace pprt {
namespace {

struct Limit {
  const char* option;
  const char* figure;
  double value;
  std::optional<double> limit;
  bool is_upper;

  // A limit that is not a number is always passed.
  bool passed() const { return limit && !(is_upper ? value <= *limit : value >= *limit); }
};

std::array<Limit, 5> limits(const CompareOptions& options, const ImageDifference& d) {
  return {{{"--max-rmse", "rmse", d.rmse, options.max_rmse, true},
           {"--min-psnr", "psnr", d.psnr, options.min_psnr, false},
           {"--min-ssim", "ssim", d.ssim, options.min_ssim, false},
           {"--max-error", "max_error", d.max_error, options.max_error, true},
           {"--max-share", "share", d.share_over_threshold, options.max_share, true}}};
}

void require_comparable(const CompareOptions& options, Image& image, Image& reference) {
  if (image.width != reference.width || image.height != reference.height) {
    throw std::runtime_error(fmt::format("the sizes differ: '{}' has {}x{} pixels, '{}' has {}x{}",
                                         options.image, image.width, image.height, options.reference,
                                         reference.width, reference.height));
  }
  for (const auto& [name, picture] : {std::pair{&options.image, &image}, {&options.reference, &reference}}) {
    if (const std::size_t bad = replace_non_finite(*picture); bad > 0) {
      throw std::runtime_error(fmt::format("'{}' has {} pixels that are not finite", *name, bad));
    }
  }
}

void print_text(const ImageDifference& d, double threshold, std::ostream& out) {
  out << fmt::format("rmse          {:.6g}\n", d.rmse) << fmt::format("psnr          {:.4g} dB\n", d.psnr)
      << fmt::format("ssim          {:.6g}\n", d.ssim) << fmt::format("max error     {:.6g}\n", d.max_error)
      << fmt::format("99.9 % error  {:.6g}\n", d.error_p999)
      << fmt::format("share         {:.6g} (pixels with an error over {:g})\n", d.share_over_threshold,
                     threshold)
      << fmt::format("signed mean   {:.6g}\n", d.signed_mean)
      << fmt::format("relative mse  {:.6g}\n", d.relative_mse);
}

void print_json(const CompareOptions& options, const ImageDifference& d, bool within, std::ostream& out) {
  nlohmann::ordered_json record;
  record["image"] = options.image;
  record["reference"] = options.reference;
  record["rmse"] = d.rmse;
  record["psnr"] = d.psnr;  // null when infinite: JSON has no infinity
  record["ssim"] = d.ssim;
  record["max_error"] = d.max_error;
  record["error_p999"] = d.error_p999;
  record["threshold"] = options.threshold;
  record["share"] = d.share_over_threshold;
  record["signed_mean"] = d.signed_mean;
  record["relative_mse"] = d.relative_mse;
  record["within"] = within;
  out << record.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
}

}  // namespace

bool compare(const CompareOptions& options, std::ostream& out, std::ostream& complaints) {
  if (!(options.threshold >= 0)) throw UsageError("--threshold: a number that is not negative is needed");
  Image image = read_image(options.image);
  Image reference = read_image(options.reference);
  require_comparable(options, image, reference);
  const ImageDifference d = difference(image, reference, options.threshold);
  if (!options.difference_picture.empty()) {
    write_image(options.difference_picture, difference_picture(image, reference));
  }

  bool within = true;
  for (const Limit& limit : limits(options, d)) {
    if (!limit.passed()) continue;
    within = false;
    complaints << fmt::format("pprt-compare: {} is {:.6g}, the limit {} is {:g}\n", limit.figure, limit.value,
                              limit.option, *limit.limit);
  }
  if (options.json) {
    print_json(options, d, within, out);
  } else {
    print_text(d, options.threshold, out);
  }
  if (!out.flush()) throw std::runtime_error("cannot write the figures");
  return within;
}

}  // namespace pprt
