#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "image/image_io.h"
#include "image/picture_checks.h"

namespace pprt {
namespace {

// No compression threads: they would take cores from the ranks.
constexpr int kThreads = 0;

// Chosen by measurement: docs/decisions/0005-picture-encoding.md.
constexpr int kZipLevel = 1;

class StringOutput : public Imf::OStream {
 public:
  StringOutput() : OStream("a picture in memory") {}

  void write(const char bytes[], int count) override {
    const auto size = static_cast<std::size_t>(count);
    if (position_ + size > bytes_.size()) bytes_.resize(position_ + size);
    std::memcpy(bytes_.data() + position_, bytes, size);
    position_ += size;
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = position; }

  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
  std::uint64_t position_ = 0;
};

class ViewInput : public Imf::IStream {
 public:
  explicit ViewInput(std::string_view bytes) : IStream("a picture in memory"), bytes_(bytes) {}

  bool read(char bytes[], int count) override {
    const auto size = static_cast<std::size_t>(count);
    if (position_ > bytes_.size() || size > bytes_.size() - position_) {
      throw std::runtime_error("the file ends early");
    }
    std::memcpy(bytes, bytes_.data() + position_, size);
    position_ += size;
    return position_ < bytes_.size();
  }
  std::uint64_t tellg() override { return position_; }
  void seekg(std::uint64_t position) override { position_ = position; }

 private:
  std::string_view bytes_;
  std::uint64_t position_ = 0;
};

struct ToAttribute {
  Imf::Header& header;
  const std::string& name;

  void operator()(const std::string& text) const { header.insert(name, Imf::StringAttribute(text)); }
  void operator()(double number) const { header.insert(name, Imf::DoubleAttribute(number)); }
  void operator()(std::int64_t number) const {
    if (number >= std::numeric_limits<int>::min() && number <= std::numeric_limits<int>::max()) {
      header.insert(name, Imf::IntAttribute(static_cast<int>(number)));
    } else {
      header.insert(name, Imf::DoubleAttribute(static_cast<double>(number)));
    }
  }
};

Imf::Header make_header(const Image& image, const Metadata& metadata, PictureKind kind) {
  Imf::Header header(image.width, image.height);
  for (const auto& [name, value] : metadata) {
    if (header.find(name) != header.end()) {
      throw std::runtime_error(fmt::format("the attribute '{}' is there already, or OpenEXR's own", name));
    }
    std::visit(ToAttribute{header, name}, value);
  }
  header.compression() = kind == PictureKind::kHurried ? Imf::RLE_COMPRESSION : Imf::ZIP_COMPRESSION;
  header.zipCompressionLevel() = kZipLevel;
  for (const char* channel : {"R", "G", "B"}) header.channels().insert(channel, Imf::Channel(Imf::HALF));
  return header;
}

// Adds a channel to the header and the frame buffer. The buffer refers to its values, which must stay in
// place until they are written.
void add_channel(const Channel& channel, const Image& image, Imf::Header& header, Imf::FrameBuffer& buffer) {
  if (header.channels().findChannel(channel.name) != nullptr) {
    throw std::runtime_error(fmt::format("the channel '{}' is there already", channel.name));
  }
  const auto add = [&](Imf::PixelType type, const auto& values) {
    if (values.size() != image.pixels.size()) {
      throw std::runtime_error(fmt::format("the channel '{}' has not the picture's size", channel.name));
    }
    header.channels().insert(channel.name, Imf::Channel(type));
    buffer.insert(channel.name, Imf::Slice::Make(type, values.data(), header.dataWindow()));
  };
  if (const auto* numbers = std::get_if<std::vector<std::uint32_t>>(&channel.values)) {
    return add(Imf::UINT, *numbers);
  }
  const auto& floats = std::get<std::vector<float>>(channel.values);
  if (std::any_of(floats.begin(), floats.end(), [](float v) { return std::isnan(v); })) {
    throw std::runtime_error(fmt::format("the channel '{}' has values that are no numbers", channel.name));
  }
  add(Imf::FLOAT, floats);
}

std::vector<half> to_half(const Image& image) {
  constexpr auto kHalfMax = static_cast<float>(HALF_MAX);
  std::vector<half> halves(image.pixels.size() * 3);
  const float* channels = &image.pixels.front().x;
  for (std::size_t i = 0; i < halves.size(); ++i) halves[i] = std::clamp(channels[i], -kHalfMax, kHalfMax);
  return halves;
}

// Describes one channel of interleaved RGB. `first` is its value in the window's upper left pixel.
template <typename Value>
Imf::Slice slice(Imf::PixelType type, Value* first, const Imath::Box2i& window) {
  return Imf::Slice::Make(type, first, window, 3 * sizeof(Value));
}

using ChannelNames = std::vector<const char*>;

// Returns the channels to read: R, G and B, or Y alone. Throws std::runtime_error for any other set.
ChannelNames channels_to_read(const Imf::ChannelList& channels) {
  const auto has = [&](const char* name) { return channels.findChannel(name) != nullptr; };
  ChannelNames names{"R", "G", "B"};
  const bool has_color = has("RY") || has("BY") || std::any_of(names.begin(), names.end(), has);
  if (has("Y") && !has_color) names = {"Y"};
  for (const char* name : names) {
    if (!has(name)) throw std::runtime_error(fmt::format("it has no channel {}", name));
    const Imf::Channel& channel = channels[name];
    if (channel.xSampling != 1 || channel.ySampling != 1) {
      throw std::runtime_error(fmt::format("channel {} is subsampled, which is not supported", name));
    }
  }
  return names;
}

}  // namespace

std::string encode_exr(const Image& image, const Metadata& metadata, const std::vector<Channel>& channels,
                       PictureKind kind) {
  require_encodable(image);
  try {
    Imf::Header header = make_header(image, metadata, kind);
    std::vector<half> halves = to_half(image);
    Imf::FrameBuffer buffer;
    std::size_t offset = 0;
    for (const char* channel : {"R", "G", "B"}) {
      buffer.insert(channel, slice(Imf::HALF, halves.data() + offset++, header.dataWindow()));
    }
    for (const Channel& channel : channels) add_channel(channel, image, header, buffer);
    StringOutput output;
    {
      Imf::OutputFile file(output, header, kThreads);
      file.setFrameBuffer(buffer);
      file.writePixels(image.height);
    }  // the line offset table is written here
    return output.take();
  } catch (const std::exception& e) {  // Iex exceptions derive from it alone
    throw std::runtime_error(e.what());
  }
}

Image decode_exr(std::string_view bytes, std::uint64_t max_memory) {
  try {
    ViewInput input(bytes);
    Imf::InputFile file(input, kThreads);
    const Imath::Box2i window = file.header().dataWindow();
    const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
    const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
    require_decodable_size(width, height, max_memory);
    const ChannelNames channels = channels_to_read(file.header().channels());

    Image image(static_cast<int>(width), static_cast<int>(height));
    Imf::FrameBuffer buffer;
    for (std::size_t c = 0; c < channels.size(); ++c) {
      buffer.insert(channels[c], slice(Imf::FLOAT, &image.pixels.front().x + c, window));
    }
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y, window.max.y);
    if (channels.size() == 1) {
      for (Color& pixel : image.pixels) pixel = Color(pixel.x);
    }
    return image;
  } catch (const std::exception& e) {
    throw std::runtime_error(fmt::format("it is no whole OpenEXR picture: {}", e.what()));
  }
}

}  // namespace pprt
