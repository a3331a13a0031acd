#pragma once
// The file on disk, which has whole records only, also if the disk is full.

#include <cstdint>
#include <string>
#include <string_view>

namespace ziggurat::recorder {

class Disk {
 public:
  /// Creates the file, or empties it. @throws recording::WriteError
  explicit Disk(std::string path);
  ~Disk();
  Disk(const Disk&) = delete;
  Disk& operator=(const Disk&) = delete;

  /// Writes all bytes, or takes what was written of them back. @throws recording::WriteError
  void write(std::string_view bytes);
  /// @throws recording::WriteError
  void close();

 private:
  [[noreturn]] void fail(int error);

  std::string path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;  // of what was written whole [bytes]
};

}  // namespace ziggurat::recorder
