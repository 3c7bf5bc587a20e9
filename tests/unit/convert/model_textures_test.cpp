// Pictures of a model: each is read once, as far as memory goes.
#include "convert/model/model_textures.h"

#include <catch2/catch.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace pprt::model_textures_test {
namespace {

struct Pictures {
  ModelTextures known;
  std::vector<Texture> textures;
  std::vector<std::string> notes;
  std::vector<std::uint64_t> asked;  // memory that each may take

  explicit Pictures(std::uint64_t max_memory) : known(max_memory) {}

  std::optional<TextureIndex> intern(const std::string& key, int width, bool fails = false) {
    const auto picture = [&](std::uint64_t max_memory) {
      asked.push_back(max_memory);
      if (fails) throw std::runtime_error("no such file");
      return Image(width, 10);
    };
    return known.intern(key, "name of " + key, picture, textures, notes);
  }
};

}  // namespace

TEST_CASE("model textures: a picture is read once, and told by its name") {
  Pictures pictures(1000);
  CHECK(pictures.intern("a", 4) == TextureIndex{0});
  CHECK(pictures.intern("b", 2) == TextureIndex{1});
  CHECK(pictures.intern("a", 9) == TextureIndex{0});
  REQUIRE((pictures.textures.size() == 2 && pictures.asked.size() == 2));
  CHECK((pictures.textures[0].name == "name of a" && pictures.textures[0].width == 4));
  CHECK((pictures.textures[1].name == "name of b" && pictures.textures[1].height == 10));
  CHECK(pictures.notes.empty());
}

TEST_CASE("model textures: each may take the memory that those before have left") {
  Pictures pictures(1000);
  pictures.intern("a", 4);
  pictures.intern("b", 30);
  pictures.intern("c", 1);
  pictures.intern("d", 1);
  CHECK(pictures.asked == std::vector<std::uint64_t>{1000, 880, 0, 0});  // 3 bytes a texel
}

TEST_CASE("model textures: one that cannot be read is told once, and takes no place") {
  Pictures pictures(1000);
  CHECK_FALSE(pictures.intern("gone\n", 4, true));
  CHECK_FALSE(pictures.intern("gone\n", 4));
  CHECK(pictures.intern("b", 4) == TextureIndex{0});
  REQUIRE(pictures.notes.size() == 1);
  CHECK(pictures.notes[0].starts_with("the texture 'gone"));
  CHECK(pictures.notes[0].ends_with("' is left out: no such file"));
  CHECK(pictures.notes[0].find('\n') == std::string::npos);
  CHECK(pictures.asked == std::vector<std::uint64_t>{1000, 1000});
}

}  // namespace pprt::model_textures_test
