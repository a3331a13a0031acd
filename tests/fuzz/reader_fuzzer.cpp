// SPDX-License-Identifier: MIT
// Recordings are files of anyone. Whatever their messages say, in files that are whole otherwise:
// all that reads them without simulating ends with what could be read, or with the sentence that
// says what is wrong.

#include <numeric>

#include "recorded.h"
#include "recording/replay/export.h"
#include "recording/replay/names.h"
#include "recording/replay/recording_file.h"

namespace {

using namespace ziggurat;
using fuzz::attempt;
using fuzz::require;

/// Two links that move, and commands of most kinds.
fuzz::Recorded record() {
  fuzz::Recorded run;
  run.start.set_scene("small.argos");
  run.start.set_seed(3);
  recording::CommandPacker packed;
  recording::StatePacker links;
  world::State state;
  state.links.resize(2);
  world::Commands commands;
  for (std::size_t i = 0; i < 4; ++i) {
    v1::Inputs& inputs = run.inputs.emplace_back();
    inputs.set_tick(i);
    inputs.set_hash(i + 1);
    state.tick = i;
    state.links[i % 2].pose.position.x() += 0.5;
    links.pack(0, state, run.states.emplace_back());
    inputs.add_acts()->mutable_move()->set_entity("box");
    commands.joint_targets = {0.5, static_cast<double>(i)};
    commands.led_colors = {0xFF0000};
    commands.tag_payloads = {"7"};
    commands.radio_messages.entries = {{0, 0, 0, 2}};
    commands.radio_messages.bytes = {1, 2};
    packed.pack(commands, *inputs.mutable_commands());
  }
  return run;
}

void read_states(const replay::RecordingFile& file) {
  replay::States states(file);
  std::size_t count = 0;
  while (states.next()) ++count;
  require(count <= file.states());
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  google::protobuf::SetLogHandler(nullptr);  // it would log every text that is not UTF-8
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static fuzz::RecordedFile recorded(record());
  static const replay::RecordingFile open("recording", mcap::bytes_of(recorded.bytes()));
  recorded.edit({data, size});
  const auto all = [](const std::string&) { return true; };
  // Slow readers have their turn less often, and so do readers of similar inputs.
  const auto turn = std::accumulate(data, data + size, std::uint8_t{0});
  switch (turn) {
    case 0:
      attempt([] {
        require(replay::RecordingFile("recording", mcap::bytes_of(recorded.bytes()))
                    .shortcoming()
                    .empty());
      });
      break;
    case 1:
      attempt([&] { replay::export_jsonl(open, all, "/dev/null"); });
      break;
    default:
      if (turn % 8 == 2) attempt([] { replay::export_csv(open, "/dev/null"); });
      if (turn % 8 == 3) attempt([] { replay::link_names(open); });
      if (turn % 8 > 3) attempt([] { read_states(open); });
  }
  return 0;
}
