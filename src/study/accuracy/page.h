// The accuracy study as tables, plots and a page.
#pragma once

#include <vector>

#include "study/accuracy/curves.h"
#include "study/output.h"

namespace pprt {

// Curves, tables at equal time and equal error, break-even points, and in words where progressive loses.
void write_curves(const std::vector<SceneCurves>& scenes, StudyOutput& output);

}  // namespace pprt
