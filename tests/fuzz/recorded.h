#pragma once
// A whole recording of a short run, with messages that an input changes.

#include <google/protobuf/stubs/logging.h>

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "mcap/writer.h"
#include "recording/inputs.h"
#include "small_world.h"
#include "ziggurat/v1/channels.pb.h"
#include "ziggurat/v1/run.pb.h"

namespace ziggurat::fuzz {

/// The messages of a short run.
struct Recorded {
  v1::RunStart start;
  std::vector<v1::Inputs> inputs;
  std::vector<v1::ExactState> states;
};

/// A whole file with these messages; which of them are changed, and how, is the input's to say.
inline std::string write(const Recorded& recorded, std::span<const std::uint8_t> data) {
  std::string bytes;
  mcap::Writer writer([&](std::string_view some) { bytes += some; }, {"ziggurat", "fuzzer"},
                      mcap::Compression::none);
  writer.attach("small.argos", "", small_world, 0, 0);
  const auto channel = [&](const char* type, const char* topic) {
    return writer.add_channel(writer.add_schema(type, "protobuf", ""), topic, "protobuf");
  };
  const auto run = channel("ziggurat.v1.RunStart", "/run"), inputs = channel("ziggurat.v1.Inputs", "/inputs"),
             state = channel("ziggurat.v1.ExactState", "/state"), world = channel("ziggurat.v1.World", "/world");
  std::size_t number = 0;
  const std::size_t part = data.size() / 4, chosen = data.empty() ? 0 : data[0];
  const auto add = [&](std::uint16_t to, std::string text) {
    const std::size_t at = number++;
    if ((chosen >> at % 8 & 1) != 0) text = edited(std::move(text), data.subspan(at % 4 * part, part));
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

/// Does it, which may end with a sentence.
template <class Do>
void attempt(const Do& action) {
  try {
    action();
  } catch (const std::runtime_error& error) {
    require(*error.what() != '\0');
  }
}

}  // namespace ziggurat::fuzz
