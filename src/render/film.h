// The frames of a run as a film, which ffmpeg makes.
#pragma once

#include <filesystem>
#include <vector>

namespace pprt {

// Throws UsageError unless the name ends in .mp4 or .mkv.
void require_film_name(const std::filesystem::path& film);

// Throws std::runtime_error, which says what to install, when there is no ffmpeg on the PATH.
void require_ffmpeg();

// H.264 of what a PNG of each picture shows; an odd width or height gets a black line. Missing directories
// are made, and a film that has its name is whole. Throws std::runtime_error: a picture that cannot be read
// or has another size than the first, or "cannot write 'FILM': ...", what ffmpeg says of it being on standard
// error.
void write_film(const std::filesystem::path& film, const std::vector<std::filesystem::path>& pictures,
                double frames_per_second);

}  // namespace pprt
