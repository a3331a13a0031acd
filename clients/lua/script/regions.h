#pragma once
// Memory for many states, one region each, side by side: the system can hold it in large pages.

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <span>

namespace ziggurat::lua {

class Regions {
 public:
  /// An empty state and a small script with its tables take 40 kB; the collector lets it grow by as
  /// much again. An odd number of lines of the cache, so that the same part of all states is not in
  /// the same few sets of it.
  static constexpr std::size_t size = (std::size_t{96} << 10) + 64;  ///< of a region [bytes]

  /// If there is no memory for them, they are empty.
  explicit Regions(std::size_t count);
  std::span<std::byte> operator[](std::size_t index) const;

 private:
  struct Free {
    void operator()(std::byte* memory) const { std::free(memory); }
  };
  std::unique_ptr<std::byte, Free> memory_;
};

}  // namespace ziggurat::lua
