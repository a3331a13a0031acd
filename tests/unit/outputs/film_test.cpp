// SPDX-License-Identifier: MIT
#include "outputs/film.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <string>
#include <vector>

#include "outputs/output_file.h"

namespace ziggurat::outputs {
namespace {

namespace fs = std::filesystem;

class Films : public testing::Test {
 protected:
  Films()
      : folder_(fs::path(testing::TempDir()) / ("film." + std::to_string(::getpid()))),
        frame_(std::size_t{16 * 16 * 3}) {
    fs::create_directories(folder_);
    std::iota(frame_.begin(), frame_.end(), std::uint8_t{0});
  }
  ~Films() override { fs::remove_all(folder_); }

  const fs::path folder_;
  const FilmFormat format_{16, 16, 10};
  std::vector<std::uint8_t> frame_;
};

TEST_F(Films, LeavesNoFileWithoutAFrame) {
  { Film film(folder_ / "none.mp4", format_); }
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(Films, IsMadeInEachFormat) {
  for (const char* name : {"a.mp4", "a.webm", "a.webp", "a.gif", "a: b.mp4"}) {
    Film film(folder_ / name, format_);
    for (int i = 0; i < 3; ++i) film.write(frame_);
    film.close();
    EXPECT_GT(fs::file_size(folder_ / name), 100U) << name;
  }
}

TEST_F(Films, HasOneWriter) {
  const fs::path path = folder_ / "film.gif";
  Film first(path, format_), second(path, format_);
  first.write(frame_);
  EXPECT_THROW(second.write(frame_), WriteError);
  first.close();
}

}  // namespace
}  // namespace ziggurat::outputs
