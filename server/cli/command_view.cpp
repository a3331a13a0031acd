// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <boost/program_options/value_semantic.hpp>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "gallery/gallery.h"
#include "gallery/ports.h"
#include "http/port.h"
#include "reports/console.h"
#include "text/hosts.h"
#include "text/numbers.h"
#include "view/access.h"

namespace ziggurat::cli {
namespace {

namespace po = boost::program_options;
namespace fs = std::filesystem;

constexpr int between_looks_ms = 100;  // at signals and pictures

po::options_description gallery_options() {
  po::options_description options("Options of a folder", 96);
  options.add_options()  //
      ("view", po::value<std::string>()->value_name("HOST:PORT"),
       "serve there; default 127.0.0.1:8765, or a free port")(
          "view-token", po::value<std::string>()->value_name("TOKEN"),
          "your own token instead of a random one")(
          "insecure", "allow addresses that other machines can reach");
  return options;
}

bool is_recording(const std::string& path) {
  constexpr std::string_view magic("\x89MCAP0\r\n", 8);
  std::string begin(magic.size(), '\0');
  std::ifstream(path, std::ios::binary)
      .read(begin.data(), static_cast<std::streamsize>(begin.size()));
  return begin == magic;
}

/// @param given  false: the usual port may be another one
std::unique_ptr<http::Port> listen(const http::Address& address, bool given,
                                   gallery::Gallery& gallery) {
  const auto read = [&gallery](std::string_view path) { return gallery.answer(path); };
  http::PortOptions options;
  options.any_host = !http::is_loopback(address.host);
  try {
    return std::make_unique<http::Port>("--view", address, read, options);
  } catch (const std::runtime_error&) {
    if (given) throw;
    return std::make_unique<http::Port>("--view", http::Address{address.host, 0}, read, options);
  }
}

gallery::Settings settings_of(const Values& values, const std::string& folder) {
  const std::string view = values.text("view");
  gallery::Settings settings;
  settings.folder = folder;
  settings.program = fs::read_symlink("/proc/self/exe").string();
  settings.address = http::to_address("--view", view.empty() ? "127.0.0.1:8765" : view);
  settings.insecure = values.has("insecure");
  if (!settings.insecure && !http::is_loopback(settings.address.host)) {
    throw text::UsageError(
        fmt::format("--view: other machines can reach {}; write --insecure if they may run these "
                    "scenes, or 127.0.0.1",
                    settings.address.host));
  }
  settings.token = values.text("view-token");
  if (settings.token.empty()) settings.token = view::random_token();
  view::check_token(settings.token);
  return settings;
}

int serve_folder(const Arguments& arguments, processes::Signals& signals) {
  const Parsed parsed = parse(arguments, gallery_options());
  if (parsed.positional.size() != 1) throw text::UsageError("one folder can be given");
  const Values values(parsed.values);
  gallery::Settings settings = settings_of(values, parsed.positional.front());
  settings.guardian = signals.guardian();
  const http::Address address = settings.address;
  gallery::Gallery gallery(std::move(settings));
  if (gallery.scenes() == 0) {
    throw text::UsageError(
        fmt::format("{} has no scenes: no file .argos below it has a root "
                    "<argos-configuration>",
                    parsed.positional.front()));
  }
  const auto port = listen(address, values.has("view"), gallery);
  reports::Console console;
  const std::string called = gallery::authority(text::host_to_call(address.host), port->number());
  console.notice(fmt::format("{} scenes at http://{}{}", gallery.scenes(), called, gallery.path()));
  if (text::is_every_host(address.host)) console.notice(text::note_of_every_host(address.host));
  console.flush();
  while (signals.take().interruptions == 0) {
    gallery.go_on();
    pollfd news{signals.descriptor(), POLLIN, 0};
    ::poll(&news, 1, between_looks_ms);
  }
  gallery.close();
  const int code = signals.exit_code_of_interruption();
  signals.completed(code);
  return code;
}

Arguments with_view(Arguments arguments) {
  const auto asks = [](const std::string& each) {
    return each == "--view" || each.starts_with("--view=");
  };
  if (std::ranges::none_of(arguments, asks)) arguments.emplace_back("--view");
  return arguments;
}

}  // namespace

std::string help_view() {
  std::ostringstream text;
  text << R"(usage: ziggurat view SCENE [OPTION-OF-RUN]...
       ziggurat view RECORDING [OPTION-OF-REPLAY]...
       ziggurat view FOLDER [OPTION]...

Shows a scene, a recording or a folder of scenes in a browser: open the address that it prints.

  ziggurat view vehicle.argos
      as 'ziggurat run vehicle.argos --view'
  ziggurat view run.mcap
      as 'ziggurat replay run.mcap --view'
  ziggurat view scenes
      a gallery: each scene with its picture and the first sentence of its comment; its button runs it,
      in place of the one before

Pictures are drawn one after the other, and kept in ziggurat/gallery of XDG_CACHE_HOME (~/.cache).

Exit codes: those of run and replay; of a folder 130: interrupted; 1: fault of arguments or folder.

)" << gallery_options();
  return text.str();
}

int execute_view(const Arguments& arguments, processes::Signals& signals) {
  if (arguments.empty() || arguments.front().starts_with('-')) {
    throw text::UsageError(
        "a scene, a recording or a folder must come first, as in: ziggurat view scenes");
  }
  const std::string& path = arguments.front();
  std::error_code error;
  if (fs::is_directory(path, error)) return serve_folder(arguments, signals);
  if (is_recording(path)) return execute_replay(with_view(arguments), signals);
  return execute_run(with_view(arguments), signals);
}

}  // namespace ziggurat::cli
