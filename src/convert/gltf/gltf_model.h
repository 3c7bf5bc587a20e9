// A glTF file as tinygltf has it, and the numbers in it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "convert/gltf/gltf_document.h"
#include "convert/gltf/tinygltf.h"
#include "convert/model/model_folder.h"

namespace pprt {

struct GltfFiles {
  std::vector<std::string> opened;            // paths
  std::map<std::string, std::string> unread;  // what the file names and cannot be read, with the reason
};

// Parses a file's bytes and reads its buffers, which must lie in its folder. Throws std::runtime_error.
tinygltf::Model load_gltf(std::string bytes, const GltfFacts& facts, const ModelFolder& folder,
                          GltfFiles& files);

// Numbers of an accessor, one element after another.
struct GltfNumbers {
  std::vector<double> values;
  std::size_t components = 1;  // of an element

  std::size_t size() const { return values.size() / components; }
  double at(std::size_t element, std::size_t component) const {
    return values[element * components + component];
  }
};

// Returns an accessor's numbers; normalised ones lie between -1 and 1. Throws std::runtime_error where they
// do not lie within the file.
GltfNumbers numbers(const tinygltf::Model& model, int accessor);

// Returns the bytes of a part of a buffer. Throws std::runtime_error where it does not lie within the file.
std::string_view bytes_of(const tinygltf::Model& model, int view);

// Returns an element that a file names. Throws std::runtime_error where it is not there.
template <typename T>
const T& element(const std::vector<T>& list, int index, const char* what) {
  if (index < 0 || static_cast<std::size_t>(index) >= list.size())
    throw std::runtime_error(std::string("it names ") + what + " that is not there");
  return list[static_cast<std::size_t>(index)];
}

// Returns a member of an extension; `otherwise` where it is not there or no number.
double number_in(const tinygltf::ExtensionMap& extensions, const char* extension, const char* member,
                 double otherwise);

}  // namespace pprt
