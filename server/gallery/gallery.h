// SPDX-License-Identifier: MIT
#pragma once
// A page with all scenes of a folder, each of which it runs when it is asked for: `ziggurat view
// FOLDER`. Requests name scenes by their numbers, never files. All needs the token, which stands in
// the path.

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gallery/html.h"
#include "gallery/scenes.h"
#include "http/address.h"
#include "http/answer.h"
#include "processes/child_process.h"

namespace ziggurat::gallery {

struct Settings {
  std::string folder;                             ///< as the user wrote it
  std::string program;                            ///< path of `ziggurat`
  http::Address address;                          ///< where the runs are shown
  bool insecure = false;                          ///< of the runs: other machines may look
  std::string token;                              ///< of the gallery and of its runs
  const processes::Guardian* guardian = nullptr;  ///< ends children if this program is killed
};

/// Its methods may be called on two threads: answer() on that of a port, the others on the main
/// one.
class Gallery {
 public:
  /// @throws std::filesystem::filesystem_error if the folder can't be read
  explicit Gallery(Settings settings);

  /// Answers a request. It never waits.
  /// @param path  of the request
  http::Answer answer(std::string_view path);

  /// Starts the run that was asked for in place of the one before, and goes on with the pictures,
  /// one at a time. Waits only for the end of the run before, seconds at most.
  void go_on();

  std::size_t scenes() const { return scenes_.size(); }
  /// `/TOKEN/`
  const std::string& path() const { return path_; }
  /// Ends the run that is shown, as Ctrl-C does, and a picture on its way.
  void close();

 private:
  struct Drawing {
    std::size_t scene;
    processes::ChildProcess process;
    std::filesystem::path file, part;
    int calls = 0;  ///< of go_on()
  };

  http::Answer page();
  http::Answer picture(std::string_view number);
  http::Answer run(std::string_view number);
  http::Answer wait();
  void start_run();
  void end_run();
  void finish_drawing();
  void begin_drawing();

  const Settings settings_;
  const std::vector<Scene> scenes_;
  const std::filesystem::path cache_;
  const std::string path_;
  std::mutex mutex_;  // of what follows
  std::vector<Picture> pictures_;
  std::optional<std::size_t> wanted_;  ///< scene that is to run, until it is started
  std::optional<processes::ChildProcess> run_;
  std::string run_name_, failure_;  ///< failure_: why it could not be started
  std::uint16_t run_port_ = 0;
  std::optional<Drawing> drawing_;  // main thread only
};

}  // namespace ziggurat::gallery
