// SPDX-License-Identifier: MIT
// Recordings are files of anyone. Whatever their messages say, in files that are whole otherwise: a
// replay and the poses alone end with what could be read, or with the sentence that says what is
// wrong.

#include <stdexcept>

#include "recorded.h"
#include "recording/replay/recording_file.h"
#include "recording/replay/replay.h"
#include "recording/replay/scene.h"

namespace {

using namespace ziggurat;
using fuzz::attempt;

fuzz::Recorded record() {
  fuzz::Recorded run;
  run.start.set_scene("small.argos");
  run.start.set_seed(3);
  scene::ReadResult read = fuzz::read_small_world();
  simulation::Simulation world(read.scene, {3, {}});
  recording::CommandPacker commands;
  recording::StatePacker links;
  for (int i = 0; i < 4; ++i) {
    v1::Inputs& next = run.inputs.emplace_back();
    next.set_tick(world.state().tick);
    next.set_hash(world.hash());
    links.pack(0, world.state(), run.states.emplace_back());
    if (i == 1) next.add_acts()->mutable_spawn()->set_xml(fuzz::small_box);
    if (i == 1) next.add_acts()->mutable_snapshot()->set_name("a");
    if (i == 2) next.add_acts()->mutable_remove()->set_entity("new");
    if (i == 3) next.add_acts()->mutable_restore()->set_name("a");
    if (i == 1) {
      const auto addition = read.additions.read(fuzz::small_box, read.scene, 1 << 16,
                                                [](const std::string&) { return false; });
      world.spawn(read.scene, addition.entity, fuzz::small_box);
    }
    commands.pack(world.commands(), *next.mutable_commands());
    world.step();
  }
  return run;
}

struct Played {
  replay::RecordingFile file;
  scene::OpenScene opened;
  std::uint64_t seed;
  simulation::Simulation simulation;
  replay::States states{file};
  replay::Replay replay{{opened.scene, opened.additions, simulation, seed},
                        file.files().opener(),
                        [this] { return states.next(); }};

  explicit Played(std::string_view bytes)
      : file("recording", mcap::bytes_of(bytes)),
        opened(replay::read_scene(file.run(), file.files())),
        seed(file.run().seed()),
        simulation(opened.scene, {seed, {}}) {}
};

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  google::protobuf::SetLogHandler(nullptr);  // it would log every text that is not UTF-8
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static fuzz::RecordedFile recorded(record());
  recorded.edit({data, size});
  for (const bool is_shown : {false, true}) {
    attempt([&] {
      Played played(recorded.bytes());
      if (is_shown) played.replay.show([&] { return played.states.links(); });
      for (int i = 0; i < 16 && played.replay.advance(); ++i) played.replay.act();
    });
  }
  return 0;
}
