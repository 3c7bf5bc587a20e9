// When a rank samples, exchanges and stops: real time or counted work, behind one interface (paper
// s. 4.3, 4.6).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "parallel/clock/work_units.h"
#include "parallel/network/messages.h"
#include "parallel/session_settings.h"

namespace pprt {

class FrameClock {
 public:
  virtual ~FrameClock() = default;

  // Whether a frame may begin. Where ranks share cores, not before the deadline of the one before: who is
  // ready would take the time of those who still reconstruct it.
  virtual bool may_begin(const FrameOrder& order) const = 0;

  // A frame begins.
  virtual void begin_frame(const FrameOrder& order) = 0;

  // Counts work (a no-op for wall time: it passes by itself).
  virtual void spend(Work work, std::uint64_t count) = 0;

  // The rank had nothing to do for so long (a no-op for counted work).
  virtual void rested(double seconds) = 0;

  // Sampling goes in packets with an exchange of messages after each. `samples`: of the region so far, which
  // reconstruction will have to deal with.
  virtual void begin_packet(std::uint64_t samples) = 0;
  virtual bool packet_over() = 0;

  // With a rate: whether what must follow needs the rest of the frame's time; the end is put off a little
  // where a rank was not let run. Without: never.
  virtual bool sampling_over() = 0;

  // The frame is sent. What its reconstruction took of this rank's CPU, in milliseconds as lap_ms() has it,
  // tells what the next frames must leave.
  virtual void end_frame(double reconstruction_ms) = 0;

  // With a rate: how often a piece of work fits into a share of one frame's time.
  virtual std::size_t affordable(Work work, double share) const = 0;

  // Whether all ranks take the same packets and wait for each other's messages after each.
  virtual bool in_lockstep() const = 0;

  // In lockstep: how many rounds after the one that they were sent in samples arrive that are so long under
  // way. 0 on the wall clock, where the network itself takes its time.
  virtual int rounds_under_way(double seconds) const = 0;

  // Milliseconds of this rank's CPU (work clock: units / 1e6) since the last call.
  virtual double lap_ms() = 0;

  // How much of the frame's sampling time has passed, in (0, 1]; 1 without a rate.
  virtual double sampling_share() const = 0;

  // The region has so many pixels from now on.
  virtual void region_changed(std::size_t pixels) = 0;

  // Seconds since this frame began (work clock: units / kWorkUnitsPerSecond).
  virtual double frame_seconds() const = 0;

  // When this frame's sampling had to end, or began if that was later: seconds since the sequence began. What
  // comes after it is what a frame must leave room for, the last exchange included.
  virtual double sampling_end_seconds() const = 0;

  // Seconds since the sequence began; work clock: of this rank's virtual time.
  virtual double sequence_seconds() const = 0;
};

// `start_s` is the moment the sequence begins in terms of monotonic_seconds(); the work clock ignores it.
// `region_pixels` is what reconstruction will have to fill.
std::unique_ptr<FrameClock> make_frame_clock(const SessionSettings& settings, double start_s,
                                             std::size_t region_pixels, double ranks_per_core);

// Seconds on this host's steady clock.
double monotonic_seconds();

}  // namespace pprt
