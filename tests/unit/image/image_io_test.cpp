#include "image/image_io.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <png.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <limits>

#include "image/atomic_file.h"
#include "unit/image/temporary_directory.h"

namespace fs = std::filesystem;
namespace pprt::image_io_test {

namespace {

// Every value is a multiple of 1/4096 below 1/2: exact as half.
Image half_exact_picture(int width, int height) {
  Image image(width, height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const auto value = static_cast<float>(i % 2048) / 4096;
    image.pixels[i] = Color(value, 0.5f - value, -value);
  }
  return image;
}

// All 256 levels in each channel, in different orders.
Image byte_exact_picture() {
  Image image(16, 16);
  for (int i = 0; i < 256; ++i) {
    image.at(i % 16, i / 16) = Color(static_cast<float>(i) / 255, static_cast<float>(255 - i) / 255,
                                     static_cast<float>(i * 7 % 256) / 255);
  }
  return image;
}

// What a byte-wise reader sees in an 8-bit PNG.
std::vector<png_byte> stored_bytes(const std::string& file) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  REQUIRE(png_image_begin_read_from_memory(&image, file.data(), file.size()) != 0);
  REQUIRE(image.format == PNG_FORMAT_RGB);
  std::vector<png_byte> bytes(PNG_IMAGE_SIZE(image));
  REQUIRE(png_image_finish_read(&image, nullptr, bytes.data(), 0, nullptr) != 0);
  return bytes;
}

// A PNG file of any colour type, without its ancillary chunks but the palette and its transparency.
struct PngSource {
  int color_type;
  int bit_depth;
  int width;
  int height;
  std::vector<std::vector<png_byte>> rows;
  std::vector<png_color> palette;
  std::vector<png_byte> palette_alpha;
  int interlace = PNG_INTERLACE_NONE;
};

void write_png_source(const fs::path& path, PngSource source) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  REQUIRE(file != nullptr);
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, file);
  png_set_IHDR(png, info, static_cast<png_uint_32>(source.width), static_cast<png_uint_32>(source.height),
               source.bit_depth, source.color_type, source.interlace, PNG_COMPRESSION_TYPE_BASE,
               PNG_FILTER_TYPE_BASE);
  if (!source.palette.empty()) {
    png_set_PLTE(png, info, source.palette.data(), static_cast<int>(source.palette.size()));
  }
  if (!source.palette_alpha.empty()) {
    png_set_tRNS(png, info, source.palette_alpha.data(), static_cast<int>(source.palette_alpha.size()),
                 nullptr);
  }
  std::vector<png_bytep> rows;
  for (auto& row : source.rows) rows.push_back(row.data());
  png_write_info(png, info);
  png_write_image(png, rows.data());
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  std::fclose(file);
}

Image read_png_source(PngSource source) {
  const TemporaryDirectory directory;
  write_png_source(directory.path() / "p.png", std::move(source));
  return read_image(directory.path() / "p.png");
}

// An EXR file with one channel a name, of pixel type `type`, whose data window begins at (3, -2).
template <typename Value>
void write_exr_source(const fs::path& path, Imf::PixelType type, const std::vector<const char*>& names,
                      const std::vector<Value>& values, int width, int height) {
  const Imath::Box2i window(Imath::V2i(3, -2), Imath::V2i(3 + width - 1, -2 + height - 1));
  Imf::Header header(window, window);
  Imf::FrameBuffer buffer;
  std::size_t channel = 0;
  for (const char* name : names) {
    header.channels().insert(name, Imf::Channel(type));
    buffer.insert(name,
                  Imf::Slice::Make(type, values.data() + channel++, window, names.size() * sizeof(Value)));
  }
  Imf::OutputFile file(path.c_str(), header, 0);
  file.setFrameBuffer(buffer);
  file.writePixels(height);
}

}  // namespace

TEST_CASE("an EXR keeps half values exactly") {
  const Image image = half_exact_picture(37, 41);
  const Image back = decode_exr(encode_exr(image));
  CHECK(back.width == 37);
  CHECK(back.height == 41);
  CHECK(back.pixels == image.pixels);

  // Negative control: the comparison sees one changed value.
  Image changed = image;
  changed.at(36, 40).z += 1.0f / 1024;
  CHECK(decode_exr(encode_exr(changed)).pixels != image.pixels);
}

TEST_CASE("an EXR rounds to the nearest half and clamps to its range") {
  Image image(1, 1);
  image.at(0, 0) = Color(1.0f + 1.0f / 4096, 1e6f, -1e6f);  // halves near 1 are 1/1024 apart
  CHECK(decode_exr(encode_exr(image)).at(0, 0) == Color(1.0f, 65504.0f, -65504.0f));
}

TEST_CASE("a PNG keeps all levels exactly") {
  const Image image = byte_exact_picture();
  const Image back = decode_png(encode_png(image));
  CHECK(back.width == 16);
  CHECK(back.pixels == image.pixels);

  Image changed = image;
  changed.at(3, 5).y += 1.0f / 255;
  CHECK(decode_png(encode_png(changed)).pixels != image.pixels);
}

TEST_CASE("a PNG holds display values, rounded to nearest and clamped") {
  Image image(4, 1);
  image.at(0, 0) = Color(0.078f, 0.361f, 0.753f);  // SPD's background, (20, 92, 192) in 8 bits
  image.at(1, 0) = Color(-1.0f, 2.0f, 0.5f);       // 127.5 is rounded up
  image.at(2, 0) = Color(std::nextafter(0.5f, 0.0f), 1.0f, 0.0f);
  image.at(3, 0) = Color(0.49f / 255, 0.51f / 255, 254.51f / 255);
  CHECK(stored_bytes(encode_png(image)) ==
        std::vector<png_byte>{20, 92, 192, 0, 255, 128, 127, 255, 0, 0, 1, 255});
}

TEST_CASE("equal pictures give equal bytes") {
  const Image image = half_exact_picture(64, 48);
  const Metadata metadata{{"pprt.frame", std::int64_t{7}}, {"pprt.late_ms", -1.5}};
  CHECK(encode_exr(image, metadata) == encode_exr(image, metadata));
  CHECK(encode_png(image, metadata) == encode_png(image, metadata));
}

TEST_CASE("a drawn picture is compressed better as such, and decodes to the same") {
  // At irregular places, but the same in every eighth row.
  Image drawn(128, 128, Color(1, 1, 1));
  for (int y = 0; y < 128; ++y) {
    for (int x = 0; x < 128; ++x) {
      if ((x * (y % 8) * 37) % 101 < 20) drawn.at(x, y) = Color(0, 0.2f, 0.4f);
    }
  }
  const std::string with_patterns = encode_png(drawn, {}, PictureKind::kDrawn), without = encode_png(drawn);
  CHECK(with_patterns.size() < 0.7 * static_cast<double>(without.size()));
  CHECK(decode_png(with_patterns).pixels == decode_png(without).pixels);
}

TEST_CASE("metadata become typed attributes of the EXR header") {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "f.exr";
  write_image(path, Image(2, 2),
              {{"pprt.scene", std::string("spd:tree")},
               {"pprt.frame", std::int64_t{12}},
               {"pprt.rays", std::int64_t{5'000'000'000}},
               {"pprt.late_ms", -2.25}});
  const Imf::InputFile file(path.c_str());
  const Imf::Header& header = file.header();
  CHECK(header.typedAttribute<Imf::StringAttribute>("pprt.scene").value() == "spd:tree");
  CHECK(header.typedAttribute<Imf::IntAttribute>("pprt.frame").value() == 12);
  CHECK(header.typedAttribute<Imf::DoubleAttribute>("pprt.rays").value() == 5e9);
  CHECK(header.typedAttribute<Imf::DoubleAttribute>("pprt.late_ms").value() == -2.25);
  CHECK(header.channels()["R"].type == Imf::HALF);
}

TEST_CASE("channels stand in the EXR beside its colours, exact in 32 bits") {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "c.exr";
  const float infinity = std::numeric_limits<float>::infinity();
  const std::vector<float> depths = {0.1f, infinity, -3, 70000};
  const std::vector<std::uint32_t> ids = {0, 1, 16777217, 4294967295u};
  write_image(path, half_exact_picture(2, 2), {}, {{"depth.Z", depths}, {"id.primitive", ids}});

  std::vector<float> read_depths(4);
  std::vector<std::uint32_t> read_ids(4);
  Imf::InputFile file(path.c_str());
  CHECK(file.header().channels()["depth.Z"].type == Imf::FLOAT);
  CHECK(file.header().channels()["id.primitive"].type == Imf::UINT);
  const Imath::Box2i window = file.header().dataWindow();
  Imf::FrameBuffer buffer;
  buffer.insert("depth.Z", Imf::Slice::Make(Imf::FLOAT, read_depths.data(), window));
  buffer.insert("id.primitive", Imf::Slice::Make(Imf::UINT, read_ids.data(), window));
  file.setFrameBuffer(buffer);
  file.readPixels(window.min.y, window.max.y);
  CHECK(read_depths == depths);
  CHECK(read_ids == ids);
  CHECK(read_image(path).pixels == half_exact_picture(2, 2).pixels);
}

TEST_CASE("an EXR in a hurry holds the same picture in run lengths") {
  const Image image = half_exact_picture(64, 48);
  const auto compression_of = [](const std::string& bytes) {
    const TemporaryDirectory directory;
    const fs::path path = directory.path() / "a.exr";
    write_whole_file(path, bytes);
    return Imf::InputFile(path.c_str()).header().compression();
  };
  const std::string hurried = encode_exr(image, {}, {}, PictureKind::kHurried);
  CHECK(compression_of(hurried) == Imf::RLE_COMPRESSION);
  CHECK(compression_of(encode_exr(image)) == Imf::ZIP_COMPRESSION);
  CHECK(decode_exr(hurried).pixels == image.pixels);
}

TEST_CASE("a channel that does not fit is refused") {
  const Image image(2, 1);
  const auto encode = [&](const Channel& channel) { return encode_exr(image, {}, {channel}); };
  CHECK_NOTHROW(encode({"a.Y", std::vector<float>(2)}));
  CHECK_THROWS_WITH(encode({"a.Y", std::vector<float>(3)}), "the channel 'a.Y' has not the picture's size");
  CHECK_THROWS_WITH(encode({"R", std::vector<float>(2)}), "the channel 'R' is there already");
  CHECK_THROWS_WITH(encode({"a.Y", std::vector<float>(2, std::numeric_limits<float>::quiet_NaN())}),
                    "the channel 'a.Y' has values that are no numbers");
}

TEST_CASE("metadata become texts of the PNG") {
  const std::string file = encode_png(Image(2, 2), {{"pprt.frame", std::int64_t{12}},
                                                    {"pprt.late_ms", 0.1},
                                                    {"pprt.scene", std::string("b\xc3\xa4ume.nff")}});
  using namespace std::string_literals;
  CHECK(file.find("tEXtpprt.frame\0"s + "12") != file.npos);
  CHECK(file.find("tEXtpprt.late_ms\0"s + "0.1") != file.npos);
  CHECK(file.find("iTXtpprt.scene") != file.npos);
  CHECK(file.find("b\xc3\xa4ume.nff") != file.npos);
}

TEST_CASE("metadata with a name that the format refuses are an error") {
  CHECK_THROWS_WITH(encode_exr(Image(1, 1), {{"channels", 1.0}}), Catch::Contains("'channels'"));
  CHECK_THROWS_WITH(encode_exr(Image(1, 1), {{"a", 1.0}, {"a", 2.0}}), Catch::Contains("'a'"));
  CHECK_THROWS_WITH(encode_exr(Image(1, 1), {{"", 1.0}}), Catch::Contains("name"));
  CHECK_THROWS_WITH(encode_png(Image(1, 1), {{std::string(80, 'n'), 1.0}}), Catch::Contains("nnn"));
}

TEST_CASE("values that are not finite are replaced and counted, and refused by the encoders") {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  Image image(3, 1, Color(0.25f, 0.5f, 0.75f));
  image.at(0, 0).x = nan;
  image.at(2, 0) = Color(infinity, 0.5f, -infinity);
  CHECK_THROWS_WITH(encode_exr(image), "2 pixels are not finite");
  CHECK_THROWS_WITH(encode_png(image), "2 pixels are not finite");

  CHECK(replace_non_finite(image) == 2);
  CHECK(image.pixels ==
        std::vector<Color>{Color(0, 0.5f, 0.75f), Color(0.25f, 0.5f, 0.75f), Color(0, 0.5f, 0)});
  CHECK(replace_non_finite(image) == 0);
}

TEST_CASE("an empty or inconsistent picture is refused") {
  Image inconsistent(2, 2);
  inconsistent.pixels.pop_back();
  CHECK_THROWS_WITH(encode_exr(Image()), "0 pixels make no picture of 0x0");
  CHECK_THROWS_WITH(encode_png(inconsistent), "3 pixels make no picture of 2x2");
}

TEST_CASE("a picture is written under its name or not at all") {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "out/0001.png";
  write_image(path, byte_exact_picture());
  CHECK(read_image(path).pixels == byte_exact_picture().pixels);

  const std::string wrong = (directory.path() / "out/0001.jpg").string();
  CHECK_THROWS_WITH(write_image(wrong, Image(1, 1)),
                    "cannot write '" + wrong + "': the name ends neither in .exr nor in .png");
  const std::string under_file = (path / "0001.exr").string();
  CHECK_THROWS_WITH(write_image(under_file, Image(1, 1)),
                    "cannot write '" + under_file + "': Not a directory");
}

TEST_CASE("PNGs of every colour type are read") {
  SECTION("one-bit grey") {
    const Image image = read_png_source({PNG_COLOR_TYPE_GRAY, 1, 2, 1, {{0x40}}, {}, {}});
    CHECK(image.pixels == std::vector<Color>{Color(0.0f), Color(1.0f)});
  }
  SECTION("eight-bit grey and alpha: black shines through") {
    const Image image = read_png_source({PNG_COLOR_TYPE_GRAY_ALPHA, 8, 2, 1, {{51, 255, 255, 51}}, {}, {}});
    CHECK(image.pixels == std::vector<Color>{Color(0.2f), Color(0.2f)});
  }
  SECTION("sixteen-bit colour") {
    const Image image =
        read_png_source({PNG_COLOR_TYPE_RGB, 16, 1, 1, {{0x00, 0x01, 0x80, 0x00, 0xff, 0xff}}, {}, {}});
    CHECK(image.at(0, 0) == Color(1.0f / 65535, 32768.0f / 65535, 1.0f));
  }
  SECTION("palette with transparency") {
    const Image image = read_png_source(
        {PNG_COLOR_TYPE_PALETTE, 2, 2, 1, {{0x40}}, {{255, 255, 255}, {255, 51, 0}}, {255, 51}});
    REQUIRE(image.pixels.size() == 2);
    CHECK(image.at(1, 0) == Color(1.0f));
    CHECK(image.at(0, 0) == Color(0.2f, 0.2f * 0.2f, 0.0f));
  }
  SECTION("interlaced") {
    PngSource source{PNG_COLOR_TYPE_GRAY, 8, 9, 9, {}, {}, {}};
    source.interlace = PNG_INTERLACE_ADAM7;
    for (int y = 0; y < 9; ++y) {
      source.rows.emplace_back(9, static_cast<png_byte>(0));
      source.rows.back()[static_cast<std::size_t>(y)] = 255;
    }
    const Image image = read_png_source(source);
    for (int y = 0; y < 9; ++y) {
      for (int x = 0; x < 9; ++x) CHECK(image.at(x, y) == Color(x == y ? 1.0f : 0.0f));
    }
  }
}

TEST_CASE("EXRs of every pixel type are read, wherever their data window lies") {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "f.exr";
  SECTION("float") {
    write_exr_source<float>(path, Imf::FLOAT, {"B", "G", "R"}, {1, 2, 3.25f, 1e6f, 5, 6}, 2, 1);
    CHECK(read_image(path).pixels == std::vector<Color>{Color(3.25f, 2, 1), Color(6, 5, 1e6f)});
  }
  SECTION("whole numbers, beside a channel that is not asked for") {
    write_exr_source<unsigned>(path, Imf::UINT, {"A", "R", "G", "B"}, {9, 1, 2, 3, 9, 4, 5, 6}, 1, 2);
    CHECK(read_image(path).pixels == std::vector<Color>{Color(1, 2, 3), Color(4, 5, 6)});
  }
  SECTION("grey") {
    write_exr_source<half>(path, Imf::HALF, {"Y"}, {half(0.5f), half(0.25f)}, 2, 1);
    CHECK(read_image(path).pixels == std::vector<Color>{Color(0.5f), Color(0.25f)});
  }
  SECTION("no colour in it") {
    write_exr_source<float>(path, Imf::FLOAT, {"Z"}, {1}, 1, 1);
    CHECK_THROWS_WITH(read_image(path), Catch::Contains(path.string()) && Catch::Contains("no channel R"));
  }
}

TEST_CASE("PPMs are read, as bytes or as text, with comments and with bytes behind the picture") {
  const Color a(1, 0, 0), b(0, 102 / 255.F, 1);
  for (const std::string& whole : {std::string("P6\n# marble\xe4\n2 1\n255\n\xff\0\0\0\x66\xff!", 28),
                                   std::string("P3 2 1 # size\n255 255 0 0\n0 102 255\n")}) {
    const Image image = decode_ppm(whole);
    REQUIRE((image.width == 2 && image.height == 1));
    CHECK((image.at(0, 0) - a).length() < 1e-6F);
    CHECK((image.at(1, 0) - b).length() < 1e-6F);
  }
  CHECK(decode_ppm("P3 1 1 15 15 5 0").at(0, 0).y == Approx(1 / 3.0));
  for (const char* broken :
       {"P6", "P6 2", "P6 2 1 255", "P6 2 1 255 abc", "P6 0 1 255 abc", "P6 1 1 65535 abcdef", "P6 1 1 0 abc",
        "P6 -1 1 255 abc", "P6 99999999999 1 255 abc", "P3 1 1 255 1 2", "P6 2000000000 2000000000 255 abc",
        "P3 1 1 255 x y z"})
    CHECK_THROWS_AS(decode_ppm(broken), std::runtime_error);
}

TEST_CASE("a JPEG decodes to nearly what was encoded, and one that is cut short to an error") {
  Image image(16, 16, Color(0.2F, 0.6F, 0.8F));
  const std::string bytes = encode_jpeg(image, 95);
  const Image back = decode_jpeg(bytes);
  REQUIRE((back.width == 16 && back.height == 16));
  CHECK((back.at(7, 9) - image.at(7, 9)).length() < 0.02F);
  CHECK_THROWS_AS(decode_jpeg(bytes.substr(0, bytes.size() / 2)), std::runtime_error);
  CHECK_THROWS_AS(decode_jpeg("\xff\xd8"), std::runtime_error);
}

TEST_CASE("damaged files are errors that name the file") {
  const TemporaryDirectory directory;
  const Image image = half_exact_picture(40, 40);
  const auto message_for = [&](const std::string& bytes) {
    write_whole_file(directory.path() / "damaged", bytes);
    try {
      read_image(directory.path() / "damaged");
    } catch (const std::runtime_error& e) {
      return std::string(e.what());
    }
    return std::string("no error");
  };
  const std::string prefix = "cannot read '" + (directory.path() / "damaged").string() + "': ";
  CHECK(message_for("") == prefix + "the file is empty");
  CHECK(message_for("P7 1 1 255\n123") == prefix + "it is no OpenEXR, PNG, JPEG or PPM file");
  for (const bool exr : {true, false}) {
    const std::string whole = exr ? encode_exr(image) : encode_png(image);
    const std::string kind = exr ? "it is no whole OpenEXR picture: " : "it is no whole PNG picture: ";
    for (const std::size_t kept : {std::size_t{8}, whole.size() / 2, whole.size() - 13}) {
      CAPTURE(exr, kept);
      CHECK_THAT(message_for(whole.substr(0, kept)), Catch::StartsWith(prefix + kind));
    }
  }
  std::string hostile = encode_png(image);
  hostile.replace(16, 8, std::string("\x00\x0f\x00\x00\x00\x0f\x00\x00", 8));  // 983040 x 983040, wrong CRC
  CHECK_THAT(message_for(hostile), Catch::StartsWith(prefix));
}

TEST_CASE("images: a picture that takes too much memory is refused by its header, before it is decoded") {
  const Image image(300, 200, Color(0.5f));
  const std::string png = encode_png(image);
  const auto refused = Catch::Contains("decoding 300x200 pixels takes 1.2 MB of memory, and 1 MB are left");
  for (const std::string& bytes : {png, encode_exr(image), encode_jpeg(image, 90),
                                   "P6 300 200 255\n" + std::string(180'000, 'a'), png.substr(0, 60)}) {
    CHECK_THROWS_WITH(decode_image(bytes, 1'000'000), refused);
  }
  CHECK(decode_image(png, 1'200'000).width == 300);
}

}  // namespace pprt::image_io_test
