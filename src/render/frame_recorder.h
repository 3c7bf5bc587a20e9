// Where finished frames go: files, manifest, ledger, progress. All but the bookkeeping happens beside the
// frame loop.
#pragma once

#include <filesystem>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "image/frame_writer.h"
#include "render/ledger.h"
#include "render/manifest.h"
#include "render/progress.h"
#include "render/render_plan.h"
#include "render/serial_comparison.h"

namespace pprt {

class FrameRecorder {
 public:
  // `key` stands for scene and options in the manifest; `run` is the ledger's first record.
  // Scene and progress must outlive the recorder.
  FrameRecorder(const RenderOptions& options, const RenderPlan& plan, const CompiledScene& scene,
                const std::string& key, const Json& run, Progress& progress);

  // Whether an earlier run has finished the frame (--resume).
  bool finished_before(int frame) const { return finished_before_.count(frame) != 0; }

  void record(FinishedFrame&& frame);

  // Whether going on serves nothing: a frame could not be written.
  bool failed() const { return writer_.error().has_value(); }

  void status() const;  // from any thread
  const RunTotals& totals() const { return totals_; }

  // Waits for the last file, writes contact sheet, film and summary; throws what kept a frame from being
  // written.
  void finish(bool stopped);

 private:
  LayerMaker layers_of(FinishedFrame& frame) const;
  std::vector<Measurement> measurements_of(const FinishedFrame& frame);
  void note_written(const std::vector<WrittenFrame>& frames);
  void write_contact_sheet() const;
  void make_film() const;

  const CompiledScene& scene_;
  bool has_rate_;
  std::string where_;
  std::filesystem::path contact_sheet_;  // empty: none
  std::filesystem::path film_;           // empty: none
  double film_rate_;                     // frames/s
  FramePattern first_output_;
  std::vector<Layer> layers_;
  std::optional<FramePattern> reference_;
  std::optional<SerialComparison> serial_;
  Ledger ledger_;  // before the manifest, which must stand as it was when no ledger can be written
  Manifest manifest_;
  std::set<int> finished_before_;
  std::set<int> written_;  // frames whose files are whole, those of earlier runs too
  FrameWriter writer_;
  mutable std::mutex mutex_;  // guards what follows
  Progress& progress_;
  RunTotals totals_;
};

// Throws UsageError when an output is there already and may not be replaced, or a reference is not there, and
// std::runtime_error when a film is wanted and there is no ffmpeg.
void check_files(const RenderOptions& options, const RenderPlan& plan);

}  // namespace pprt
