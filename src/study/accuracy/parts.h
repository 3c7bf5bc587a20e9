// The accuracy study's parts beside the curves, on its page: pictures, other renderers, effects, frame rates.
#pragma once

#include <vector>

#include "study/accuracy/curves.h"
#include "study/accuracy/effects.h"
#include "study/accuracy/foreign.h"
#include "study/accuracy/pictures.h"
#include "study/accuracy/rates.h"
#include "study/output.h"

namespace pprt {

void write_figures(const std::vector<NamedPicture>& pictures, StudyOutput& output);

// `own`: this renderer's curves on the same scenes at the same size.
void write_foreign(const std::vector<ForeignResult>& results, const std::vector<SceneCurves>& own, int size,
                   StudyOutput& output);

void write_effects(const std::vector<SceneEffects>& scenes, StudyOutput& output);

// `setting` tells ranks, clock and sequence in a sentence.
void write_rates(const std::vector<RatePoint>& points, const std::string& setting, StudyOutput& output);
void write_punctuality(const std::vector<Punctuality>& points, StudyOutput& output);

}  // namespace pprt
