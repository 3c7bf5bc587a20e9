// Compiles tinygltf, which is all in its header but for what it needs of others.
#include <fstream>
#include <nlohmann/json.hpp>

#define TINYGLTF_IMPLEMENTATION
#include "convert/gltf/tinygltf.h"
