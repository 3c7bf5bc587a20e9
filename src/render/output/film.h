// The frames of a run as a film, made by ffmpeg.
#pragma once

#include <filesystem>
#include <vector>

namespace pprt {

// Throws std::runtime_error with the package to install when there is no ffmpeg on the PATH.
void require_ffmpeg();

// Writes the pictures as H.264, each as its PNG shows it. An odd width or height gets a black line. Missing
// directories are made; a film that has its name is whole (image/atomic_file.h). Throws std::runtime_error: a
// picture that cannot be read or has another size than the first, or "cannot write 'FILM': ...". What ffmpeg
// says goes to standard error.
void write_film(const std::filesystem::path& film, const std::vector<std::filesystem::path>& pictures,
                double frames_per_second);

}  // namespace pprt
