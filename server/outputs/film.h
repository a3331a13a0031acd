// SPDX-License-Identifier: MIT
#pragma once
// A film as a file, made by the program `ffmpeg` of the package of that name.

#include <sys/types.h>

#include <cstdint>
#include <span>
#include <string>

namespace ziggurat::outputs {

struct FilmFormat {
  unsigned width = 0, height = 0;  ///< [px]
  double frames_per_second = 30;   ///< > 0
};

/// The endings of files that can be made, as a sentence for people.
extern const char* const film_endings;
/// Whether the ending of a path is one of these.
bool is_film(const std::string& path);

class Film {
 public:
  /// Nothing is started yet, but what is missing is reported.
  /// @throws WriteError: ffmpeg is not installed, or the file can't be created
  Film(std::string path, const FilmFormat& format);
  /// As close(), whatever happens.
  ~Film();
  Film(const Film&) = delete;
  Film& operator=(const Film&) = delete;

  /// The next frame. @param rgb  width * height * 3 bytes, rows from top to bottom
  /// @throws WriteError with what ffmpeg says, if it has ended
  void write(std::span<const std::uint8_t> rgb);

  /// Completes the file, which can be played then; without any frame there is none. Further calls
  /// do nothing. @throws WriteError
  void close();

  std::uint64_t frames() const { return frames_; }  ///< written
  const std::string& path() const { return path_; }

 private:
  void start();
  [[noreturn]] void fail(const std::string& how);
  std::string complaint() const;
  int end();

  std::string path_;
  FilmFormat format_;
  std::string program_;  // its path
  pid_t id_ = -1;
  int input_ = -1, messages_ = -1;
  std::uint64_t frames_ = 0;
};

}  // namespace ziggurat::outputs
