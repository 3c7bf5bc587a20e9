// message_seeds DIRECTORY: writes one message of each kind as seeds for fuzz_messages, encoded by the current
// encoders.
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "parallel/protocol/messages.h"
#include "parallel/settings/session_settings.h"

namespace {

void write(const std::filesystem::path& path, char kind, const pprt::Bytes& message) {
  std::ofstream file(path, std::ios::binary);
  file.put(kind);
  file.write(reinterpret_cast<const char*>(message.data()), static_cast<std::streamsize>(message.size()));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const std::filesystem::path directory(argv[1]);
  std::filesystem::create_directories(directory);
  pprt::FrameOrder order;
  order.number = 7, order.carry = pprt::Carry::kCastVerified;
  order.owners = {1, 1, 1, 0, 0, 1}, order.columns = 3, order.tiles = {{1, 2}, {3, 4}};
  write(directory / "order", 0, encode(order));
  pprt::Bundle bundle;
  bundle.progress.mean_weight = 0.5, bundle.samples.resize(3);
  bundle.tiles.given.resize(2), bundle.tiles.changes.resize(1);
  write(directory / "bundle", 1, encode(bundle));
  pprt::PixelMessage pixels;
  pixels.tiles.resize(1), pixels.given = {5}, pixels.colors = {pprt::Color(1, 0.5f, 0)},
                          pixels.samples.resize(2);
  write(directory / "pixels", 2, encode(pixels));
  write(directory / "settings", 3, encode(pprt::SessionSettings{.sampler = pprt::SamplerChoice::kAuto}));
}
