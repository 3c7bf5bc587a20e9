// Whether a mesh encloses a volume, so that its faces are seen from one side.
#pragma once

#include "convert/model/model_builder.h"

namespace pprt {

// Returns whether each edge of a face is that of another face, in the other direction. Corners at one place
// are one, whatever their index. Corners that are not there, and faces without an area, do not count.
bool is_closed(const ModelMesh& mesh);

}  // namespace pprt
