// The accuracy study as tables, plots and a page.
#pragma once

#include <vector>

#include "app/study_accuracy_curves.h"
#include "app/study_output.h"

namespace pprt {

// Curves, tables at equal time and equal error, break-even points, and in words where progressive loses.
void write_curves(const std::vector<SceneCurves>& scenes, StudyOutput& output);

}  // namespace pprt
