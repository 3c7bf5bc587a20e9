// The accuracy study's results, and the page, tables and plots made of them.
#pragma once

#include <string>
#include <vector>

#include "study/accuracy/curves.h"
#include "study/accuracy/effects.h"
#include "study/accuracy/flicker.h"
#include "study/accuracy/other_renderers.h"
#include "study/accuracy/rates.h"
#include "study/report/output.h"
#include "study/report/page.h"

namespace pprt {

// With --only-curves all after `flicker` is empty.
struct AccuracyResults {
  std::vector<Method> methods;
  std::vector<SceneCurves> curves;
  std::vector<FlickerPoint> flicker;
  std::vector<Picture> crops;
  std::vector<SceneCurves> small_curves;  // at the size of the other renderers' pictures
  std::vector<RendererPoint> renderers;
  std::vector<EffectCost> effects;
  std::vector<std::string> censuses;  // effects that the scenes call for, and why
  std::vector<Picture> pictures;
  std::string rates_setup;  // describes the sequences
  std::vector<RatePoint> rates;
  std::vector<RealTimePoint> real_time;
};

// Leaves out the sections without results. `small_size` is that of small_curves, pixels.
void write_accuracy(const AccuracyResults& results, int small_size, StudyOutput& output);

}  // namespace pprt
