// When a rank samples and when it stops: real time or counted work, behind one interface (paper s. 4.3, 4.6).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "parallel/protocol/messages.h"
#include "parallel/settings/work_units.h"
#include "pipeline/sampling/time_forecast.h"

namespace pprt {

// One rank's clock. make_clocks.h makes it; wall_clock.h and work_clock.h are the two kinds.
class FrameClock {
 public:
  virtual ~FrameClock() = default;

  // --- Frames

  // Whether it learns from a rehearsal what work takes: there are deadlines in real time.
  virtual bool learns_from_rehearsal() const = 0;

  // Whether a frame may begin. Some orders say when. Where ranks share cores it may not before the deadline
  // of the frame before: a rank that is ready would take the time of those that still reconstruct.
  virtual bool may_begin(const FrameOrder& order) const = 0;

  // Whether the order's deadline has passed, so that the rank leaves the frame out. Never for the first
  // frame, nor for one that is awaited.
  virtual bool is_past(const FrameOrder& order) const = 0;

  // A frame begins.
  virtual void begin_frame(const FrameOrder& order) = 0;

  // The frame is sent. `reconstruction_ms`: what reconstructing a share of the region took by used_ns(), from
  // which the clock learns what the next frames must leave.
  virtual void end_frame(double reconstruction_ms, double share) = 0;

  // Number of pixels that this rank reconstructs from now on.
  virtual void region_changed(std::size_t pixels) = 0;

  // Number of them that show several surfaces, as far as is known in this frame.
  virtual void mixed_pixels_found(std::size_t pixels) = 0;

  // Work units that one of these takes beside its samples, seeing included. 0 where it is not known, and on
  // the work clock, where it costs nothing.
  virtual double mixed_pixel_units() const = 0;

  // Share of these pixels that nothing is shown of yet: those of new tiles, where a picture rests.
  virtual void unshown_found(double share) = 0;

  // --- Packets of samples

  // Begins a packet; ranks exchange messages after each. `samples`: count in the region so far, all of which
  // reconstruction will have to deal with.
  virtual void begin_packet(std::uint64_t samples) = 0;

  // To be asked after each sample. Once over a packet stays so.
  virtual bool packet_over() = 0;

  // With a rate: whether the rest of the frame's time is needed for what follows sampling. Without a rate:
  // false.
  virtual bool sampling_over() = 0;

  // With a rate: whether a resting picture without parts has as many samples as can be reconstructed within a
  // frame. Otherwise false.
  virtual bool is_fine_enough() const = 0;

  // With a rate, while a picture rests: whether there is no time for another part of it. A part is expected
  // to take as long as the one before, from the last call or the end of sampling on. Where there are no
  // parts: whether this is not the picture's turn. Otherwise false.
  virtual bool reconstruction_over() = 0;

  // Sampling has ended. `units`: the work that it took by the table of prices, from which the clock learns
  // this rank's pace.
  virtual void end_sampling(double units) = 0;

  // How many times its price a piece of work takes this rank, 1 before anything is known. Balancing counts
  // costs in time by it, so that a slow host is given less.
  virtual double pace() const = 0;

  // Share of the frame's sampling time that has passed, in (0, 1]; 0.5 without a rate.
  virtual double sampling_share() const = 0;

  // Factor by which the samples will have grown at the frame's end, if they keep
  // coming as from the `begin` ones to the `now` ones. Empty without a rate, and where the order of samples
  // cannot save time.
  virtual std::optional<double> expected_growth(std::size_t begin, std::size_t now) const = 0;

  // What the frame's time is good for, if its first samples took this rank so much CPU time each. Empty
  // without a rate, and where the order of samples cannot save time.
  virtual std::optional<TimeForecast> forecast(std::size_t samples, double seconds_of_each) const = 0;

  // --- Work

  // Counts work. Does nothing on the wall clock: time passes by itself.
  virtual void spend(Work work, std::uint64_t count) = 0;

  // With a rate: how often a piece of work fits into this share of one frame's time.
  virtual std::size_t affordable(Work work, double share) const = 0;

  // Notes seconds in which the rank had nothing to do. Returns the milliseconds of them to report as idle:
  // none on the work clock, where waiting costs no virtual time.
  virtual double rested(double seconds) = 0;

  // --- Readings

  // CPU time of this rank, nanoseconds since some fixed moment. Work clock: work units spent.
  virtual std::int64_t used_ns() const = 0;

  // The time measured for some work, milliseconds, as evidence of what that work costs. 0 on the work clock,
  // whose table of prices decides instead.
  virtual double as_evidence_ms(double measured_ms) const = 0;

  // Seconds since this frame began. Work clock: units / kWorkUnitsPerSecond.
  virtual double frame_seconds() const = 0;

  // When this frame's sampling had to end, or when it began if that was later: seconds since the sequence
  // began. A frame must leave room for what follows, the last exchange included.
  virtual double sampling_end_seconds() const = 0;
};

// sampling_share() of frames without a rate, whose end nobody knows.
inline constexpr double kShareWithoutEnd = 0.5;

}  // namespace pprt
