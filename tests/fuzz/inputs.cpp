// SPDX-License-Identifier: MIT
// Runs inputs that are known, without a fuzzer: fuzz_inputs NAME FOLDER... gives the fuzzer all
// files of the folders, each also with a changed byte, and some drawn inputs. So each build shows
// that the fuzzers still compile, and that what they hold still holds.

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <string>
#include <vector>

#define FUZZER(name)                                            \
  extern "C" int fuzz_##name(const std::uint8_t*, std::size_t); \
  extern "C" __attribute__((weak)) int initialize_##name(int*, char***);
FUZZERS
#undef FUZZER

namespace {

struct Fuzzer {
  int (*run)(const std::uint8_t*, std::size_t);
  int (*initialize)(int*, char***);  // null: there is nothing to initialize
};

const std::map<std::string, Fuzzer> fuzzers{
#define FUZZER(name) {#name, {fuzz_##name, initialize_##name}},
    FUZZERS
#undef FUZZER
};

using Bytes = std::vector<std::uint8_t>;

Bytes read(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

int main(int argc, char** argv) {
  const auto found = fuzzers.find(argc > 1 ? argv[1] : "");
  if (found == fuzzers.end()) {
    std::fprintf(stderr, "usage: fuzz_inputs NAME FOLDER...; there are:");
    for (const auto& [name, fuzzer] : fuzzers) std::fprintf(stderr, " %s", name.c_str());
    std::fprintf(stderr, "\n");
    return 1;
  }
  const Fuzzer& fuzzer = found->second;
  if (fuzzer.initialize) fuzzer.initialize(&argc, &argv);
  std::mt19937 random(1);
  std::size_t inputs = 0;
  const auto run = [&](const Bytes& bytes) {
    fuzzer.run(bytes.data(), bytes.size());
    ++inputs;
  };
  for (int i = 2; i < argc; ++i) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(argv[i])) {
      if (!entry.is_regular_file()) continue;
      Bytes bytes = read(entry.path());
      run(bytes);
      if (bytes.empty()) continue;
      bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
      run(bytes);
    }
  }
  for (std::size_t i = 0; i < 200; ++i) {
    Bytes bytes(random() % 256);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    run(bytes);
  }
  std::printf("%zu inputs\n", inputs);
}
