// Compiles tinygltf, which is all in its header.
#include <nlohmann/json.hpp>

#define TINYGLTF_IMPLEMENTATION
#include "convert/gltf/tinygltf.h"
