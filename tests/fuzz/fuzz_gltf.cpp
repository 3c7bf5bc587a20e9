// libFuzzer entry. Files of glTF put together by structure must be an InputError, or a scene that can be
// written as AFF and NFF and read again, as the renderer does.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "aff_invariants.h"
#include "base/diagnostics.h"
#include "convert/gltf/gltf_document.h"
#include "convert/losses.h"
#include "convert/mesh/mesh_reader.h"
#include "gltf_files.h"
#include "parser/aff_parser.h"
#include "parser/nff_parser.h"
#include "scene/animation/resting_nodes.h"
#include "scene/writers/aff_writer.h"
#include "scene/writers/nff_writer.h"

namespace {

// A folder with a picture, whose parent holds the same buffer as it.
class Workplace {
 public:
  Workplace() {
    std::string name = (std::filesystem::temp_directory_path() / "pprt-fuzz-XXXXXX").string();
    pprt::fuzz::require(mkdtemp(name.data()) != nullptr);
    top_ = name;
    std::filesystem::create_directory(top_ / "model");
    write("tiny.ppm", "P3 1 1 255 9 99 199\n");
  }
  ~Workplace() {
    std::error_code ignored;
    std::filesystem::remove_all(top_, ignored);
  }
  Workplace(const Workplace&) = delete;
  Workplace& operator=(const Workplace&) = delete;

  std::string write(const std::string& name, const std::string& bytes) const {
    const std::filesystem::path path = top_ / "model" / name;
    std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
    return path.string();
  }

 private:
  std::filesystem::path top_;
};

// What was read must be written so that it is read again. An exception ends the fuzzer.
void check(const pprt::SceneDescription& scene) {
  std::ostringstream aff;
  pprt::write_aff(scene, aff, std::vector<std::string>(scene.textures.size(), "t.png"));
  const pprt::SceneDescription again = pprt::parse_aff(aff.str(), "again.aff").scene;
  pprt::fuzz::require_indices_in_range(again);
  pprt::fuzz::require_finite_at_all_times(again);
  pprt::fuzz::require(again.lights.size() == scene.lights.size());
  const pprt::SceneDescription still = pprt::still_at(scene, pprt::start_time(scene.movement));
  std::ostringstream nff;
  pprt::write_nff(pprt::for_nff(still).scene, nff);
  pprt::parse_nff(nff.str(), "again.nff", {});
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Workplace workplace;
  const pprt::fuzz::GltfFiles files = pprt::fuzz::gltf_files({data, size});
  pprt::gltf_facts(files.document);
  workplace.write("numbers.bin", files.numbers);
  const std::string path = workplace.write("fuzz.gltf", files.document);
  pprt::SceneDescription scene;
  try {
    scene = pprt::read_mesh(path).scene;
  } catch (const pprt::InputError&) {
    return 0;
  }
  check(scene);
  return 0;
}
