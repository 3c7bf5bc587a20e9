// Where finished frames go: files, manifest, ledger, progress. Only the bookkeeping delays the frame loop;
// the rest happens in threads of its own.
#pragma once

#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "image/frame_writer.h"
#include "render/output/run_record.h"
#include "render/output/serial_comparison.h"
#include "render/records/ledger.h"
#include "render/records/manifest.h"
#include "render/records/progress.h"
#include "render/trace/balance_trace.h"

namespace pprt {

class FrameRecorder {
 public:
  // The plan, scene and progress must outlive the recorder.
  FrameRecorder(const RunIdentity& run, const CompiledScene& scene, ProgressReporter& progress);

  // Whether an earlier run has finished the frame (--resume).
  bool finished_before(int frame) const { return finished_before_.count(frame) != 0; }

  // Traces the frame's balancing. Everything else is left out where an earlier run has finished the frame.
  void record(FinishedFrame&& frame);

  // Whether a frame, its trace or the manifest could not be written, so that going on serves nothing.
  bool failed() const {
    return writer_.error().has_value() || manifest_error_ || (trace_ && trace_->failed());
  }

  // Reports how far a frame without a rate is.
  void sampled(const SamplingProgress& now);

  // Prints a line of status; may be called from any thread.
  void status() const;

  const RunTotals& totals() const { return totals_; }

  // Waits for the last file, then writes contact sheet, film and summary. Throws what kept a frame from being
  // written.
  void finish(bool stopped);

 private:
  LayerMaker layers_of(FinishedFrame& frame) const;
  std::vector<Measurement> measurements_of(const FinishedFrame& frame);
  void note_written(const std::vector<WrittenFrame>& frames);
  std::size_t settle_files();
  void write_contact_sheet() const;
  void make_film() const;
  void remove_frames_of_film() const;
  std::string where(bool has_failed) const;  // the files are
  int frames_in_place() const;               // that this run has written

  const RenderPlan& plan_;
  const CompiledScene& scene_;
  std::optional<SerialComparison> serial_;
  // A manifest that does not go on ends the run before anything is written. It is written itself when ledger
  // and trace are: where they cannot be, it must stand as it was.
  EarlierManifest earlier_;
  std::set<int> finished_before_;
  Ledger ledger_;
  std::unique_ptr<BalanceTraceWriter> trace_;  // null: none
  Manifest manifest_;
  std::exception_ptr manifest_error_;
  std::set<int> written_;  // frames whose files are whole, those of earlier runs too
  FrameWriter writer_;
  mutable std::mutex mutex_;  // guards what follows
  ProgressReporter& progress_;
  RunTotals totals_;
};

}  // namespace pprt
