// libpng reports errors by longjmp, which must not leave a function that owns objects with destructors. Each
// direction therefore has functions that only use what their caller prepared.
#include <fmt/core.h>
#include <png.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include "image/display_bytes.h"
#include "image/image_io.h"
#include "image/picture_checks.h"

namespace pprt {
namespace {

struct Packing {
  int zlib_level, zlib_strategy, filter;
};

// Chosen by measurement: docs/decisions/0005-picture-encoding.md.
constexpr Packing packing_of(PictureKind kind) {
  if (kind == PictureKind::kDrawn) return {2, Z_DEFAULT_STRATEGY, PNG_FILTER_UP};
  return {1, Z_RLE, PNG_FILTER_SUB};  // run-length coding ignores the level
}

constexpr std::size_t kMaxTextName = 79;  // the format's limit

// State that libpng's callbacks reach through its user pointers.
struct Stream {
  std::string output;             // encoded bytes so far
  std::string_view input;         // bytes still to be decoded
  std::array<char, 128> error{};  // copy of libpng's message, which is lost with the jump
};

void note_error(png_structp png, png_const_charp message) {
  auto& error = static_cast<Stream*>(png_get_error_ptr(png))->error;
  std::snprintf(error.data(), error.size(), "%s", message);
  png_longjmp(png, 1);
}

void ignore_warning(png_structp, png_const_charp) {}

void append_output(png_structp png, png_bytep bytes, std::size_t size) {
  bool appended = true;
  try {
    static_cast<Stream*>(png_get_io_ptr(png))->output.append(reinterpret_cast<const char*>(bytes), size);
  } catch (const std::exception&) {
    appended = false;  // no exception may pass through libpng, and no jump may leave a handler
  }
  if (!appended) png_error(png, "out of memory");
}

void flush_output(png_structp) {}

void take_input(png_structp png, png_bytep bytes, std::size_t size) {
  std::string_view& input = static_cast<Stream*>(png_get_io_ptr(png))->input;
  if (input.size() < size) png_error(png, "the file ends early");
  std::memcpy(bytes, input.data(), size);
  input.remove_prefix(size);
}

// libpng's two structures, for one direction.
struct Writer {
  png_structp png;
  png_infop info;

  explicit Writer(Stream& stream)
      : png(png_create_write_struct(PNG_LIBPNG_VER_STRING, &stream, note_error, ignore_warning)),
        info(png != nullptr ? png_create_info_struct(png) : nullptr) {
    if (info == nullptr) throw std::runtime_error("libpng cannot be set up");
    png_set_write_fn(png, &stream, append_output, flush_output);
  }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  ~Writer() { png_destroy_write_struct(&png, &info); }
};

struct Reader {
  png_structp png;
  png_infop info;

  explicit Reader(Stream& stream)
      : png(png_create_read_struct(PNG_LIBPNG_VER_STRING, &stream, note_error, ignore_warning)),
        info(png != nullptr ? png_create_info_struct(png) : nullptr) {
    if (info == nullptr) throw std::runtime_error("libpng cannot be set up");
    png_set_read_fn(png, &stream, take_input);
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
};

struct ToText {
  std::string operator()(const std::string& text) const { return text; }
  std::string operator()(double number) const { return fmt::format("{}", number); }
  std::string operator()(std::int64_t number) const { return fmt::format("{}", number); }
};

// Names and values as png_text entries, which point to the strings kept here.
struct Texts {
  std::vector<std::pair<std::string, std::string>> strings;
  std::vector<png_text> entries;

  explicit Texts(const Metadata& metadata) {
    strings.reserve(metadata.size());
    for (const auto& [name, value] : metadata) {
      const bool printable =
          std::all_of(name.begin(), name.end(), [](char c) { return c >= ' ' && c <= '~'; });
      if (name.empty() || name.size() > kMaxTextName || !printable) {
        throw std::runtime_error(fmt::format("'{}' cannot be the name of a text in a PNG file", name));
      }
      auto& [key, text] = strings.emplace_back(name, std::visit(ToText{}, value));
      png_text& entry = entries.emplace_back();
      const bool ascii = std::all_of(text.begin(), text.end(), [](char c) { return c > 0; });
      entry.compression = ascii ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
      entry.key = key.data();
      entry.text = text.data();
      entry.text_length = ascii ? text.size() : 0;
      entry.itxt_length = ascii ? 0 : text.size();
    }
  }
};

bool write_rows(Writer& writer, png_uint_32 width, png_uint_32 height, png_const_bytep rows, png_textp texts,
                int text_count, const Packing& packing) {
  if (setjmp(png_jmpbuf(writer.png)) != 0) return false;
  png_set_IHDR(writer.png, writer.info, width, height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_BASE, PNG_FILTER_TYPE_BASE);
  png_set_compression_level(writer.png, packing.zlib_level);
  png_set_compression_strategy(writer.png, packing.zlib_strategy);
  png_set_filter(writer.png, PNG_FILTER_TYPE_BASE, packing.filter);
  if (text_count > 0) png_set_text(writer.png, writer.info, texts, text_count);
  png_write_info(writer.png, writer.info);
  for (png_uint_32 y = 0; y < height; ++y) png_write_row(writer.png, rows + std::size_t{3} * width * y);
  png_write_end(writer.png, nullptr);
  return true;
}

bool read_header(Reader& reader) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  png_read_info(reader.png, reader.info);
  return true;
}

// Reads rows of big-endian 16-bit RGBA, whatever the file holds.
bool read_rows(Reader& reader, png_bytepp rows) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  png_set_expand_16(reader.png);
  png_set_gray_to_rgb(reader.png);
  png_set_add_alpha(reader.png, 0xffff, PNG_FILLER_AFTER);
  png_read_image(reader.png, rows);
  png_read_end(reader.png, nullptr);
  return true;
}

float channel(const png_byte* big_endian) {
  return static_cast<float>(big_endian[0] * 256 + big_endian[1]) / 65535.0f;
}

}  // namespace

std::string encode_png(const Image& image, const Metadata& metadata, PictureKind kind) {
  require_encodable(image);
  const std::vector<png_byte> bytes = display_bytes(image);
  Texts texts(metadata);
  Stream stream;
  Writer writer(stream);
  if (!write_rows(writer, static_cast<png_uint_32>(image.width), static_cast<png_uint_32>(image.height),
                  bytes.data(), texts.entries.data(), static_cast<int>(texts.entries.size()),
                  packing_of(kind))) {
    throw std::runtime_error(stream.error.data());
  }
  return std::move(stream.output);
}

TransparentImage decode_transparent_png(std::string_view bytes, std::uint64_t max_memory) {
  Stream stream;
  stream.input = bytes;
  Reader reader(stream);
  const auto fail = [&] {
    throw std::runtime_error(fmt::format("it is no whole PNG picture: {}", stream.error.data()));
  };
  if (!read_header(reader)) fail();
  const std::size_t width = png_get_image_width(reader.png, reader.info);
  const std::size_t height = png_get_image_height(reader.png, reader.info);
  require_decodable_size(static_cast<std::int64_t>(width), static_cast<std::int64_t>(height), max_memory);

  constexpr std::size_t kPixelBytes = 8;
  std::vector<png_byte> samples(width * height * kPixelBytes);
  std::vector<png_bytep> rows(height);
  for (std::size_t y = 0; y < height; ++y) rows[y] = samples.data() + y * width * kPixelBytes;
  if (!read_rows(reader, rows.data())) fail();

  TransparentImage image{Image(static_cast<int>(width), static_cast<int>(height)), {}};
  image.alpha.reserve(image.colors.pixels.size());
  const png_byte* sample = samples.data();
  for (Color& pixel : image.colors.pixels) {
    pixel = Color(channel(sample), channel(sample + 2), channel(sample + 4));
    image.alpha.push_back(channel(sample + 6));
    sample += kPixelBytes;
  }
  const bool is_opaque = std::all_of(image.alpha.begin(), image.alpha.end(), [](float a) { return a == 1; });
  if (is_opaque) image.alpha.clear();
  return image;
}

Image decode_png(std::string_view bytes, std::uint64_t max_memory) {
  TransparentImage image = decode_transparent_png(bytes, max_memory);
  for (std::size_t i = 0; i < image.alpha.size(); ++i) image.colors.pixels[i] *= image.alpha[i];
  return std::move(image.colors);
}

}  // namespace pprt
