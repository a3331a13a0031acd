// Recordings are files of anyone. Whatever their messages say, in files that are whole otherwise: a replay, the
// poses alone and the exports end with what could be read, or with the sentence that says what is wrong.

#include <unistd.h>

#include <cstdio>
#include <stdexcept>

#include "mcap/writer.h"
#include "recording/inputs.h"
#include "replay/export.h"
#include "replay/names.h"
#include "replay/recording_file.h"
#include "replay/replay.h"
#include "replay/scene.h"
#include "small_world.h"
#include "ziggurat/v1/channels.pb.h"
#include "ziggurat/v1/run.pb.h"

namespace {

using namespace ziggurat;
using fuzz::require;

/// The messages of a short run.
struct Recorded {
  Recorded() {
    start.set_scene("small.argos");
    start.set_seed(3);
    scene::ReadResult read = fuzz::read_small_world();
    simulation::Simulation world(read.scene, {3, {}});
    recording::CommandPacker commands;
    recording::StatePacker links;
    for (int i = 0; i < 4; ++i) {
      v1::Inputs& next = inputs.emplace_back();
      next.set_tick(world.state().tick);
      next.set_hash(world.hash());
      links.pack(0, world.state(), i == 0, states.emplace_back());
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
    start.set_scene_hash("");
  }
  v1::RunStart start;
  std::vector<v1::Inputs> inputs;
  std::vector<v1::ExactState> states;
};

/// A whole file with these messages; which of them are changed, and how, is the input's to say.
std::string write(const Recorded& recorded, std::span<const std::uint8_t> data) {
  std::string bytes;
  mcap::Writer writer([&](std::string_view some) { bytes += some; }, {"ziggurat", "fuzzer"},
                      mcap::Compression::none);
  writer.attach("small.argos", "", fuzz::small_world, 0, 0);
  const auto channel = [&](const char* type, const char* topic) {
    return writer.add_channel(writer.add_schema(type, "protobuf", ""), topic, "protobuf");
  };
  const auto run = channel("ziggurat.v1.RunStart", "/run"), inputs = channel("ziggurat.v1.Inputs", "/inputs"),
             state = channel("ziggurat.v1.ExactState", "/state"), world = channel("ziggurat.v1.World", "/world");
  std::size_t number = 0;
  const std::size_t part = data.size() / 4, chosen = data.empty() ? 0 : data[0];
  const auto add = [&](std::uint16_t to, std::string text) {
    const std::size_t at = number++;
    if ((chosen >> at % 8 & 1) != 0) text = fuzz::edited(std::move(text), data.subspan(at % 4 * part, part));
    writer.write(to, at, at, text);
  };
  add(run, recorded.start.SerializeAsString());
  v1::World described;
  described.set_ticks_per_second(10);
  described.add_entities()->set_link_count(1);
  described.add_links()->set_id("base");
  add(world, described.SerializeAsString());
  for (std::size_t i = 0; i < recorded.inputs.size(); ++i) {
    add(state, recorded.states[i].SerializeAsString());
    add(inputs, recorded.inputs[i].SerializeAsString());
  }
  writer.close();
  return bytes;
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

  explicit Played(const std::string& path)
      : file(path),
        opened(replay::read_scene(file.run(), file.files())),
        seed(file.run().seed()),
        simulation(opened.scene, {seed, {}}) {}
};

/// Does it, which may end with a sentence.
template <class Do>
void attempt(const Do& action) {
  try {
    action();
  } catch (const std::runtime_error& error) {
    require(*error.what() != '\0');
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Recorded recorded;
  static const std::string folder = "/dev/shm/fuzz_recording_" + std::to_string(::getpid());
  const std::string path = folder + ".mcap", out = folder + ".out";
  const std::string bytes = write(recorded, {data, size});
  std::FILE* file = std::fopen(path.c_str(), "wb");
  require(file != nullptr && std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size());
  std::fclose(file);
  for (const bool is_shown : {false, true}) {
    attempt([&] {
      Played played(path);
      if (is_shown) played.replay.show([&] { return played.states.links(); });
      for (int i = 0; i < 16 && played.replay.advance(); ++i) played.replay.act();
    });
  }
  attempt([&] {
    const replay::RecordingFile read(path);
    attempt([&] { replay::link_names(read); });
    attempt([&] { replay::export_csv(read, out); });
    attempt([&] { replay::export_jsonl(read, [](const std::string&) { return true; }, out); });
  });
  std::remove(path.c_str());
  std::remove(out.c_str());
  return 0;
}
