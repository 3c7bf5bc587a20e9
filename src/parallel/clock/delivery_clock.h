// The master's side of the clock: when frames are due, and how late they were.
#pragma once

#include <functional>
#include <span>
#include <utility>

#include "parallel/protocol/messages.h"
#include "parallel/settings/work_units.h"

namespace pprt {

// When a frame was delivered.
struct DeliveryTime {
  double finished_s = 0;  // since the start of the sequence; work clock: virtual
  double late_ms = 0;     // after its deadline; <= 0: on time; 0 without a rate
};

// make_clocks.h makes it.
class DeliveryClock {
 public:
  virtual ~DeliveryClock() = default;

  // The sequence begins at `start_s`, by monotonic_seconds(); without a rate it begins now, if that is
  // earlier.
  virtual void begin_sequence(double start_s) = 0;

  // Seconds since the sequence began, in real time; work clock: 0, for nothing is decided by it.
  virtual double now_s() const = 0;

  // Whether frames have deadlines in real time.
  virtual bool has_deadlines() const = 0;

  // Whether a frame is delivered at its deadline with what has come, instead of when it is whole.
  virtual bool keeps_deadlines() const = 0;

  // Whether rank 0 may begin frame `index` although the frame before is not delivered.
  virtual bool may_overlap(int index) const = 0;

  // Deadline of a frame, seconds since the sequence began; 0 without a rate. `frames_left_out`: frames of the
  // script before it that were not ordered.
  virtual double deadline_s(int index, int frames_left_out) const = 0;

  // Work units that a rank can do in one frame's period; 0 without a rate.
  virtual double units_per_frame() const = 0;

  // When a frame that is delivered now was finished. `ranks`: all ranks' reports.
  virtual DeliveryTime delivery_time(const FrameOrder& order, std::span<const RankReport> ranks) const = 0;
};

// Real time. `now` tells the time as monotonic_seconds() does.
class WallDeliveryClock final : public DeliveryClock {
 public:
  // `awaits_all`: frames are delivered whole, be it late.
  WallDeliveryClock(double frames_per_second, double ranks_per_core, bool awaits_all,
                    std::function<double()> now)
      : frames_per_second_(frames_per_second),
        ranks_per_core_(ranks_per_core),
        awaits_all_(awaits_all),
        now_(std::move(now)) {}

  void begin_sequence(double start_s) override;
  double now_s() const override { return now_() - start_s_; }
  bool has_deadlines() const override { return frames_per_second_ > 0; }
  bool keeps_deadlines() const override { return has_deadlines() && !awaits_all_; }
  bool may_overlap(int index) const override;
  double deadline_s(int index, int frames_left_out) const override;
  double units_per_frame() const override;
  DeliveryTime delivery_time(const FrameOrder& order, std::span<const RankReport> ranks) const override;

 private:
  double frames_per_second_;  // 0: no rate
  double ranks_per_core_;
  bool awaits_all_;
  std::function<double()> now_;
  double start_s_ = 0;
};

// Virtual time: a frame is finished when its slowest rank has done its work.
class WorkDeliveryClock final : public DeliveryClock {
 public:
  WorkDeliveryClock(double frames_per_second, WorkUnits budget)
      : frames_per_second_(frames_per_second), budget_(static_cast<double>(budget)) {}

  void begin_sequence(double) override {}
  double now_s() const override { return 0; }
  bool has_deadlines() const override { return false; }
  bool keeps_deadlines() const override { return false; }
  // An order must not depend on what happens to have come: the frame before must be whole.
  bool may_overlap(int) const override { return false; }
  double deadline_s(int index, int frames_left_out) const override;
  double units_per_frame() const override { return budget_; }
  DeliveryTime delivery_time(const FrameOrder& order, std::span<const RankReport> ranks) const override;

 private:
  double frames_per_second_;  // 0: no rate
  double budget_;             // work units a frame
};

}  // namespace pprt
