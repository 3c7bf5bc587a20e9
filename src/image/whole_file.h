// Whole files, in and out: a file that has its final name holds all of its bytes.
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>
#include <string_view>

namespace pprt {

// All bytes of a file or pipe. Throws std::runtime_error "cannot read 'PATH': REASON".
std::string read_whole_file(const std::filesystem::path& path);

// Writes to a temporary name in the same directory, then renames: whoever opens PATH sees the old file or the
// whole new one, also when this process dies half-way. Missing directories are made. A symbolic link is
// replaced, not followed; anything else but a regular file is refused, so that no device is renamed over.
//
// Not synced to the disk: that would guard against a power cut alone, and costs a disk's latency per frame.
//
// Throws std::runtime_error "cannot write 'PATH': REASON"; then the temporary file is gone and PATH is as it
// was before.
void write_whole_file(const std::filesystem::path& path, std::string_view bytes);

// The same for what is never whole in memory: `write` is given a stream, without a buffer, to put all bytes
// into. What it throws comes through; then PATH is as it was before.
void write_whole_file(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);

}  // namespace pprt
