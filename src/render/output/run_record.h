// What identifies a run: the ledger's first record, and the key by which a run may be resumed.
#pragma once

#include <string>

#include "render/plan/render_plan.h"
#include "render/records/ledger.h"

namespace pprt {

// A run in progress: the plan, on how many ranks, of which scene.
struct RunIdentity {
  const RenderPlan& plan;
  int ranks = 1;
  std::string scene_hash;  // of the canonical NFF: content_hash()
};

// Stands for all that decides the pictures, but not for which of them are made. Two runs with equal keys may
// continue each other.
std::string run_key(const RunIdentity& run);

// The ledger's first record. `effects`: those that are simulated.
Json run_record(const RunIdentity& run, EffectSet effects);

}  // namespace pprt
