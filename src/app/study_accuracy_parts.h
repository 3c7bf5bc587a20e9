// The accuracy study's parts beside the curves, on its page: pictures, other renderers, effects, frame rates.
#pragma once

#include <vector>

#include "app/study_accuracy_curves.h"
#include "app/study_accuracy_effects.h"
#include "app/study_accuracy_foreign.h"
#include "app/study_accuracy_pictures.h"
#include "app/study_accuracy_rates.h"
#include "app/study_output.h"

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
