#include "convert/mesh/model_files.h"

#include <assimp/IOStream.hpp>

#include <exception>
#include <memory>
#include <string_view>
#include <system_error>
#include <utility>

namespace pprt {
namespace {

constexpr std::size_t kMark = 3;  // bytes of UTF-8's mark, which some editors put before a text

bool begins_with_mark(Assimp::IOStream& file) {
  char head[kMark] = {};
  const bool has_mark = file.Read(head, 1, kMark) == kMark && std::string_view(head, kMark) == "\xef\xbb\xbf";
  file.Seek(0, aiOrigin_SET);
  return has_mark;
}

// A file without its mark.
class UnmarkedFile : public Assimp::IOStream {
 public:
  explicit UnmarkedFile(std::unique_ptr<Assimp::IOStream> file) : file_(std::move(file)) {
    file_->Seek(kMark, aiOrigin_SET);
  }

  std::size_t Read(void* to, std::size_t size, std::size_t count) override {
    return file_->Read(to, size, count);
  }
  std::size_t Write(const void* /*from*/, std::size_t /*size*/, std::size_t /*count*/) override { return 0; }
  aiReturn Seek(std::size_t offset, aiOrigin from) override {
    return file_->Seek(from == aiOrigin_SET ? offset + kMark : offset, from);
  }
  std::size_t Tell() const override { return file_->Tell() - kMark; }
  std::size_t FileSize() const override { return file_->FileSize() - kMark; }
  void Flush() override {}

 private:
  std::unique_ptr<Assimp::IOStream> file_;
};

}  // namespace

ModelFiles::ModelFiles(const std::filesystem::path& model) : model_(model), folder_(model) {}

// Assimp puts the folder before what a mesh names.
std::string ModelFiles::name_in_folder(const std::string& file) const {
  const std::string folder = model_.parent_path().string();
  if (folder.empty() || !file.starts_with(folder + '/')) return file;
  const std::size_t begin = file.find_first_not_of('/', folder.size());
  return begin == std::string::npos ? "" : file.substr(begin);
}

bool ModelFiles::Exists(const char* file) const {
  try {
    return model_ == file || !folder_.find(name_in_folder(file)).empty();
  } catch (const std::exception&) {
    return false;
  }
}

Assimp::IOStream* ModelFiles::Open(const char* file, const char* mode) {
  if (std::string_view(mode).find_first_of("wa+") != std::string_view::npos) return nullptr;
  if (model_ == file) return note_opened(file, mode);
  const std::string name = name_in_folder(file);
  try {
    return note_opened(folder_.find(name).string(), mode);
  } catch (const std::exception& e) {
    if (!is_guess(name)) unread_.try_emplace(name, e.what());
    return nullptr;
  }
}

Assimp::IOStream* ModelFiles::note_opened(const std::string& path, const char* mode) {
  std::unique_ptr<Assimp::IOStream> stream(DefaultIOSystem::Open(path.c_str(), mode));
  if (stream == nullptr) return nullptr;
  opened_.push_back(path);
  if (begins_with_mark(*stream)) return new UnmarkedFile(std::move(stream));
  return stream.release();
}

// Assimp looks for some files that no mesh names, by the name of the mesh. An .obj comes with an .mtl, a
// .gltf with a .bin.
bool ModelFiles::is_guess(const std::filesystem::path& name) const {
  std::error_code unknown;
  const bool is_there = exists(symlink_status(model_.parent_path() / name, unknown));
  if (is_there || name.stem() != model_.stem() || name.extension() == ".bin") return false;
  return name.extension() != ".mtl" || !unread_.empty();
}

}  // namespace pprt
