#include "convert/gltf/gltf_model.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>

#include "base/printable.h"

namespace pprt {
namespace {

// What tinygltf's callbacks work on.
struct Access {
  const ModelFolder& folder;
  GltfFiles& files;
  std::map<std::string, std::size_t> lengths;  // of buffers, by the paths of their files
};

bool is_there(const std::string& name, void* access) {
  try {
    static_cast<Access*>(access)->folder.find(name);
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

std::string unchanged(const std::string& name, void* /*access*/) {
  return name;
}

// A file may be longer than its buffer, which tinygltf does not know.
bool read_buffer(std::vector<unsigned char>* bytes, std::string* error, const std::string& name,
                 void* access) {
  Access& to = *static_cast<Access*>(access);
  try {
    const std::string path = to.folder.find(name).string();
    std::ifstream file(path, std::ios::binary);
    bytes->assign(std::istreambuf_iterator<char>(file), {});
    const auto length = to.lengths.find(path);
    if (length != to.lengths.end() && bytes->size() > length->second) bytes->resize(length->second);
    to.files.opened.push_back(path);
    return true;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    *error = e.what();
    return false;
  }
}

bool write_nothing(std::string* /*error*/, const std::string& /*name*/,
                   const std::vector<unsigned char>& /*bytes*/, void* /*access*/) {
  return false;
}

[[maybe_unused]] bool size_of_file(std::size_t* size, std::string* error, const std::string& name,
                                   void* access) {
  std::vector<unsigned char> bytes;
  if (!read_buffer(&bytes, error, name, access)) return false;
  *size = bytes.size();
  return true;
}

// Later versions ask for the size of a file, too.
template <typename Callbacks>
void set_size_callback(Callbacks& callbacks) {
  if constexpr (requires { callbacks.GetFileSizeInBytes; }) callbacks.GetFileSizeInBytes = size_of_file;
}

// Keeps the bytes of a picture that is text in the file. Others are found by their place.
bool keep_picture(tinygltf::Image* image, int /*place*/, std::string* /*error*/, std::string* /*warning*/,
                  int /*width*/, int /*height*/, const unsigned char* bytes, int size, void* /*user*/) {
  if (image->bufferView < 0) image->image.assign(bytes, bytes + size);
  return true;
}

// Returns the library's first line.
std::string reason_of(const std::string& error) {
  const std::string line = error.substr(0, error.find('\n'));
  return line.empty() ? "tinygltf cannot read it" : printable(line.substr(0, 200));
}

// Returns the component at a place; normalised to [-1, 1] if asked.
template <typename T>
double component(const char* at, bool normalized) {
  T value;
  std::memcpy(&value, at, sizeof value);
  if (!normalized || std::is_floating_point_v<T>) return static_cast<double>(value);
  return std::max(static_cast<double>(value) / static_cast<double>(std::numeric_limits<T>::max()), -1.0);
}

double component(const char* at, int type, bool normalized) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return component<std::int8_t>(at, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return component<std::uint8_t>(at, normalized);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return component<std::int16_t>(at, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return component<std::uint16_t>(at, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return component<std::uint32_t>(at, normalized);
    default:
      return component<float>(at, normalized);
  }
}

std::size_t size_of_component(int type) {
  const int size = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(type));
  if (size <= 0 || type == TINYGLTF_COMPONENT_TYPE_DOUBLE || type == TINYGLTF_COMPONENT_TYPE_INT)
    throw std::runtime_error("it has numbers of an unknown type");
  return static_cast<std::size_t>(size);
}

// Elements at equal distances in a part of a buffer.
struct Run {
  int view = -1;
  std::size_t offset = 0, stride = 0, count = 0, components = 1;  // stride 0: they follow each other
  int type = TINYGLTF_COMPONENT_TYPE_FLOAT;
  bool normalized = false;
};

std::vector<double> values_of(const tinygltf::Model& model, const Run& run) {
  const std::size_t size = size_of_component(run.type), whole = size * run.components;
  const std::string_view bytes = bytes_of(model, run.view);
  const std::size_t stride = run.stride > 0 ? run.stride : whole;
  const bool fits = run.count == 0 || (run.offset <= bytes.size() && whole <= bytes.size() - run.offset &&
                                       (run.count - 1) <= (bytes.size() - run.offset - whole) / stride);
  if (!fits) throw std::runtime_error("it has numbers beyond the end of their buffer");
  std::vector<double> values;
  values.reserve(run.count * run.components);
  for (std::size_t i = 0; i < run.count; ++i) {
    for (std::size_t c = 0; c < run.components; ++c)
      values.push_back(
          component(bytes.data() + run.offset + i * stride + c * size, run.type, run.normalized));
  }
  return values;
}

void replace_sparse(const tinygltf::Model& model, const tinygltf::Accessor& from, GltfNumbers& to) {
  const auto& sparse = from.sparse;
  const auto count = static_cast<std::size_t>(std::max<std::int64_t>(sparse.count, 0));
  const std::vector<double> places =
      values_of(model, {.view = static_cast<int>(sparse.indices.bufferView),
                        .offset = static_cast<std::size_t>(sparse.indices.byteOffset),
                        .count = count,
                        .type = static_cast<int>(sparse.indices.componentType)});
  const std::vector<double> values =
      values_of(model, {.view = static_cast<int>(sparse.values.bufferView),
                        .offset = static_cast<std::size_t>(sparse.values.byteOffset),
                        .count = count,
                        .components = to.components,
                        .type = from.componentType,
                        .normalized = from.normalized});
  for (std::size_t i = 0; i < count; ++i) {
    if (!(places[i] >= 0 && places[i] < static_cast<double>(to.size())))
      throw std::runtime_error("it replaces a number that is not there");
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(i * to.components), to.components,
                to.values.begin() +
                    static_cast<std::ptrdiff_t>(places[i]) * static_cast<std::ptrdiff_t>(to.components));
  }
}

}  // namespace

tinygltf::Model load_gltf(std::string bytes, const GltfFacts& facts, const ModelFolder& folder,
                          GltfFiles& files) {
  Access access{folder, files, {}};
  for (const auto& [uri, length] : facts.buffers) {
    try {
      access.lengths[folder.find(uri).string()] = length;
    } catch (const std::exception& e) {
      files.unread.try_emplace(uri, e.what());
    }
  }
  tinygltf::FsCallbacks callbacks{};
  callbacks.FileExists = is_there, callbacks.ExpandFilePath = unchanged;
  callbacks.ReadWholeFile = read_buffer, callbacks.WriteWholeFile = write_nothing;
  callbacks.user_data = &access;
  set_size_callback(callbacks);
  tinygltf::TinyGLTF loader;
  loader.SetFsCallbacks(callbacks);
  loader.SetImageLoader(keep_picture, nullptr);
  const std::string::iterator begin = bytes.begin() + static_cast<std::ptrdiff_t>(facts.json_begin),
                              end = bytes.begin() + static_cast<std::ptrdiff_t>(facts.json_end);
  const std::string clean = utf8(std::string(begin, end));
  std::copy(clean.begin(), clean.end(), begin);  // as many bytes
  tinygltf::Model model;
  std::string error, warning;
  const auto size = static_cast<unsigned>(bytes.size());
  const bool is_read =
      facts.json_begin > 0
          ? loader.LoadBinaryFromMemory(&model, &error, &warning,
                                        reinterpret_cast<const unsigned char*>(bytes.data()), size, "")
          : loader.LoadASCIIFromString(&model, &error, &warning, bytes.data(), size, "");
  if (!is_read) throw std::runtime_error(reason_of(error));
  return model;
}

std::string_view bytes_of(const tinygltf::Model& model, int view) {
  const tinygltf::BufferView& part = element(model.bufferViews, view, "a part of a buffer");
  const std::vector<unsigned char>& data = element(model.buffers, part.buffer, "a buffer").data;
  if (part.byteOffset > data.size() || part.byteLength > data.size() - part.byteOffset)
    throw std::runtime_error("a part of a buffer lies beyond its end");
  return {reinterpret_cast<const char*>(data.data()) + part.byteOffset, part.byteLength};
}

GltfNumbers numbers(const tinygltf::Model& model, int accessor) {
  const tinygltf::Accessor& from = element(model.accessors, accessor, "numbers");
  const int components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(from.type));
  if (components <= 0) throw std::runtime_error("it has numbers of an unknown type");
  GltfNumbers result;
  result.components = static_cast<std::size_t>(components);
  if (from.bufferView >= 0) {
    result.values = values_of(
        model, {.view = from.bufferView,
                .offset = from.byteOffset,
                .stride = element(model.bufferViews, from.bufferView, "a part of a buffer").byteStride,
                .count = from.count,
                .components = result.components,
                .type = from.componentType,
                .normalized = from.normalized});
  } else {
    constexpr std::size_t kMost = std::size_t{1} << 25;  // a quarter of a gigabyte
    if (from.count > kMost / result.components)
      throw std::runtime_error("it has too many numbers without data");
    result.values.resize(from.count * result.components, 0);
  }
  if (from.sparse.isSparse) replace_sparse(model, from, result);
  return result;
}

double number_in(const tinygltf::ExtensionMap& extensions, const char* extension, const char* member,
                 double otherwise) {
  const auto found = extensions.find(extension);
  if (found == extensions.end() || !found->second.Has(member)) return otherwise;
  const tinygltf::Value& value = found->second.Get(member);
  return value.IsNumber() ? value.GetNumberAsDouble() : otherwise;
}

}  // namespace pprt
