// message_seeds DIRECTORY: writes one message of each kind as seeds for fuzz_messages, encoded by the current
// encoders.
#include <filesystem>
#include <fstream>
#include <string>

#include "message_kinds.h"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const std::filesystem::path directory(argv[1]);
  std::filesystem::create_directories(directory);
  for (int kind = 0; kind < pprt::message_kinds::kKinds; ++kind) {
    pprt::message_kinds::with_kind(kind, [&](auto decode) {
      const pprt::Bytes message = pprt::message_kinds::example(decode);
      std::ofstream file(directory / std::to_string(kind), std::ios::binary);
      file.put(static_cast<char>(kind));
      file.write(reinterpret_cast<const char*>(message.data()), static_cast<std::streamsize>(message.size()));
    });
  }
}
