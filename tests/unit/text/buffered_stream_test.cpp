// SPDX-License-Identifier: MIT
// Writing to a reader that stops: it takes no time, and what is lost is counted.

#include "text/buffered_stream.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <string>
#include <thread>

namespace ziggurat::text {
namespace {

struct Pipe {
  Pipe() {
    int ends[2];
    EXPECT_EQ(::pipe(ends), 0);
    from = ends[0];
    to = ends[1];
  }
  ~Pipe() {
    ::close(from);
    ::close(to);
  }
  int from = -1, to = -1;
};

TEST(BufferedStream, WritesToAReaderThatStopsWithoutWaiting) {
  const Pipe pipe;
  BufferedStream stream(pipe.to, 1'000'000);
  const std::string line(99, 'x');
  for (int i = 0; i < 100'000; ++i) {
    stream.add(line + "\n");
    ASSERT_EQ(stream.write(), 0);
  }
  EXPECT_FALSE(stream.is_empty());
  EXPECT_EQ(::fcntl(pipe.to, F_GETFL) & O_NONBLOCK, 0) << "other programs share the descriptor";
  stream.add_always("end\n");
  std::size_t read = 0;
  std::string last;
  std::thread reader([&] {
    std::array<char, 65536> part;
    while (!last.ends_with("end\n")) {
      const ssize_t size = ::read(pipe.from, part.data(), part.size());
      ASSERT_GT(size, 0);
      read += static_cast<std::size_t>(size);
      last = (last + std::string(part.data(), static_cast<std::size_t>(size)));
      last = last.substr(last.size() - std::min<std::size_t>(last.size(), 8));
    }
  });
  EXPECT_EQ(stream.finish(), 0);
  reader.join();
  const std::uint64_t dropped = stream.take_dropped();
  EXPECT_GT(dropped, 80'000U);
  EXPECT_EQ(read, (100'000 - dropped) * 100 + 4) << "what was not dropped is there";
  EXPECT_EQ(stream.take_dropped(), 0U);
}

TEST(BufferedStream, SixteenMebibytesWait) {
  const Pipe pipe;
  BufferedStream stream(pipe.to);
  const std::string part(std::size_t{1} << 20, 'x');
  for (int i = 0; i < 16; ++i) stream.add(part);
  EXPECT_EQ(stream.take_dropped(), 0U);
  stream.add("x");
  EXPECT_EQ(stream.take_dropped(), 1U);
}

TEST(BufferedStream, TellsThatTheReaderIsGone) {
  std::signal(SIGPIPE, SIG_IGN);
  Pipe pipe;
  BufferedStream stream(pipe.to);
  ::close(pipe.from);
  stream.add("text");
  EXPECT_EQ(stream.write(), EPIPE);
  pipe.from = ::open("/dev/null", O_RDONLY);
}

}  // namespace
}  // namespace ziggurat::text
