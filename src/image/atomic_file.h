// Reads and writes whole files. Writing is atomic: a file that has its final name is complete.
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>
#include <string_view>

namespace pprt {

// Returns all bytes of a file or pipe. Throws std::runtime_error "cannot read 'PATH': REASON".
std::string read_whole_file(const std::filesystem::path& path);

// Writes to a temporary name in the same directory, then renames it. A reader of PATH finds the old file or
// the whole new one, even if this process dies. Missing directories are created. A symbolic link is replaced,
// not followed; other non-regular files are refused.
//
// Not synced to the disk: that would help against power cuts only, at the cost of the disk's latency per
// frame.
//
// Throws std::runtime_error "cannot write 'PATH': REASON". PATH is then unchanged and the temporary file
// gone.
void write_whole_file(const std::filesystem::path& path, std::string_view bytes);

// The same for content that is never whole in memory: `write` puts all bytes into an unbuffered stream. Its
// exceptions pass through; PATH is then unchanged.
void write_whole_file(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);

}  // namespace pprt
