// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/arguments.h"
#include "cli/atomic_file.h"
#include "cli/commands.h"
#include "outputs/output_name.h"
#include "recording/mcap/repair.h"
#include "recording/mcap/scan.h"
#include "recording/recorder/disk.h"
#include "recording/recorder/overview.h"
#include "reports/console.h"
#include "text/numbers.h"
#include "text/printable.h"

namespace ziggurat::cli {
namespace {

namespace po = boost::program_options;

po::options_description info_options() {
  po::options_description options("Options");
  options.add_options()  //
      ("repair", po::value<std::string>()->value_name("OUT.mcap"),
       "write a whole file with everything that is intact")  //
      ("json", "as JSON on stdout");
  return options;
}

/// Content of a file, as far as it could be read.
struct Examined {
  std::string path;
  std::uint64_t size = 0;  // [bytes]
  mcap::Scan scan;
  recorder::Overview overview;
  std::vector<mcap::AttachmentIndex> attachments;
  std::string compression;  // of the first chunk

  bool is_whole() const { return scan.faults.empty(); }
};

/// Texts of a file that may be anyone's, on one line of a terminal.
std::string shown(const std::string& from) {
  std::string line = text::printable(from);
  std::ranges::replace_if(
      line, [](char c) { return c == '\n' || c == '\t'; }, ' ');
  return line;
}

std::string megabytes(std::uint64_t bytes) {
  if (bytes < 10'000) return fmt::format("{} bytes", bytes);
  return fmt::format("{:.3g} MB", static_cast<double>(bytes) * 1e-6);
}

/// As shown, with one space between words, without a first `None`: CMake's build type for no type.
std::string words_of(const std::string& text) {
  std::istringstream words(shown(text));
  std::string line, word;
  while (words >> word) {
    if (line.empty() && word == "None") continue;
    line += (line.empty() ? "" : " ") + word;
  }
  return line;
}

std::string to_text(const recorder::Start& start) {
  std::string text = fmt::format("  scene     {}, seed {}{}\n", shown(start.scene), start.seed,
                                 start.clock.empty() ? "" : ", clock " + shown(start.clock));
  text += fmt::format("  recorded  {}\n", shown(start.date));
  const recorder::Build& build = start.build;
  text += fmt::format("  build     ziggurat {}, {}, {}, C library {}, {}\n", shown(build.version),
                      words_of(build.compiler), words_of(build.options), shown(build.libm),
                      shown(build.cpu_path));
  std::string arguments;
  for (const std::string& argument : start.arguments) arguments += " " + shown(argument);
  return arguments.empty() ? text : text + fmt::format("  options  {}\n", arguments);
}

std::string to_text(const Examined& file) {
  const recorder::Overview& all = file.overview;
  std::string text = fmt::format("{}: {}, {}\n", shown(file.path), megabytes(file.size),
                                 file.is_whole() ? "whole" : "damaged");
  if (all.start) {
    text += to_text(*all.start);
    text +=
        fmt::format("  length    {:.6g} s simulated, {} states, last tick {}{}\n", all.length,
                    all.states, all.last_tick,
                    all.epochs > 1 ? fmt::format(", {} resets or restores", all.epochs - 1) : "");
  } else {
    text +=
        fmt::format("  no recording of a run by ziggurat, but an MCAP file of the profile '{}'\n",
                    shown(file.scan.contents.header.profile));
  }
  text += fmt::format("  chunks    {}, {} before compression{}\n", file.scan.contents.chunks.size(),
                      megabytes(all.uncompressed),
                      file.compression.empty() ? "" : " with " + shown(file.compression));
  std::size_t width = 5;
  for (const auto& topic : all.topics) width = std::max(width, shown(topic.name).size());
  width = std::min<std::size_t>(width, 60);
  text += fmt::format("\n{:{}}  messages         bytes  type\n", "topic", width);
  for (const auto& topic : all.topics) {
    text += fmt::format("{:{}}  {:8}  {:12}  {}\n", shown(topic.name), width, topic.messages,
                        topic.bytes, shown(topic.type));
  }
  if (!file.attachments.empty()) text += "\nattachments, with bytes\n";
  for (const auto& each : file.attachments) {
    text += fmt::format("{:10}  {}\n", each.data_size, shown(each.name));
  }
  if (!text.empty()) text.pop_back();
  return text;
}

nlohmann::ordered_json to_json(const recorder::Start& start) {
  const recorder::Build& build = start.build;
  return {{"scene", start.scene},
          {"scene_hash", start.scene_hash},
          {"seed", start.seed},
          {"clock", start.clock},
          {"date", start.date},
          {"arguments", start.arguments},
          {"build",
           {{"version", build.version},
            {"compiler", build.compiler},
            {"options", build.options},
            {"libm", build.libm},
            {"cpu_path", build.cpu_path}}}};
}

nlohmann::ordered_json to_json(const Examined& file) {
  const recorder::Overview& all = file.overview;
  auto topics = nlohmann::ordered_json::array();
  for (const auto& each : all.topics) {
    topics.push_back({{"topic", each.name},
                      {"type", each.type},
                      {"messages", each.messages},
                      {"bytes", each.bytes}});
  }
  auto attachments = nlohmann::ordered_json::array();
  for (const auto& each : file.attachments) {
    attachments.push_back({{"name", each.name}, {"bytes", each.data_size}});
  }
  auto faults = nlohmann::ordered_json::array();
  for (const auto& fault : file.scan.faults) {
    faults.push_back({{"offset", fault.offset}, {"text", fault.text}});
  }
  return {{"file", file.path},
          {"bytes", file.size},
          {"is_whole", file.is_whole()},
          {"has_end", file.scan.has_end},
          {"profile", file.scan.contents.header.profile},
          {"run", all.start ? to_json(*all.start) : nlohmann::ordered_json()},
          {"length_s", all.length},
          {"states", all.states},
          {"last_tick", all.last_tick},
          {"epochs", all.epochs},
          {"chunks", file.scan.contents.chunks.size()},
          {"damaged_chunks", file.scan.damaged_chunks},
          {"uncompressed_bytes", all.uncompressed},
          {"topics", topics},
          {"attachments", attachments},
          {"faults", faults}};
}

std::string counted(std::uint64_t number, const char* what) {
  return fmt::format("{} {}{}", number, what, number == 1 ? "" : "s");
}

/// One sentence on what is wrong, and one on what can be saved.
std::string complaint(const Examined& file) {
  const auto& faults = file.scan.faults;
  std::uint64_t messages = 0;
  for (const auto& topic : file.overview.topics) messages += topic.messages;
  return fmt::format(
      "{}: byte {}: {}{}; {} and {} are intact, up to {:.6g} s; to save them, "
      "write: ziggurat info {} --repair OUT.mcap",
      shown(file.path), faults[0].offset, shown(faults[0].text),
      faults.size() > 1 ? fmt::format(" (and {} more)", counted(faults.size() - 1, "fault")) : "",
      counted(messages, "message"), counted(file.attachments.size(), "attachment"),
      file.overview.length, shown(file.path));
}

Examined examine(const std::string& path, const mcap::Source& source, const mcap::Reader& reader) {
  Examined file{path, source.size, mcap::check(source), recorder::overview(reader), {}, {}};
  file.attachments = reader.contents().attachments;
  if (!reader.contents().chunks.empty()) file.compression = reader.contents().chunks[0].compression;
  return file;
}

void write_repaired(const std::string& path, const mcap::Reader& reader, const std::string& out,
                    reports::Console& console) {
  AtomicFile whole(out);
  recorder::Disk disk(whole.path());
  const mcap::Repaired repaired =
      mcap::repair(reader, [&](std::string_view bytes) { disk.write(bytes); });
  disk.close();
  whole.commit();
  for (const auto& fault : repaired.lost) {
    console.warning(fmt::format("{}: byte {}: {}; it is left out", shown(path), fault.offset,
                                shown(fault.text)));
  }
  console.report(fmt::format("{}: {} in {}, {}", shown(out), counted(repaired.messages, "message"),
                             counted(repaired.chunks, "chunk"),
                             counted(repaired.attachments, "attachment")));
}

}  // namespace

std::string help_info() {
  return fmt::format(R"(usage: ziggurat info FILE.mcap [OPTION]...

Tells what a recording has, and whether it is whole: reads all of it and checks every length, index and
checksum. Any MCAP file will do.

  ziggurat info run.mcap
  ziggurat info run.mcap --repair saved.mcap
      after a crash or damage: writes a whole file with everything that is intact

Exit codes: 0 it is whole, or was repaired; 1 it is damaged, or is no MCAP file.

{})",
                     fmt::streamed(info_options()));
}

int execute_info(const Arguments& arguments) {
  const auto parsed = parse(arguments, info_options());
  if (parsed.positional.size() != 1) {
    throw text::UsageError("one file is expected; write: ziggurat info FILE.mcap");
  }
  const std::string& path = parsed.positional[0];
  const bool as_json = parsed.values.count("json") > 0;
  const std::string out = Values(parsed.values).text("repair");
  const outputs::TakenFile damaged_file{path, "the damaged file"};
  if (!out.empty()) outputs::check_output({"--repair", out, {".mcap"}}, {&damaged_file, 1});
  reports::Console console({false, as_json});
  try {
    const mcap::Source source = mcap::open_file(path);
    const mcap::Reader reader(source);
    const Examined file = examine(path, source, reader);
    if (as_json) {
      console.result(
          to_json(file).dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
    } else {
      console.result(to_text(file));
    }
    const bool repairs = !out.empty();
    if (repairs) {
      write_repaired(path, reader, out, console);
    } else if (!file.is_whole()) {
      console.fault(complaint(file));
    }
    console.flush();
    return file.is_whole() || repairs ? exit_code::finished : exit_code::fault;
  } catch (const mcap::Damaged& damaged) {
    throw text::UsageError(
        fmt::format("{}: byte {}: {}", shown(path), damaged.offset(), damaged.what()));
  }
}

}  // namespace ziggurat::cli
