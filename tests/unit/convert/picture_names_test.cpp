// Names of the pictures beside a scene.
#include "convert/names/picture_names.h"

#include <catch2/catch.hpp>

#include "convert/names/extension.h"

namespace pprt::picture_names_test {
namespace {

std::vector<std::string> names_of(const std::vector<std::string>& textures, const std::string& stem = "s") {
  SceneDescription scene;
  for (const std::string& name : textures) scene.textures.emplace_back().name = name;
  return picture_names(scene, stem);
}

using Names = std::vector<std::string>;

}  // namespace

TEST_CASE("picture names: the scene's stem and the texture's, without its folder and its extension") {
  CHECK(names_of({"wood.ppm", "dir/stone.tar.exr", "plain"}) ==
        Names{"s-wood.png", "s-stone.tar.png", "s-plain.png"});
}

TEST_CASE("picture names: of equal ones the later have a number, from 2 on") {
  CHECK(names_of({"a.ppm", "a.png", "b/a.exr", "a-2.png"}) ==
        Names{"s-a.png", "s-a-2.png", "s-a-3.png", "s-a-2-2.png"});
}

TEST_CASE("picture names: blanks and characters with a meaning become underscores, letters stay") {
  CHECK(names_of({"a b\t#%{}\"'\\*:c.png"}, "my scene") == Names{"my_scene-a_b__________c.png"});
  CHECK(names_of({"\xc3\xa9-_.~.png"}) == Names{"s-\xc3\xa9-_.~.png"});
  CHECK(names_of({}).empty());
}

TEST_CASE("picture names: an extension is told in lower case, with its dot") {
  CHECK(extension_of("a/B.GLB") == ".glb");
  CHECK(extension_of("a.tar.Gz") == ".gz");
  CHECK(extension_of("a.d/plain").empty());
  CHECK(extension_of(".aff").empty());  // a hidden file without one
}

}  // namespace pprt::picture_names_test
