// SPDX-License-Identifier: MIT
#pragma once
// The name of an output, before the file is opened: opening it empties what is there.

#include <span>
#include <string>
#include <vector>

namespace ziggurat::outputs {

/// Output that an option names. `-` is stdout.
struct OutputName {
  std::string option;  ///< such as "--csv"
  std::string path;
  std::vector<std::string>
      endings;  ///< of names of files with this content, such as ".csv"; empty: any
};

/// A file that an output must not replace: the command reads it, or writes something else to it.
struct TakenFile {
  std::string path;
  std::string what;  ///< in a message, such as "the recording itself"
};

/// Whether both paths are one file, by links too. What several may write to at once, a device or a
/// pipe, is not.
bool is_one_file(const std::string& a, const std::string& b);

/// Checks that the name has the ending of its content, and the file is not taken. A file of another
/// kind that ziggurat reads, known by its ending, would be lost, and is refused: a scene, a script,
/// a recording, a database. Pipes, devices and `-` need no ending.
/// @throws text::UsageError
void check_output(const OutputName& output, std::span<const TakenFile> taken = {});

}  // namespace ziggurat::outputs
